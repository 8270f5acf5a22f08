#include <keeler/gravity/direct.hpp>

#include <keeler/core/threads.hpp>
#include <keeler/gravity/images.hpp>
#include <keeler/gravity/mean_sheet.hpp>
#include <keeler/gravity/single.hpp>

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

} // namespace

DirectSolver::DirectSolver(int image_rings, InstructionSet set, Precision precision)
    : image_rings_(image_rings), kernels_(attraction_kernels(set)), precision_(precision) {}

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
  const bool single = precision_ == Precision::single_precision;
  const SingleSources single_sources = single ? in_single(sources) : SingleSources{};

  constexpr std::size_t block_size = TargetBlock::capacity;
  parallel_for((sources.size() + block_size - 1) / block_size,
               [&](std::size_t block) {
                 const std::size_t first = block * block_size;
                 const Targets targets{&sources[first], std::min(block_size, sources.size() - first)};
                 Vec3 sums[block_size];
                 if (single)
                   sum_in_single(targets, shifts, kernels_, single_sources, sums);
                 else
                   sum_in_double(targets, shifts, kernels_, sources, sums);
                 for (std::size_t k = 0; k < targets.count; ++k)
                   accelerations[order[first + k]] = problem.newton_g * sums[k] + from_sheet[first + k];
               },
               1);
}

} // namespace keeler
