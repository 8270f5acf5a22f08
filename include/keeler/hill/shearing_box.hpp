// The shearing (sliding-brick) box: periodic in x and y, open in z. Image (n_x, n_y) of a particle is at
// (x + n_x L_x, y + n_y L_y − n_x d) with the shear offset d = S L_x t mod L_y: columns farther out fall behind.
//
// Time is an integer number of half steps, so the offset does not accumulate rounding. Particles are wrapped by their
// guiding centre: X changes by exactly ∓L_x, and e, φ, i and ζ do not change. A particle may therefore lie outside the
// cell by its eccentricity.
#pragma once

#include <keeler/hill/elements.hpp>

#include <cmath>
#include <cstdint>

namespace keeler::hill {

/// An image of a particle: the shift in boxes, outward and along the orbit.
struct Image {
  std::int32_t nx = 0;                                          ///< boxes outward
  std::int32_t ny = 0;                                          ///< boxes along the orbit
  friend bool operator==(const Image&, const Image&) = default; ///< equal shifts
};

/// Returns the opposite shift.
inline Image operator-(const Image& image) {
  return {-image.nx, -image.ny};
}

/// Size of the patch, shear rate, and shear offset at time zero.
struct ShearingBox {
  double size_x = 0.0;       ///< L_x, m
  double size_y = 0.0;       ///< L_y, m
  double shear = 1.5;        ///< S, in units of Omega
  double first_offset = 0.0; ///< d at time zero, in [0, L_y)

  double area() const { return size_x * size_y; } ///< m²

  /// Returns the shear offset in [0, L_y) after `half_steps` half steps of length half_step (rad).
  double offset(std::int64_t half_steps, double half_step) const;

  /// Returns the displacement of an image from the particle, m, at the time of the given offset.
  Vec3 displacement(const Image& image, double offset) const {
    return {image.nx * size_x, image.ny * size_y - image.nx * offset, 0.0};
  }

  /// Returns the elements of an image: X and Y are shifted. Precondition: the offset is that of their epoch.
  Elements image_of(Elements el, const Image& image, double offset) const {
    el.guiding_x += image.nx * size_x;
    el.guiding_y += image.ny * size_y - image.nx * offset;
    return el;
  }

  /// Returns the image in the cell [−L_x/2, L_x/2) × [−L_y/2, L_y/2) of a guiding centre (x, y), at the epoch of the
  /// given offset. A coordinate more than 2³⁰ boxes away, or not finite, gives an image outside the cell.
  Image image_into_cell(double x, double y, double offset) const {
    if (std::fabs(x) < 0.499 * size_x && std::fabs(y) < 0.499 * size_y) // the usual case, safe from rounding
      return {};
    return far_image_into_cell(x, y, offset);
  }

private:
  Image far_image_into_cell(double x, double y, double offset) const;
};

} // namespace keeler::hill

namespace keeler {
using hill::Image, hill::ShearingBox;
} // namespace keeler
