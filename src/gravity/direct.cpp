#include <keeler/gravity/direct.hpp>

#include "direct_sources.hpp"
#include "far_images.hpp"
#include "gathered.hpp"

#include <keeler/core/parallel.hpp>
#include <keeler/core/threads.hpp>
#include <keeler/gravity/images.hpp>
#include <keeler/particles/order.hpp>

#include <algorithm>
#include <cassert>
#include <numeric>

namespace keeler::gravity {
namespace {

// Particle k of the problem, folded into the cell.
PointSource source_at(const GravityProblem& problem, double offset, std::size_t k) {
  const Vec3 position = into_cell(problem.box, offset, problem.positions[k]);
  return {position.x(), position.y(), position.z(), problem.masses[k]};
}

std::vector<PointSource> sources_by_id(const GravityProblem& problem, double offset) {
  std::vector<PointSource> sources;
  sources.reserve(problem.ids.size());
  for (const std::size_t k : particles::order_by_id(problem.ids))
    sources.push_back(source_at(problem, offset, k));
  return sources;
}

// Returns the attraction per G of all sources and their near images on each target.
std::vector<Vec3> near_attractions(const std::vector<PointSource>& sources, const std::vector<PointSource>& targets,
                                   const std::vector<Vec3>& shifts, const AttractionKernels& kernels,
                                   Precision precision) {
  const DirectSources prepared(sources, largest_mass(sources), precision);
  std::vector<Vec3> result(targets.size(), Vec3::Zero());
  // a sample has fewer targets than a block holds: then each thread has some
  constexpr std::size_t capacity = TargetBlock::capacity, lanes = 16;
  const std::size_t shared = targets.size() / static_cast<std::size_t>(threads());
  const std::size_t block_size = std::min(capacity, shared / lanes * lanes + lanes);
  parallel_for((targets.size() + block_size - 1) / block_size,
               [&](std::size_t block) {
                 const std::size_t first = block * block_size;
                 const std::size_t count = std::min(block_size, targets.size() - first);
                 prepared.add_to(std::span(targets).subspan(first, count), shifts, kernels,
                                 std::span(result).subspan(first, count));
               },
               1);
  for (Vec3& sum : result)
    sum *= prepared.unit();
  return result;
}

} // namespace

DirectSolver::DirectSolver(const ImageSettings& images, InstructionSet set, Precision precision)
    : images_(images), set_(set), precision_(precision) {}

void DirectSolver::accelerate(const GravityProblem& problem, std::span<Vec3> accelerations) {
  assert(accelerations.size() == problem.positions.size());
  if constexpr (Communicator::possible)
    if (problem.ranks.distributed())
      return accelerate_distributed(problem, accelerations);
  std::vector<std::size_t> all(problem.positions.size());
  std::iota(all.begin(), all.end(), std::size_t{0});
  const std::vector<Vec3> result = sampled_accelerations(problem, all, images_, set_, precision_);
  std::copy(result.begin(), result.end(), accelerations.begin());
}

// Each rank sums over the particles of all ranks, for its own ones.
void DirectSolver::accelerate_distributed(const GravityProblem& problem, std::span<Vec3> accelerations) {
  const GatheredParticles all(problem);
  std::vector<std::size_t> own(accelerations.size());
  std::iota(own.begin(), own.end(), all.first_of_rank()[problem.ranks.rank()]);
  const std::vector<Vec3> result = sampled_accelerations(all.problem(), own, images_, set_, precision_);
  std::copy(result.begin(), result.end(), accelerations.begin());
}

std::vector<Vec3> sampled_accelerations(const GravityProblem& problem, std::span<const std::size_t> sample,
                                        const ImageSettings& images, InstructionSet set, Precision precision) {
  assert(problem.masses.size() == problem.positions.size() && problem.ids.size() == problem.positions.size());
  assert(!problem.ranks.distributed());
  const double offset = folded_offset(problem.box, problem.offset);
  const std::vector<PointSource> sources = sources_by_id(problem, offset);
  std::vector<PointSource> targets;
  targets.reserve(sample.size());
  for (const std::size_t k : sample) {
    assert(k < problem.ids.size());
    targets.push_back(source_at(problem, offset, k));
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
