// Clusters of touching spheres: friends of friends, across the edges of the sheared box.
//
// Two spheres are friends when the gap between their surfaces is at most a share of the sum of their radii. Friends of
// friends make a cluster. Its members stand at their images next to each other, so that it has a shape also when an
// edge of the box cuts it. A cluster that touches its own image goes on for ever and has none.
#pragma once

#include <keeler/particles/patch.hpp>

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace keeler {

inline constexpr double default_cluster_gap = 0.01;

struct Cluster {
  std::vector<std::uint32_t> members; ///< indices into the patch, rising
  double mass = 0.0;                  ///< kg
  /// Half axes (m), longest first, of the homogeneous ellipsoid with the same moments of inertia: √(5 × principal
  /// second moments), with m r²/5 for each sphere. None for a cluster without end.
  std::optional<std::array<double, 3>> half_axes;
  /// Spin about the vertical in units of Ω, seen from the stars: 1 + L_z/I_z about the centre of mass, from the places
  /// and velocities of the centres alone. 1 keeps one face to the planet; a round piece of undisturbed ring has
  /// 1 − S/2. None for a cluster without end or a vertical pile.
  std::optional<double> spin;
};

/// All clusters of two or more members, the heaviest first, then by their first member. `gap` ≥ 0.
std::vector<Cluster> find_clusters(const Patch& patch, double gap = default_cluster_gap);

/// Means over snapshots.
struct ClusterAnalysis {
  /// Clusters of `least` … 2 `least` − 1 members.
  struct Class {
    std::size_t least = 0;
    double count = 0.0;         ///< clusters a snapshot
    double mass_fraction = 0.0; ///< of all mass
  };

  double gap = default_cluster_gap;
  double count = 0.0;                                     ///< clusters of two or more
  double mass_fraction = 0.0;                             ///< of all mass: in such clusters
  double largest_mass_fraction = 0.0;                     ///< of all mass: in the heaviest one
  std::optional<std::array<double, 3>> largest_half_axes; ///< m, over the snapshots whose heaviest has them
  std::optional<double> spin;                             ///< mean over the mass of all clusters that have one
  std::vector<Class> spectrum;                            ///< from `least` = 2 on, up to the largest
};

/// Of at least one patch, none of them empty.
ClusterAnalysis analyze_clusters(std::span<const Patch> patches, double gap = default_cluster_gap);

} // namespace keeler
