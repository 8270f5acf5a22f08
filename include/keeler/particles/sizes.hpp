// Size distributions of ring particles.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace keeler {

/// n(r) dr ∝ r^−q between two radii; `equal` when min = max; or radii listed in a file.
struct SizeLaw {
  enum class Kind { equal, power, file };
  Kind kind = Kind::equal;
  double exponent = 3.0;      ///< q
  double min = 1.0;           ///< m; the radius for `equal`
  double max = 1.0;           ///< m
  std::string path;           ///< for `file`: one radius (m) a line, '#' starts a comment; drawn in turn
  std::vector<double> listed; ///< the radii of that file

  /// ⟨r^k⟩ over the distribution.
  double mean_power(int k) const;
  double largest() const;
};

/// Radii (m) of particles 0 … count−1: the quantiles of the law at jittered even spacing, in an order shuffled by id,
/// so that even a small sample has the law's moments. Same seed, same radii.
std::vector<double> draw_radii(const SizeLaw& law, std::size_t count, std::uint64_t seed);

} // namespace keeler
