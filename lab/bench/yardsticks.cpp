#include <keeler/bench/yardsticks.hpp>

#include <keeler/core/parallel.hpp>
#include <keeler/core/stopwatch.hpp>
#include <keeler/core/threads.hpp>

#include <cassert>
#include <chrono>

namespace keeler::bench {
namespace {

constexpr double min_yardstick_seconds = 0.03; // of work per measurement

// Returns the time per call of work(), s; the first call is not timed.
template<class Work> double seconds_of(const Work& work, double (*clock)()) {
  work();
  const double start = clock();
  double spent = 0.0;
  int times = 0;
  while (spent < min_yardstick_seconds) {
    work();
    ++times;
    spent = clock() - start;
  }
  return spent / times;
}

std::vector<Elements> some_orbits(std::size_t count) {
  std::vector<Elements> orbits;
  for (std::size_t k = 0; k < count; ++k) {
    const double x = static_cast<double>(k);
    orbits.push_back({x, 0.5 * x, 1.0, -2.0, 0.5, 0.25});
  }
  return orbits;
}

} // namespace

double wall_seconds() {
  static const auto start = std::chrono::steady_clock::now();
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

double bench_seconds() {
  return threads() == 1 ? cpu_seconds() : wall_seconds();
}

double MemoryYardstick::measure() {
  assert(!lines_.empty());
  constexpr int chunk = 4096;
  constexpr std::size_t min_lines = 200000; // per reading of the clock
  const std::size_t rounds = 1 + min_lines / (lines_.size() + 1);
  const auto once = [&] {
    parallel_for(
        lines_.size(),
        [&](std::size_t k) {
          Body& line = lines_[k];
          Elements& el = line.elements;
          for (double* value :
               {&el.guiding_x, &el.guiding_y, &el.e_cos, &el.e_sin, &el.i_sin, &el.i_cos, &line.radius, &line.mass})
            *value += 1.0;
        },
        chunk);
  };
  const auto pass = [&] {
    for (std::size_t round = 0; round < rounds; ++round)
      once();
  };
  return 1e9 * seconds_of(pass, bench_seconds) / static_cast<double>(rounds * lines_.size());
}

double pair_yardstick(double (*clock)()) {
  constexpr std::size_t orbit_count = 256, rounds = 64;
  const std::vector<Elements> orbits = some_orbits(orbit_count);
  const Frequencies frequencies;
  const Rotation rotation(frequencies, 1e-3);
  std::vector<double> sums(static_cast<std::size_t>(threads()) * 8);
  const auto pass = [&] {
    parallel_for(
        sums.size(),
        [&](std::size_t b) {
          double squares = 0.0, closing = 0.0;
          for (std::size_t round = 0; round < rounds; ++round)
            for (std::size_t k = 0; k < orbit_count; ++k) {
              const State low = state_at(orbits[k], frequencies, rotation);
              const State high = state_at(orbits[(k + round) % orbit_count], frequencies, rotation);
              const Vec3 d = high.position - low.position, v = high.velocity - low.velocity;
              squares += d.squaredNorm();
              closing += d.dot(v);
            }
          sums[b] += squares + closing; // prevents the compiler from removing the work
        },
        1);
  };
  return 1e9 * seconds_of(pass, clock) / static_cast<double>(sums.size() * rounds * orbit_count);
}

} // namespace keeler::bench
