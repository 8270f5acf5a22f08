#include <keeler/gravity/direct.hpp>

#include <keeler/core/threads.hpp>
#include <keeler/gravity/far_images.hpp>
#include <keeler/gravity/images.hpp>

#include <algorithm>
#include <numeric>

namespace keeler {
namespace {

// Indices in the order of the ids.
std::vector<std::size_t> order_by_id(std::span<const std::uint64_t> ids) {
  std::vector<std::size_t> order(ids.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return ids[a] < ids[b]; });
  return order;
}

// Particles inside the cell, in the order of their ids.
struct Ordered {
  std::vector<std::size_t> order; // indices of the problem
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

// Attractions per G of the sources and their near images at some of the sources' places.
std::vector<Vec3> near_attractions(const std::vector<PointSource>& sources, std::span<const std::size_t> places,
                                   const std::vector<Vec3>& shifts, const AttractionKernels& kernels) {
  std::vector<Vec3> result(places.size());
  parallel_for((places.size() + TargetBlock::capacity - 1) / TargetBlock::capacity,
               [&](std::size_t block) {
                 const std::size_t first = block * TargetBlock::capacity;
                 const std::size_t count = std::min(TargetBlock::capacity, places.size() - first);
                 TargetBlock targets{};
                 for (const Vec3& shift : shifts) { // an image at +shift attracts as the cell does a target at −shift
                   for (std::size_t k = 0; k < count; ++k) {
                     targets.x[k] = sources[places[first + k]].x - shift.x();
                     targets.y[k] = sources[places[first + k]].y - shift.y();
                     targets.z[k] = sources[places[first + k]].z;
                   }
                   kernels.points(targets, count, sources.data(), sources.size());
                 }
                 for (std::size_t k = 0; k < count; ++k)
                   result[first + k] = Vec3(targets.ax[k], targets.ay[k], targets.az[k]);
               },
               1);
  return result;
}

} // namespace

DirectSolver::DirectSolver(const ImageSettings& images, InstructionSet set) : images_(images), set_(set) {}

void DirectSolver::accelerate(const GravityProblem& problem, std::span<Vec3> accelerations) {
  std::vector<std::size_t> all(problem.positions.size());
  std::iota(all.begin(), all.end(), std::size_t{0});
  const std::vector<Vec3> result = sampled_accelerations(problem, all, images_, set_);
  std::copy(result.begin(), result.end(), accelerations.begin());
}

std::vector<Vec3> sampled_accelerations(const GravityProblem& problem, std::span<const std::size_t> sample,
                                        const ImageSettings& images, InstructionSet set) {
  const double offset = folded_offset(problem.box, problem.offset);
  const auto [order, sources] = ordered(problem, offset);
  std::vector<std::size_t> place_of(order.size());
  for (std::size_t k = 0; k < order.size(); ++k)
    place_of[order[k]] = k;
  std::vector<std::size_t> places;
  for (const std::size_t k : sample)
    places.push_back(place_of[k]);
  std::vector<Vec3> result =
      near_attractions(sources, places, near_images(problem.box, offset, images), attraction_kernels(set));
  const std::vector<Vec3> far = far_accelerations<double>(problem, offset, images, sources, set);
  for (std::size_t k = 0; k < result.size(); ++k)
    result[k] = problem.newton_g * result[k] + far[places[k]];
  return result;
}

} // namespace keeler
