// Sums over all particles of a list, for some targets: the core of the direct sum.
#pragma once

#include "kernels.hpp"

#include <keeler/core/vector.hpp>
#include <keeler/gravity/direct.hpp>

#include <span>
#include <vector>

namespace keeler::gravity {

double largest_mass(const std::vector<PointSource>& sources); ///< kg; 0 without sources

class DirectSources {
public:
  /// `sources` must outlive this object. `mass_unit`: the largest mass of the problem, kg.
  DirectSources(const std::vector<PointSource>& sources, double mass_unit, Precision precision);

  /// Adds Σ m d / |d|³ over the sources and their images at these shifts, in units of unit(); up to
  /// TargetBlock::capacity targets. A list of sources may be added in parts, if all but the last are multiples of 128.
  void add_to(std::span<const PointSource> targets, std::span<const Vec3> shifts, const AttractionKernels& kernels,
              std::span<Vec3> sums) const;
  double unit() const { return unit_; } ///< kg

private:
  void add_in_double(std::span<const PointSource> targets, std::span<const Vec3> shifts,
                     const AttractionKernels& kernels, std::span<Vec3> sums) const;
  void add_in_single(std::span<const PointSource> targets, std::span<const Vec3> shifts,
                     const AttractionKernels& kernels, std::span<Vec3> sums) const;

  const std::vector<PointSource>& sources_;
  Precision precision_;
  double unit_ = 1.0;
  std::vector<SinglePoint> points_; // in single precision
};

} // namespace keeler::gravity
