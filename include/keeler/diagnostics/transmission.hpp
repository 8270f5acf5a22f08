// How much light passes a patch: straight rays at any elevation and azimuth through the periodic box, against its
// spheres.
//
// A line of sight has the direction d = (cos B cos φ, cos B sin φ, sin B): elevation B above the ring plane, azimuth φ
// from the radius outward (+x) towards the orbital motion (+y). A sphere blocks the ray through a point p of the plane
// z = 0 when p lies in the sphere's shadow along d on that plane: an ellipse with the half axes r/sin B along φ and r
// across it, about the sphere's centre moved by −z cot B along φ. So the exact test of a ray against a sphere is that
// of a point against an ellipse, and each sphere only meets the rays in its shadow and in the shadow's images.
#pragma once

#include <keeler/cells/sheared_cells.hpp>
#include <keeler/particles/patch.hpp>

#include <cstdint>
#include <optional>
#include <vector>

namespace keeler {

/// Angles in rad, 0 < elevation ≤ π/2.
struct LineOfSight {
  double elevation = 0.0, azimuth = 0.0;
};

/// Where rays cross the plane z = 0: one at random in each cell of a lattice over the box (stratified sampling), always
/// the same. Whole blocks of cells make up equal footprints.
class RayLattice {
public:
  /// About `rays` rays, at least one a footprint; footprints are near squares of side `footprint` (m), a whole number a
  /// box. Throws UsageError where there is no memory for so many.
  RayLattice(const ShearingBox& box, std::size_t rays, double footprint, std::uint64_t seed = 1);

  std::size_t size() const { return places_.size(); }
  std::size_t columns() const { return columns_; }
  std::size_t rows() const { return rows_; }
  Vec3 place(std::size_t ray) const { return {places_[ray].x, places_[ray].y, 0.0}; }

  std::size_t footprints() const { return across_ * along_; }
  std::size_t rays_a_footprint() const { return size() / footprints(); }
  double footprint_x() const { return box_.size_x / static_cast<double>(across_); } ///< m
  double footprint_y() const { return box_.size_y / static_cast<double>(along_); }  ///< m

  /// 1 for each ray that a sphere of the patch or of its images blocks, else 0. The patch's box has the same size.
  std::vector<std::uint8_t> blocked(const Patch& patch, const LineOfSight& sight) const;

  /// Of rays that are blocked or not: the share that passes in each footprint.
  std::vector<double> shares(const std::vector<std::uint8_t>& blocked) const;

private:
  struct Place {
    double x, y;
  };

  ShearingBox box_;
  std::size_t across_ = 0, along_ = 0, columns_ = 0, rows_ = 0;
  std::vector<Place> places_; // in the order of cells: column by column
};

/// The transmission T of one patch and the standard error that comes from the finite number of rays.
struct RayMean {
  double transmission = 0.0, error = 0.0;
};

/// The error is estimated from the differences of rays in neighbouring cells, since each cell holds only one.
RayMean ray_mean(const std::vector<std::uint8_t>& blocked);

} // namespace keeler
