#include <keeler/bench/gravity.hpp>

#include "gravity_states.hpp"

#include <keeler/bench/yardsticks.hpp>
#include <keeler/cells/order.hpp>
#include <keeler/core/simd.hpp>
#include <keeler/gravity/direct.hpp>
#include <keeler/statistics/median.hpp>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <numeric>

namespace keeler::bench {
namespace {

constexpr gravity::ImageSettings reference_images{2, true};
constexpr double reference_pairs = 5e9; // pair forces of the reference, some seconds
constexpr double min_sample = 500.0, max_sample = 2000.0;
constexpr double edge_width = 5.0; // m; boxes are wider than 120 m
constexpr std::size_t min_at_edge = 64;
constexpr std::size_t reference_block = 128; // targets per progress report
constexpr double min_repeat_seconds = 0.05;  // of solves per repeat
constexpr std::size_t max_direct = 10000;    // particles, unless requested by name

// Returns the patch with its particles in the spatial order of a run.
Patch in_memory_order(const Patch& patch) {
  const std::vector<std::uint32_t> order =
      cells::order_by_position(particles_from(patch, 0.0), patch.box, patch.offset);
  Patch sorted = patch;
  cells::reorder(sorted.positions, order);
  cells::reorder(sorted.velocities, order);
  cells::reorder(sorted.radii, order);
  cells::reorder(sorted.masses, order);
  cells::reorder(sorted.ids, order);
  return sorted;
}

diagnostics::ForceSample sample_of(const gravity::GravityProblem& problem) {
  const double images = std::pow(2.0 * reference_images.rings + 1.0, 2);
  const double affordable = reference_pairs / (images * static_cast<double>(problem.positions.size()));
  const auto even = static_cast<std::size_t>(std::clamp(affordable, min_sample, max_sample));
  return diagnostics::draw_force_sample(problem, even, std::max(min_at_edge, even / 8), edge_width);
}

std::vector<Vec3> exact_accelerations(const gravity::GravityProblem& problem, const diagnostics::ForceSample& sample,
                                      PhaseProgress& progress) {
  const std::span<const std::size_t> targets = sample.targets;
  progress.begin("forces to compare with", static_cast<double>(targets.size()));
  std::vector<Vec3> exact;
  for (std::size_t begin = 0; begin < targets.size(); begin += reference_block) {
    const auto block = targets.subspan(begin, std::min(reference_block, targets.size() - begin));
    for (const Vec3& a : sampled_accelerations(problem, block, reference_images, choose_instruction_set()))
      exact.push_back(a);
    progress.add(static_cast<double>(block.size()));
  }
  return exact;
}

// Returns the time per solve in each repeat, s. An untimed first solve, in which buffers grow, determines the number of
// solves per repeat.
std::vector<double> solve_times(gravity::GravitySolver& solver, const gravity::GravityProblem& problem,
                                std::span<Vec3> accelerations, int repeats) {
  assert(repeats > 0 && accelerations.size() == problem.positions.size());
  const double start = bench_seconds();
  solver.accelerate(problem, accelerations);
  const double first = std::max(1e-9, bench_seconds() - start);
  const int solves = static_cast<int>(std::ceil(std::min(1e6, min_repeat_seconds / first)));
  std::vector<double> times;
  for (int repeat = 0; repeat < repeats; ++repeat) {
    const double before = bench_seconds();
    for (int k = 0; k < solves; ++k)
      solver.accelerate(problem, accelerations);
    times.push_back((bench_seconds() - before) / solves);
  }
  return times;
}

std::vector<GravityChoice> chosen(const GravityBenchSettings& settings, std::size_t count) {
  std::vector<GravityChoice> choices;
  for (const GravityChoice& choice : gravity_choices())
    if (settings.solver.empty() ? choice.solver != "direct" || count <= max_direct : choice.solver == settings.solver)
      choices.push_back(choice);
  return choices;
}

} // namespace

std::vector<std::pair<std::string, double>> GravityBenchRow::numbers() const {
  return {{"error_rms", errors.rms},
          {"error_p999", errors.p999},
          {"error_x", errors.component_rms[0]},
          {"error_y", errors.component_rms[1]},
          {"error_z", errors.component_rms[2]},
          {"error_edge", errors.edge_rms},
          {"edge_pull", errors.edge_pull},
          {"net_force", net_force},
          {"ns_per_particle", ns_per_particle}};
}

GravityBench bench_gravity_of(const Patch& state, const std::vector<GravityChoice>& choices, int repeats,
                              PhaseProgress& progress) {
  assert(state.size() > 0);
  const Patch patch = in_memory_order(state);
  const gravity::GravityProblem problem = diagnostics::gravity_problem(patch);
  const diagnostics::ForceSample sample = sample_of(problem);
  GravityBench bench;
  bench.count = patch.size();
  bench.size_x_m = patch.box.size_x;
  bench.size_y_m = patch.box.size_y;
  bench.offset_m = patch.offset;
  bench.sample = sample.uniform;
  bench.edge_sample = std::accumulate(sample.edges.begin(), sample.edges.end(), std::size_t{0});
  bench.edge_width_m = edge_width;

  const std::vector<Vec3> exact = exact_accelerations(problem, sample, progress);
  progress.begin("timing", static_cast<double>(choices.size()));
  std::vector<Vec3> accelerations(bench.count);
  for (const GravityChoice& choice : choices) {
    const std::unique_ptr<gravity::GravitySolver> solver =
        make_gravity_solver(choice.settings, patch.masses, patch.box.area());
    const std::vector<double> times = solve_times(*solver, problem, accelerations, repeats);
    bench.rows.push_back({choice, force_errors(sample, exact, accelerations),
                          diagnostics::net_force(patch.masses, accelerations),
                          1e9 * statistics::median(times) / static_cast<double>(bench.count)});
    progress.add(1.0);
  }
  return bench;
}

GravityBench bench_gravity(const GravityBenchSettings& settings) {
  PhaseProgress progress(settings.progress);
  const double begin = wall_seconds();
  const Patch patch = gravity_state(settings.count, settings.state, progress).patch;
  const double prepared = wall_seconds();
  GravityBench bench = bench_gravity_of(patch, chosen(settings, patch.size()), settings.repeats, progress);
  bench.preparation_s = prepared - begin;
  return bench;
}

} // namespace keeler::bench
