#include <keeler/gravity/direct.hpp>

#include "far_images.hpp"
#include "single.hpp"

#include <keeler/core/parallel.hpp>
#include <keeler/core/threads.hpp>
#include <keeler/gravity/images.hpp>
#include <keeler/particles/order.hpp>

#include <algorithm>
#include <cassert>
#include <numeric>

namespace keeler::gravity {
namespace {

// Particles folded into the cell, sorted by id.
struct Ordered {
  std::vector<std::uint32_t> order; // indices in the problem's arrays
  std::vector<PointSource> sources;
};

Ordered ordered(const GravityProblem& problem, double offset) {
  Ordered result{particles::order_by_id(problem.ids), {}};
  result.sources.reserve(result.order.size());
  for (const std::size_t k : result.order) {
    const Vec3 position = into_cell(problem.box, offset, problem.positions[k]);
    result.sources.push_back({position.x(), position.y(), position.z(), problem.masses[k]});
  }
  return result;
}

// Consecutive sources as targets, at most TargetBlock::capacity.
struct Targets {
  const PointSource* first;
  std::size_t count;
};

// Writes Σ m d / |d|³ over all sources and their images. An image at +shift attracts as the cell does a target at
// −shift.
void sum_in_double(Targets targets, const std::vector<Vec3>& shifts, const AttractionKernels& kernels,
                   const std::vector<PointSource>& sources, Vec3* sums) {
  assert(targets.count <= TargetBlock::capacity);
  TargetBlock block{};
  for (const Vec3& shift : shifts) {
    for (std::size_t k = 0; k < targets.count; ++k) {
      block.x[k] = targets.first[k].x - shift.x();
      block.y[k] = targets.first[k].y - shift.y();
      block.z[k] = targets.first[k].z;
    }
    kernels.points(block, targets.count, sources.data(), sources.size());
  }
  for (std::size_t k = 0; k < targets.count; ++k)
    sums[k] = {block.ax[k], block.ay[k], block.az[k]};
}

// Sources in single precision, masses in units of the largest.
struct SingleSources {
  std::vector<SinglePoint> points;
  double mass_unit = 0.0;
};

SingleSources in_single(const std::vector<PointSource>& sources) {
  SingleSources single;
  for (const PointSource& s : sources)
    single.mass_unit = std::max(single.mass_unit, s.mass);
  const double unit = single.mass_unit > 0.0 ? 1.0 / single.mass_unit : 0.0;
  for (const PointSource& s : sources)
    single.points.push_back(single_point({s.x, s.y, s.z, unit * s.mass}));
  return single;
}

// As sum_in_double(), in single precision.
void sum_in_single(Targets targets, const std::vector<Vec3>& shifts, const AttractionKernels& kernels,
                   const SingleSources& sources, Vec3* sums) {
  assert(targets.count <= SingleTargetBlock::capacity);
  SingleTargetBlock block{};
  const PointRange all{0, static_cast<std::uint32_t>(sources.points.size())};
  for (const Vec3& shift : shifts) {
    for (std::size_t k = 0; k < targets.count; ++k) {
      split_position(targets.first[k].x - shift.x(), block.x[k], block.x_low[k]);
      split_position(targets.first[k].y - shift.y(), block.y[k], block.y_low[k]);
      split_position(targets.first[k].z, block.z[k], block.z_low[k]);
    }
    kernels.points_single(block, targets.count, sources.points.data(), &all, 1);
  }
  for (std::size_t k = 0; k < targets.count; ++k)
    sums[k] = sources.mass_unit * Vec3(block.ax[k], block.ay[k], block.az[k]);
}

// Returns the attraction per G of all sources and their near images on each target.
std::vector<Vec3> near_attractions(const std::vector<PointSource>& sources, const std::vector<PointSource>& targets,
                                   const std::vector<Vec3>& shifts, const AttractionKernels& kernels,
                                   Precision precision) {
  const bool single = precision == Precision::single_precision;
  const SingleSources single_sources = single ? in_single(sources) : SingleSources{};
  std::vector<Vec3> result(targets.size());
  // a sample has fewer targets than a block holds: then each thread has some
  constexpr std::size_t capacity = TargetBlock::capacity, lanes = 16;
  const std::size_t shared = targets.size() / static_cast<std::size_t>(threads());
  const std::size_t block_size = std::min(capacity, shared / lanes * lanes + lanes);
  parallel_for((targets.size() + block_size - 1) / block_size,
               [&](std::size_t block) {
                 const std::size_t first = block * block_size;
                 const Targets some{&targets[first], std::min(block_size, targets.size() - first)};
                 if (single)
                   sum_in_single(some, shifts, kernels, single_sources, &result[first]);
                 else
                   sum_in_double(some, shifts, kernels, sources, &result[first]);
               },
               1);
  return result;
}

} // namespace

DirectSolver::DirectSolver(const ImageSettings& images, InstructionSet set, Precision precision)
    : images_(images), set_(set), precision_(precision) {}

void DirectSolver::accelerate(const GravityProblem& problem, std::span<Vec3> accelerations) {
  assert(accelerations.size() == problem.positions.size());
  std::vector<std::size_t> all(problem.positions.size());
  std::iota(all.begin(), all.end(), std::size_t{0});
  const std::vector<Vec3> result = sampled_accelerations(problem, all, images_, set_, precision_);
  std::copy(result.begin(), result.end(), accelerations.begin());
}

std::vector<Vec3> sampled_accelerations(const GravityProblem& problem, std::span<const std::size_t> sample,
                                        const ImageSettings& images, InstructionSet set, Precision precision) {
  assert(problem.masses.size() == problem.positions.size() && problem.ids.size() == problem.positions.size());
  assert(!problem.ranks.distributed());
  const double offset = folded_offset(problem.box, problem.offset);
  const auto [order, sources] = ordered(problem, offset);
  std::vector<std::size_t> sorted_index(order.size());
  for (std::size_t k = 0; k < order.size(); ++k)
    sorted_index[order[k]] = k;
  std::vector<PointSource> targets;
  for (const std::size_t k : sample) {
    assert(k < sorted_index.size());
    targets.push_back(sources[sorted_index[k]]);
  }
  const ImageSettings all = rings_for_height(images, problem.box, height_of(sources));
  std::vector<Vec3> result =
      near_attractions(sources, targets, near_images(problem.box, offset, all), attraction_kernels(set), precision);
  const std::vector<Vec3> far = far_accelerations<double>(problem, offset, all, sources, targets, set);
  for (std::size_t k = 0; k < result.size(); ++k)
    result[k] = problem.newton_g * result[k] + far[k];
  return result;
}

} // namespace keeler::gravity
