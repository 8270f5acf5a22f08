// The cell of the sheared box as a closed scene: all spheres and images of spheres that reach into the rectangle
// [−L_x/2, L_x/2] × [−L_y/2, L_y/2], at one instant. A ray that leaves the cell by a face goes on at the opposite face
// (shifted by the shear offset along the orbit), so coordinates are never larger than the cell, however far a ray goes.
#pragma once

#include <keeler/particles/patch.hpp>

#include <cstdint>
#include <vector>

namespace keeler::light {

struct CellSphere {
  Vec3 centre;
  double radius;
  std::uint32_t particle; ///< index in the patch
};

class SphereCell {
public:
  /// Precondition: a patch with particles.
  explicit SphereCell(const Patch& patch);

  const std::vector<CellSphere>& spheres() const { return spheres_; }
  double bottom() const { return bottom_; } ///< lowest point of a sphere, m
  double top() const { return top_; }       ///< highest point
  const ShearingBox& box() const { return box_; }

  /// Spheres this far outside the cell are in it too, m; a bound of the rounding of single precision within the cell:
  /// centres, radii and the origins of rays are below the length of the cell, and each is rounded by 2⁻²⁴ of itself.
  double margin() const { return margin_; }

  /// Returns the image of a point in the cell.
  Vec3 inside(Vec3 point) const;

  /// Returns how far a ray from a point of the cell goes until it leaves the cell or the layer; infinity is never
  /// returned for a direction of length 1. `leaves_layer` tells which.
  double way_out(const Vec3& point, const Vec3& direction, bool& leaves_layer) const;

  /// Returns the point after such a way, on the opposite face.
  Vec3 across(const Vec3& point, const Vec3& direction, double way) const;

private:
  ShearingBox box_;
  double offset_, bottom_, top_, margin_;
  std::vector<CellSphere> spheres_;
};

/// Returns by how much the distance of a ray from the limb of a sphere can be wrong in single precision, m: a ray that
/// passes a limb at a larger distance is blocked, or not, as in exact arithmetic. Origin, centre, direction and the
/// point of closest approach are each rounded by 2⁻²⁴ of lengths up to the cell's (tests/unit/light/tracer.cpp).
double single_precision_bound(const SphereCell& cell);

} // namespace keeler::light
