#include <keeler/gravity/direct.hpp>

#include <keeler/core/threads.hpp>
#include <keeler/gravity/images.hpp>
#include <keeler/gravity/mean_sheet.hpp>

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

} // namespace

DirectSolver::DirectSolver(int image_rings, InstructionSet set)
    : image_rings_(image_rings), kernels_(attraction_kernels(set)) {}

void DirectSolver::accelerate(const GravityProblem& problem, std::span<Vec3> accelerations) {
  const double offset = folded_offset(problem.box, problem.offset);
  const std::vector<Vec3> shifts = image_shifts(problem.box, offset, image_rings_);
  const std::vector<std::size_t> order = order_by_id(problem.ids);
  std::vector<PointSource> sources;
  sources.reserve(order.size());
  for (const std::size_t k : order) {
    const Vec3 position = into_cell(problem.box, offset, problem.positions[k]);
    sources.push_back({position.x(), position.y(), position.z(), problem.masses[k]});
  }
  const std::vector<Vec3> from_sheet = sheet_accelerations(problem, offset, image_rings_, sources);

  const std::size_t block_count = (order.size() + TargetBlock::capacity - 1) / TargetBlock::capacity;
  parallel_for(
      block_count,
      [&](std::size_t block) {
        const std::size_t first = block * TargetBlock::capacity;
        const std::size_t count = std::min(TargetBlock::capacity, order.size() - first);
        TargetBlock targets{};
        for (const Vec3& shift : shifts) { // an image at +shift attracts as the cell does a target at −shift
          for (std::size_t k = 0; k < count; ++k) {
            targets.x[k] = sources[first + k].x - shift.x();
            targets.y[k] = sources[first + k].y - shift.y();
            targets.z[k] = sources[first + k].z;
          }
          kernels_.points(targets, count, sources.data(), sources.size());
        }
        for (std::size_t k = 0; k < count; ++k)
          accelerations[order[first + k]] =
              problem.newton_g * Vec3(targets.ax[k], targets.ay[k], targets.az[k]) + from_sheet[first + k];
      },
      1);
}

} // namespace keeler
