#include <keeler/bench/light.hpp>

#include "gravity_states.hpp"

#include <keeler/bench/yardsticks.hpp>
#include <keeler/core/parallel.hpp>
#include <keeler/core/phase_progress.hpp>
#include <keeler/core/random.hpp>
#include <keeler/core/stopwatch.hpp>
#include <keeler/core/threads.hpp>
#include <keeler/core/units.hpp>
#include <keeler/io/snapshot.hpp>
#include <keeler/light/path.hpp>
#include <keeler/light/photometry.hpp>
#include <keeler/statistics/median.hpp>

#include <atomic>
#include <cassert>
#include <cmath>
#include <vector>

namespace keeler::bench {
namespace {

using light::Tracer;

constexpr std::size_t ray_rows = 256, row_rays = 256, traced_rays = ray_rows * row_rays; // of a measurement
constexpr double rad_per_degree = pi / 180.0;

light::Sight sight_of(const LightBenchSettings& settings) {
  return light::sight_at_phase({settings.elevation * rad_per_degree, 0.0}, settings.elevation * rad_per_degree,
                               6.0 * rad_per_degree);
}

// Calls work(row) for all rows of rays, on all threads. Returns the rays per second and thread.
template<class Work> double speed_of(const Work& work) {
  const double start = bench_seconds();
  parallel_for(ray_rows, work, 1);
  return static_cast<double>(traced_rays) / ((bench_seconds() - start) * threads());
}

// Beginnings of rays on the upper face of the cell: at random for Keeler's rays, as photometry has them, and side by
// side in rows for Embree's queries.
struct Beginnings {
  std::vector<Vec3> at_random, side_by_side;

  explicit Beginnings(const light::SphereCell& cell) {
    const ShearingBox& box = cell.box();
    RandomStream random(1, RandomPurpose::light, 0);
    for (std::size_t i = 0; i < ray_rows; ++i)
      for (std::size_t k = 0; k < row_rays; ++k) {
        at_random.emplace_back((random.uniform() - 0.5) * box.size_x, (random.uniform() - 0.5) * box.size_y,
                               cell.top());
        side_by_side.emplace_back(((static_cast<double>(i) + 0.5) / ray_rows - 0.5) * box.size_x,
                                  ((static_cast<double>(k) + 0.5) / row_rays - 0.5) * box.size_y, cell.top());
      }
  }
};

// Speeds of one repeat.
struct Speeds {
  double paths, first_hits, any_hits, embree, packets, met;
};

Speeds measure(const Tracer& tracer, const Beginnings& from, const light::ScatteringLaw& law, const light::Sight& sight,
               std::uint64_t repeat) {
  const Vec3 down = -sight.observer.direction(), sun = sight.sun.direction();
  std::atomic<std::size_t> met = 0, seen = 0; // sums keep the work from being left out
  Speeds speeds{};
  speeds.paths = speed_of([&](std::size_t row) {
    std::size_t hits = 0;
    for (std::size_t k = row * row_rays; k < (row + 1) * row_rays; ++k) {
      RandomStream random(1, RandomPurpose::light, 1 + repeat * traced_rays + k);
      hits += follow_path(tracer, law, sun, from.at_random[k], down, random).hits;
    }
    met += hits;
  });
  speeds.first_hits = speed_of([&](std::size_t row) {
    std::size_t hits = 0;
    for (std::size_t k = row * row_rays; k < (row + 1) * row_rays; ++k)
      hits += tracer.first_hit(from.at_random[k], down) ? 1 : 0;
    seen += hits;
  });
  speeds.any_hits = speed_of([&](std::size_t row) {
    std::size_t hits = 0;
    for (std::size_t k = row * row_rays; k < (row + 1) * row_rays; ++k)
      hits += tracer.blocked(from.at_random[k], down) ? 1 : 0;
    seen += hits;
  });
  for (const bool in_packets : {false, true})
    (in_packets ? speeds.packets : speeds.embree) = speed_of([&](std::size_t row) {
      seen += tracer.count_blocked_in_cell({from.side_by_side.data() + row * row_rays, row_rays}, down, in_packets);
    });
  assert(seen > 0);
  speeds.met = static_cast<double>(met) / static_cast<double>(traced_rays);
  return speeds;
}

} // namespace

LightBench bench_light(const LightBenchSettings& settings) {
  assert(settings.count > 0 && settings.repeats > 0 && settings.elevation > 0.0);
  light::require_tracer();
  PhaseProgress progress(settings.progress);
  LightBench bench;
  Patch patch;
  {
    const Stopwatch watch(bench.preparation_s);
    patch = settings.from ? io::read_snapshot(*settings.from).patch
                          : gravity_state(settings.count, settings.state, progress).patch;
  }
  bench.count = patch.size();
  const double start = wall_seconds();
  const Tracer tracer(patch);
  bench.scene_s = wall_seconds() - start;
  const light::SharedLaw law = light::law_named("callisto", 0.5);
  const light::Sight sight = sight_of(settings);
  const Beginnings from(tracer.cell());
  progress.begin("rays", settings.repeats + 1.0);
  std::vector<Speeds> all;
  for (int repeat = 0; repeat < settings.repeats; ++repeat) {
    all.push_back(measure(tracer, from, *law, sight, static_cast<std::uint64_t>(repeat)));
    progress.add(1.0);
  }
  const auto median = [&](double Speeds::*part) {
    std::vector<double> values;
    for (const Speeds& one : all)
      values.push_back(one.*part);
    return statistics::median(values);
  };
  bench.paths_per_s = median(&Speeds::paths);
  bench.spheres_met = median(&Speeds::met);
  bench.first_hits_per_s = median(&Speeds::first_hits);
  bench.any_hits_per_s = median(&Speeds::any_hits);
  bench.embree_rays_per_s = median(&Speeds::embree);
  bench.embree_packet_rays_per_s = median(&Speeds::packets);
  light::PhotometrySettings one_percent;
  one_percent.law = law;
  one_percent.error = 0.01;
  const double begin = wall_seconds();
  bench.one_percent_rays = light::photometry({&patch, 1}, {&sight, 1}, one_percent).front().rays;
  bench.one_percent_s = wall_seconds() - begin;
  return bench;
}

} // namespace keeler::bench
