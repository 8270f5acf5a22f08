#include "direct_sources.hpp"

#include "single.hpp"

#include <algorithm>
#include <cassert>

namespace keeler::gravity {
namespace {

template<class Block> void load_sums(Block& block, std::span<const Vec3> sums) {
  for (std::size_t k = 0; k < sums.size(); ++k) {
    block.ax[k] = sums[k].x();
    block.ay[k] = sums[k].y();
    block.az[k] = sums[k].z();
  }
}

template<class Block> void store_sums(const Block& block, std::span<Vec3> sums) {
  for (std::size_t k = 0; k < sums.size(); ++k)
    sums[k] = {block.ax[k], block.ay[k], block.az[k]};
}

} // namespace

double largest_mass(const std::vector<PointSource>& sources) {
  double largest = 0.0;
  for (const PointSource& s : sources)
    largest = std::max(largest, s.mass);
  return largest;
}

DirectSources::DirectSources(const std::vector<PointSource>& sources, double mass_unit, Precision precision)
    : sources_(sources), precision_(precision) {
  if (precision == Precision::double_precision)
    return;
  unit_ = mass_unit;
  const double inverse = unit_ > 0.0 ? 1.0 / unit_ : 0.0;
  points_.reserve(sources.size());
  for (const PointSource& s : sources)
    points_.push_back(single_point({s.x, s.y, s.z, inverse * s.mass}));
}

void DirectSources::add_to(std::span<const PointSource> targets, std::span<const Vec3> shifts,
                           const AttractionKernels& kernels, std::span<Vec3> sums) const {
  assert(targets.size() <= TargetBlock::capacity && sums.size() == targets.size());
  if (precision_ == Precision::double_precision)
    add_in_double(targets, shifts, kernels, sums);
  else
    add_in_single(targets, shifts, kernels, sums);
}

// An image at +shift attracts as the cell does a target at −shift.
void DirectSources::add_in_double(std::span<const PointSource> targets, std::span<const Vec3> shifts,
                                  const AttractionKernels& kernels, std::span<Vec3> sums) const {
  TargetBlock block{};
  load_sums(block, sums);
  for (const Vec3& shift : shifts) {
    for (std::size_t k = 0; k < targets.size(); ++k) {
      block.x[k] = targets[k].x - shift.x();
      block.y[k] = targets[k].y - shift.y();
      block.z[k] = targets[k].z;
    }
    kernels.points(block, targets.size(), sources_.data(), sources_.size());
  }
  store_sums(block, sums);
}

void DirectSources::add_in_single(std::span<const PointSource> targets, std::span<const Vec3> shifts,
                                  const AttractionKernels& kernels, std::span<Vec3> sums) const {
  SingleTargetBlock block{};
  load_sums(block, sums);
  const PointRange all{0, static_cast<std::uint32_t>(points_.size())};
  for (const Vec3& shift : shifts) {
    for (std::size_t k = 0; k < targets.size(); ++k) {
      split_position(targets[k].x - shift.x(), block.x[k], block.x_low[k]);
      split_position(targets[k].y - shift.y(), block.y[k], block.y_low[k]);
      split_position(targets[k].z, block.z[k], block.z_low[k]);
    }
    kernels.points_single(block, targets.size(), points_.data(), &all, 1);
  }
  store_sums(block, sums);
}

} // namespace keeler::gravity
