// The transmission of a patch: straight rays at any elevation and azimuth through the periodic box, tested against its
// spheres.
//
// A line of sight has the direction d = (cos B cos φ, cos B sin φ, sin B): elevation B above the ring plane, azimuth φ
// from the radius outward (+x) towards the orbital motion (+y). A sphere blocks the ray through a point p of the plane
// z = 0 if p is in the sphere's shadow along d on that plane: an ellipse with the half axes r/sin B along φ and r
// across it, about the sphere's centre moved by −z cot B along φ. So the exact test of a ray against a sphere is that
// of a point against an ellipse, and each sphere is tested only against rays in its shadow and in the shadow's images.
#pragma once

#include <keeler/particles/patch.hpp>

#include <cstdint>
#include <optional>
#include <vector>

namespace keeler::diagnostics {

/// Angles in rad, 0 < elevation ≤ π/2.
struct LineOfSight {
  double elevation = 0.0; ///< B, above the ring plane
  double azimuth = 0.0;   ///< φ, from +x towards +y
};

/// Intersections of rays with the plane z = 0: one at random in each cell of a lattice over the box (stratified
/// sampling), reproducible by the seed. Whole blocks of cells form equal footprints.
class RayLattice {
public:
  /// Makes about `rays` rays, at least one per footprint. Footprints are near squares of side `footprint` (m), a whole
  /// number per box. Throws UsageError if there is no memory for them.
  RayLattice(const ShearingBox& box, std::size_t rays, double footprint, std::uint64_t seed = 1);

  std::size_t size() const { return positions_.size(); } ///< number of rays
  std::size_t columns() const { return columns_; }       ///< cells along x
  std::size_t rows() const { return rows_; }             ///< cells along y
  /// Returns the point of a ray in the plane z = 0, m. Rays are in the order of their cells, column by column.
  Vec3 position(std::size_t ray) const { return {positions_[ray].x, positions_[ray].y, 0.0}; }

  std::size_t footprints() const { return across_ * along_; }                       ///< number of footprints
  std::size_t rays_per_footprint() const { return size() / footprints(); }          ///< equal for all
  double footprint_x() const { return box_.size_x / static_cast<double>(across_); } ///< m
  double footprint_y() const { return box_.size_y / static_cast<double>(along_); }  ///< m

  /// Returns 1 for each ray that a sphere or one of its images blocks, else 0. Precondition: a box of this size.
  std::vector<std::uint8_t> blocked(const Patch& patch, const LineOfSight& sight) const;

  /// Returns the fraction of unblocked rays in each footprint.
  std::vector<double> transmissions(const std::vector<std::uint8_t>& blocked) const;

private:
  struct Position {
    double x, y;
  };

  ShearingBox box_;
  std::size_t across_ = 0, along_ = 0, columns_ = 0, rows_ = 0;
  std::vector<Position> positions_; // in the order of the cells: column by column
};

/// The transmission T of one patch and its standard error by the finite number of rays.
struct RayMean {
  double transmission = 0.0; ///< T, the fraction of unblocked rays
  double error = 0.0;        ///< of T
};

/// Returns T and its error. Estimates the error from the differences of rays in neighbouring cells, since each cell
/// holds only one.
RayMean ray_mean(const std::vector<std::uint8_t>& blocked);

} // namespace keeler::diagnostics
