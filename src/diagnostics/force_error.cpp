#include <keeler/diagnostics/force_error.hpp>

#include <keeler/core/random.hpp>
#include <keeler/core/threads.hpp>
#include <keeler/core/units.hpp>
#include <keeler/gravity/images.hpp>
#include <keeler/particles/order.hpp>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <map>

namespace keeler::diagnostics {
namespace {

// Draws places in a list of `candidates` by a partial shuffle (Fisher and Yates), which keeps what it has moved alone.
std::vector<std::size_t> draw_places(std::size_t candidates, std::size_t count, RandomStream& random) {
  std::map<std::size_t, std::size_t> moved;
  const auto at = [&](std::size_t place) {
    const auto found = moved.find(place);
    return found == moved.end() ? place : found->second;
  };
  std::vector<std::size_t> drawn;
  for (std::size_t k = 0; k < std::min(count, candidates); ++k) {
    const std::size_t other = k + static_cast<std::size_t>(random.uniform() * static_cast<double>(candidates - k));
    drawn.push_back(at(other));
    moved[other] = at(k);
  }
  return drawn;
}

void draw(const std::vector<std::size_t>& candidates, std::size_t count, RandomStream& random,
          std::vector<std::size_t>& drawn) {
  for (const std::size_t place : draw_places(candidates.size(), count, random))
    drawn.push_back(candidates[place]);
}

RandomStream sample_stream() {
  return {1, RandomPurpose::sample, 0};
}

// Returns the distance of a particle from the cell's edges x < 0, x > 0, y < 0, y > 0, m.
std::array<double, 4> depths(const gravity::GravityProblem& problem, double offset, std::size_t k) {
  const Vec3 p = gravity::into_cell(problem.box, offset, problem.positions[k]);
  const double half_x = 0.5 * problem.box.size_x, half_y = 0.5 * problem.box.size_y;
  return {p.x() + half_x, half_x - p.x(), p.y() + half_y, half_y - p.y()};
}

template<class Value> double mean_over(std::size_t begin, std::size_t end, const Value& value) {
  double sum = 0.0;
  for (std::size_t k = begin; k < end; ++k)
    sum += value(k);
  return begin < end ? sum / static_cast<double>(end - begin) : 0.0;
}

double percentile_999(const std::vector<Vec3>& errors, std::size_t count) {
  if (count == 0)
    return 0.0;
  std::vector<double> sizes;
  for (std::size_t k = 0; k < count; ++k)
    sizes.push_back(errors[k].norm());
  std::sort(sizes.begin(), sizes.end());
  return sizes[static_cast<std::size_t>(std::ceil(0.999 * static_cast<double>(count))) - 1];
}

} // namespace

gravity::GravityProblem gravity_problem(const Patch& patch) {
  return {patch.positions, patch.masses, patch.ids, patch.box, patch.offset, newton_g(patch.orbital_frequency)};
}

ForceSample draw_force_sample(const gravity::GravityProblem& problem, std::size_t uniform, std::size_t at_each_edge,
                              double edge_width) {
  assert(problem.ids.size() == problem.positions.size());
  ForceSample sample;
  RandomStream random = sample_stream();
  const std::vector<std::uint32_t> order = particles::order_by_id(problem.ids);
  std::vector<std::size_t> all(order.begin(), order.end());
  std::array<std::vector<std::size_t>, 4> beside;
  const double offset = gravity::folded_offset(problem.box, problem.offset);
  for (const std::size_t k : all) {
    const std::array<double, 4> depth = depths(problem, offset, k);
    for (std::size_t edge = 0; edge < 4; ++edge)
      if (depth[edge] < edge_width)
        beside[edge].push_back(k);
  }
  draw(all, uniform, random, sample.targets);
  sample.uniform = sample.targets.size();
  for (std::size_t edge = 0; edge < 4; ++edge) {
    const std::size_t before = sample.targets.size();
    draw(beside[edge], at_each_edge, random, sample.targets);
    sample.edges[edge] = sample.targets.size() - before;
  }
  return sample;
}

std::vector<std::size_t> draw_force_places(std::size_t count, std::size_t uniform) {
  RandomStream random = sample_stream();
  return draw_places(count, uniform, random);
}

ForceErrors force_errors(const ForceSample& sample, std::span<const Vec3> exact, std::span<const Vec3> accelerations) {
  assert(exact.size() == sample.targets.size() && sample.uniform <= sample.targets.size());
  std::vector<Vec3> errors;
  for (std::size_t k = 0; k < sample.targets.size(); ++k)
    errors.push_back(accelerations[sample.targets[k]] - exact[k]);
  const std::size_t uniform = sample.uniform, all = errors.size();
  const double size = std::sqrt(mean_over(0, uniform, [&](std::size_t k) { return exact[k].squaredNorm(); }));
  const double in_plane =
      std::sqrt(mean_over(0, uniform, [&](std::size_t k) { return exact[k].head<2>().squaredNorm(); }));
  if (!(in_plane > 0.0))
    return {};
  const auto squares = [&](std::size_t k) { return errors[k].squaredNorm(); };
  ForceErrors result;
  result.rms = std::sqrt(mean_over(0, uniform, squares)) / size;
  result.p999 = percentile_999(errors, uniform) / size;
  for (int axis = 0; axis < 3; ++axis)
    result.component_rms[static_cast<std::size_t>(axis)] =
        std::sqrt(mean_over(0, uniform, [&](std::size_t k) { return errors[k][axis] * errors[k][axis]; })) / size;
  result.edge_rms = std::sqrt(mean_over(uniform, all, squares)) / size;
  std::size_t begin = uniform;
  for (const std::size_t count : sample.edges) {
    const double pull_x = mean_over(begin, begin + count, [&](std::size_t k) { return errors[k].x(); });
    const double pull_y = mean_over(begin, begin + count, [&](std::size_t k) { return errors[k].y(); });
    result.edge_pull = std::max(result.edge_pull, std::hypot(pull_x, pull_y) / in_plane);
    begin += count;
  }
  return result;
}

double net_force(std::span<const double> masses, std::span<const Vec3> accelerations) {
  assert(masses.size() == accelerations.size());
  Vec3 sum = Vec3::Zero();
  double sizes = 0.0;
  for (std::size_t k = 0; k < masses.size(); ++k) {
    sum += masses[k] * accelerations[k];
    sizes += masses[k] * accelerations[k].norm();
  }
  return sizes > 0.0 ? sum.norm() / sizes : 0.0;
}

} // namespace keeler::diagnostics
