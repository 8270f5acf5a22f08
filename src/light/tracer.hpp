// What a ray among the spheres of a patch meets first, through all periodic images, by Intel's Embree.
#pragma once

#include "sphere_cell.hpp"

#include <memory>
#include <optional>
#include <span>

namespace keeler::light {

/// A sphere that a ray meets.
struct Hit {
  Vec3 point;             ///< on the sphere; in the cell but for the radius of the sphere
  Vec3 normal;            ///< outward
  double radius;          ///< of the sphere, m
  std::uint32_t particle; ///< index in the patch
};

class Tracer {
public:
  /// Throws Error without Embree, UsageError for a patch without particles or with no memory for it.
  explicit Tracer(const Patch& patch);
  ~Tracer();
  Tracer(Tracer&&) noexcept;
  Tracer& operator=(Tracer&&) noexcept;

  const SphereCell& cell() const { return *cell_; }

  /// Returns the first sphere on a ray from a point within the layer. Precondition: the direction has the length 1.
  std::optional<Hit> first_hit(const Vec3& origin, const Vec3& direction) const;

  /// True if there is any sphere on such a ray.
  bool blocked(const Vec3& origin, const Vec3& direction) const;

  /// Counts the rays from these points that meet a sphere before they leave the cell, by Embree's queries as they are:
  /// of single rays, or of packets of 16. A yardstick for the two above, which follow a ray across the faces of the
  /// cell.
  std::size_t count_blocked_in_cell(std::span<const Vec3> origins, const Vec3& direction, bool in_packets) const;

  /// Returns the beginning of a ray that leaves a sphere at a hit, outward: off its surface by the rounding of single
  /// precision.
  Vec3 leaving(const Hit& hit) const { return hit.point + cell_->margin() * hit.normal; }

private:
  struct Scene; // of Embree
  std::unique_ptr<SphereCell> cell_;
  std::unique_ptr<Scene> scene_;
};

} // namespace keeler::light
