#include <keeler/gravity/direct.hpp>

#include "far_images.hpp"
#include "single.hpp"

#include <keeler/core/threads.hpp>
#include <keeler/gravity/images.hpp>
#include <keeler/particles/order.hpp>

#include <algorithm>
#include <numeric>

namespace keeler {
namespace {

// Particles inside the cell, in the order of their ids.
struct Ordered {
  std::vector<std::uint32_t> order; // indices of the problem
  std::vector<PointSource> sources;
};

Ordered ordered(const GravityProblem& problem, double offset) {
  Ordered result{order_by_id(problem.ids), {}};
  result.sources.reserve(result.order.size());
  for (const std::size_t k : result.order) {
    const Vec3 position = into_cell(problem.box, offset, problem.positions[k]);
    result.sources.push_back({position.x(), position.y(), position.z(), problem.masses[k]});
  }
  return result;
}

// A run of sources as targets.
struct Targets {
  const PointSource* first;
  std::size_t count;
};

// Σ m d / |d|³ of all sources and their images; an image at +shift attracts as the cell does a target at −shift.
void sum_in_double(Targets targets, const std::vector<Vec3>& shifts, const AttractionKernels& kernels,
                   const std::vector<PointSource>& sources, Vec3* sums) {
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

// Sources for single precision, with masses in units of the largest.
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

// The same sums in single precision.
void sum_in_single(Targets targets, const std::vector<Vec3>& shifts, const AttractionKernels& kernels,
                   const SingleSources& sources, Vec3* sums) {
  SingleTargetBlock block{};
  const PointRange all{0, static_cast<std::uint32_t>(sources.points.size())};
  for (const Vec3& shift : shifts) {
    for (std::size_t k = 0; k < targets.count; ++k) {
      split_place(targets.first[k].x - shift.x(), block.x[k], block.x_low[k]);
      split_place(targets.first[k].y - shift.y(), block.y[k], block.y_low[k]);
      split_place(targets.first[k].z, block.z[k], block.z_low[k]);
    }
    kernels.points_single(block, targets.count, sources.points.data(), &all, 1);
  }
  for (std::size_t k = 0; k < targets.count; ++k)
    sums[k] = sources.mass_unit * Vec3(block.ax[k], block.ay[k], block.az[k]);
}

// Attractions per G of the sources and their near images on some of the sources.
std::vector<Vec3> near_attractions(const std::vector<PointSource>& sources, std::span<const std::size_t> places,
                                   const std::vector<Vec3>& shifts, const AttractionKernels& kernels,
                                   Precision precision) {
  const bool single = precision == Precision::single_precision;
  const SingleSources single_sources = single ? in_single(sources) : SingleSources{};
  std::vector<PointSource> targets;
  for (const std::size_t place : places)
    targets.push_back(sources[place]);
  std::vector<Vec3> result(places.size());
  constexpr std::size_t block_size = TargetBlock::capacity;
  parallel_for((places.size() + block_size - 1) / block_size,
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
  std::vector<std::size_t> all(problem.positions.size());
  std::iota(all.begin(), all.end(), std::size_t{0});
  const std::vector<Vec3> result = sampled_accelerations(problem, all, images_, set_, precision_);
  std::copy(result.begin(), result.end(), accelerations.begin());
}

std::vector<Vec3> sampled_accelerations(const GravityProblem& problem, std::span<const std::size_t> sample,
                                        const ImageSettings& images, InstructionSet set, Precision precision) {
  const double offset = folded_offset(problem.box, problem.offset);
  const auto [order, sources] = ordered(problem, offset);
  std::vector<std::size_t> place_of(order.size());
  for (std::size_t k = 0; k < order.size(); ++k)
    place_of[order[k]] = k;
  std::vector<std::size_t> places;
  for (const std::size_t k : sample)
    places.push_back(place_of[k]);
  const ImageSettings all = rings_for_height(images, problem.box, height_of(sources));
  std::vector<Vec3> result =
      near_attractions(sources, places, near_images(problem.box, offset, all), attraction_kernels(set), precision);
  const std::vector<Vec3> far = far_accelerations<double>(problem, offset, all, sources, set);
  for (std::size_t k = 0; k < result.size(); ++k)
    result[k] = problem.newton_g * result[k] + far[places[k]];
  return result;
}

} // namespace keeler
