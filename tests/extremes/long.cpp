// The longest two: 10⁵ orbits, and 10⁷ particles with self-gravity.
#include "course.hpp"

#include "unit/files/disk.hpp"

#include <keeler/initial_conditions/initial.hpp>

#include <fmt/format.h>

#include <cmath>
#include <spawn.h>
#include <stdexcept>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

namespace keeler::extremes {
namespace {

double sum_of_x(const Simulation& simulation) {
  double sum = 0.0;
  for (const Body& b : simulation.state().particles.bodies)
    sum += b.elements.guiding_x;
  return sum;
}

// All swing together besides their random motions, e = 2 and i = 2 radii: collisions keep that motion's phase and
// length, and the mean X but for wraps by the box's width.
std::vector<Row> many_orbits() {
  constexpr double swing = 2.0;
  constexpr std::int64_t steps = 10'000'000;
  const Example e = example("10⁵ orbits", "equilibrium",
                            {"particles.count=100", "box.size=[25,25]", "time.step=1e-2", "time.end=1e5"});
  Patch patch = initial_patch(e.scene);
  for (std::size_t k = 0; k < patch.size(); ++k) {
    patch.positions[k].x() -= swing;
    patch.velocities[k] += Vec3(0.0, 2.0 * swing, swing);
  }
  Simulation simulation(e.scene, patch);
  const double before = sum_of_x(simulation);
  const Course course = follow(simulation, steps, 1000);
  const State state{e.state.name, e.state.made_by + ", with e and i of 2 m common to all"};
  std::vector<Row> rows = rows_of(state, course, 1e7);
  const double drift = std::remainder(sum_of_x(simulation) - before, e.scene.size_x);
  rows.push_back(at_most(state, "drift of the mean X beyond wraps, m", std::fabs(drift) / 100.0,
                         1e-15 * std::sqrt(static_cast<double>(course.collisions)),
                         "1e-15 a contact or wrap, of places of some 10 m; the roundings of 100 particles walk"));
  return rows;
}

// Runs the program; the largest memory that it held, in bytes.
double peak_memory(std::vector<std::string> words) {
  std::vector<char*> arguments;
  for (std::string& word : words)
    arguments.push_back(word.data());
  arguments.push_back(nullptr);
  pid_t child = 0;
  int status = 0;
  rusage usage{};
  if (::posix_spawn(&child, arguments[0], nullptr, nullptr, arguments.data(), environ) != 0 ||
      ::wait4(child, &status, 0, &usage) != child || !WIFEXITED(status) || WEXITSTATUS(status) != 0)
    throw std::runtime_error(fmt::format("{} did not end well", words[0]));
  return 1024.0 * static_cast<double>(usage.ru_maxrss);
}

std::vector<Row> many_particles() {
  const std::vector<std::string> keys = {"particles.count=10000000", "box.size=[7927,7927]", "gravity.solver=fft",
                                         "gravity.kick_every=1",     "time.step=1e-3",       "time.end=0.003"};
  const Example e = example("10⁷ particles with gravity", "a-ring-wakes", keys);
  const test::TemporaryFolder work;
  std::vector<std::string> words = {KEELER_PROGRAM, "run",
                                    std::string(KEELER_SOURCE_DIR) + "/examples/a-ring-wakes/scene.toml", "-o",
                                    (work / "run").string()};
  for (const std::string& key : keys) {
    words.emplace_back("--set");
    words.push_back(key);
  }
  const double bytes = peak_memory(words);
  return {at_most(e.state, "largest memory of the program (VmHWM), GiB", bytes / std::pow(1024.0, 3), 12.0,
                  "what a workstation of 16 GiB can spare: start, three steps, snapshots and a checkpoint"),
          at_most(e.state, "the same a particle, bytes", bytes / 1e7, 12.0 * std::pow(1024.0, 3) / 1e7, "the same")};
}

} // namespace

std::vector<Subject> long_subjects() {
  return {{"many-orbits", "Long: 10⁵ orbits", rows::Length::extra, many_orbits},
          {"many-particles", "Long: 10⁷ particles with self-gravity", rows::Length::extra, many_particles}};
}

} // namespace keeler::extremes
