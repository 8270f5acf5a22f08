// The exact field of one unit mass with all its images, open in z: what a shear-periodic solver must give, pair by
// pair.
//
// Ewald's sum for a sheet (e.g. Koyama & Ostriker 2009, ApJ 693, 1316, for the waves' part): near images with their
// attraction cut off beyond a few split lengths, and the rest as waves e^{ik·r} with the 3-D Gaussian's profile across
// the plane. The wave k = 0 is the mean sheet, which pulls by 2π/A far above and nowhere along the plane. G = 1.
#pragma once

#include <keeler/core/vector.hpp>
#include <keeler/hill/shearing_box.hpp>

#include <vector>

namespace keeler {

/// A wave that fits the sheared box; one of each pair ±k.
struct LatticeWave {
  double kx, ky, k; ///< rad/m
};

class Lattice {
public:
  /// The lattice of a box at a shear offset. Terms below `tolerance` of the largest are left out; 0 < tolerance < 1.
  /// The split length is given in sides of a square box of the same area and changes no result, only whether there are
  /// more images to sum or more waves; with the default as many of one as of the other.
  Lattice(const ShearingBox& box, double offset, double tolerance = 1e-15, double relative_split = 0.237);

  /// Acceleration (1/m²) at a displacement from the mass. An image that stands exactly there does not act.
  Vec3 acceleration(const Vec3& displacement) const;

  /// Potential (1/m) there; its zero is that of the sums, with k = 0 as −2π/A times the mean of |z|. An image that
  /// stands exactly there does not count.
  double potential(const Vec3& displacement) const;

  /// r_s: near images fade as erfc(d / 2 r_s), waves as e^{−k² r_s²}.
  double split_length() const { return split_; }

  /// Distance beyond which a near image no longer counts, m.
  double reach() const { return reach_; }

  const std::vector<LatticeWave>& waves() const { return waves_; }

  /// The part of a wave in the potential at a height, 2 φ_k(z) / A: it comes with cos(k·r).
  double wave_potential(const LatticeWave& wave, double z) const;

  /// The part of the mean sheet.
  double sheet_potential(double z) const;

  /// Shifts of the images with |shift| ≤ distance, in a fixed order, m.
  std::vector<Vec3> shifts_within(double distance) const;

private:
  ShearingBox box_;
  double offset_, split_, reach_;
  std::vector<Vec3> near_; // all that may act on a place in the cell
  std::vector<LatticeWave> waves_;
};

} // namespace keeler
