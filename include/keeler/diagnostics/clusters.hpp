// Clusters of touching spheres: friends of friends, across the edges of the sheared box.
//
// Two spheres are friends if the gap between their surfaces is at most a given fraction of the sum of their radii.
// Friends of friends form a cluster. Its members are taken at adjacent images, so that it has a shape also if an edge
// of the box cuts it. A cluster that touches its own image is infinite and has none.
#pragma once

#include <keeler/particles/patch.hpp>

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace keeler::diagnostics {

inline constexpr double default_cluster_gap = 0.01; ///< gap between surfaces / sum of the radii

/// Spheres that touch, directly or through others.
struct Cluster {
  std::vector<std::uint32_t> members; ///< indices into the patch, ascending
  double mass = 0.0;                  ///< kg
  /// Half axes (m), longest first, of the homogeneous ellipsoid with equal moments of inertia: √(5 × principal
  /// second moments), with m r²/5 for each sphere. Empty for an infinite cluster.
  std::optional<std::array<double, 3>> half_axes;
  /// Spin about the vertical in units of Ω, relative to the stars: 1 + L_z/I_z about the centre of mass, from the
  /// positions and velocities of the centres. 1 is synchronous rotation; a round piece of undisturbed ring has 1 − S/2.
  /// Empty for an infinite cluster or a vertical pile.
  std::optional<double> spin;
};

/// Returns all clusters of two or more members, by descending mass, then by their first member. Precondition: gap ≥ 0.
std::vector<Cluster> find_clusters(const Patch& patch, double gap = default_cluster_gap);

/// Means over snapshots.
struct ClusterAnalysis {
  /// Clusters of `min_members` … 2 × `min_members` − 1 members.
  struct Class {
    std::size_t min_members = 0; ///< a power of two
    double count = 0.0;          ///< clusters per snapshot
    double mass_fraction = 0.0;  ///< of the total mass
  };

  double gap = default_cluster_gap;                       ///< as asked for
  double count = 0.0;                                     ///< clusters per snapshot
  double mass_fraction = 0.0;                             ///< of the total mass, in all clusters
  double largest_mass_fraction = 0.0;                     ///< of the total mass, in the heaviest cluster
  std::optional<std::array<double, 3>> largest_half_axes; ///< m, mean over snapshots with a finite heaviest cluster
  std::optional<double> spin;                             ///< mass-weighted mean of the clusters that have one
  std::vector<Class> spectrum;                            ///< from `min_members` = 2 up to the largest
};

/// Returns means over the patches. Precondition: at least one patch, none of them empty.
ClusterAnalysis analyze_clusters(std::span<const Patch> patches, double gap = default_cluster_gap);

} // namespace keeler::diagnostics
