// The shearing (sliding-brick) box: periodic in x and y, open in z. Image (n_x, n_y) of a particle stands at
// (x + n_x L_x, y + n_y L_y − n_x d) with the shear offset d = S L_x t mod L_y: columns farther out fall behind.
//
// Time is an integer count of half steps, so the offset never accumulates rounding. Particles are wrapped by their
// guiding centre X: its change is ∓L_x exactly, e, φ, i and ζ do not change at all. A particle may therefore stand
// outside the cell by its eccentricity.
#pragma once

#include <keeler/hill/elements.hpp>

#include <cmath>
#include <cstdint>

namespace keeler {

/// Which image of a particle: how many boxes to shift it outward and along the orbit.
struct Image {
  std::int32_t nx = 0;
  std::int32_t ny = 0;
  friend bool operator==(const Image&, const Image&) = default;
};

inline Image operator-(const Image& image) {
  return {-image.nx, -image.ny};
}

/// The size of the patch, its shear, and the shear offset at time zero.
struct ShearingBox {
  double size_x = 0.0;       ///< L_x, m
  double size_y = 0.0;       ///< L_y, m
  double shear = 1.5;        ///< S, in units of Omega
  double first_offset = 0.0; ///< d at time zero, in [0, L_y)

  double area() const { return size_x * size_y; }

  /// Shear offset in [0, L_y) after `half_steps` half steps of length half_step (rad).
  double offset(std::int64_t half_steps, double half_step) const;

  /// Where an image stands relative to the particle itself, at the time of the given offset.
  Vec3 displacement(const Image& image, double offset) const {
    return {image.nx * size_x, image.ny * size_y - image.nx * offset, 0.0};
  }

  /// The elements of an image, at the epoch of the given offset: X and Y shift, nothing else changes.
  Elements image_of(Elements el, const Image& image, double offset) const {
    el.guiding_x += image.nx * size_x;
    el.guiding_y += image.ny * size_y - image.nx * offset;
    return el;
  }

  /// The image whose guiding centre lies in [−L_x/2, L_x/2) × [−L_y/2, L_y/2), at the epoch of the given offset; of a
  /// place more than 2³⁰ boxes away, or not finite, some image outside.
  Image image_into_cell(double x, double y, double offset) const {
    if (std::fabs(x) < 0.499 * size_x && std::fabs(y) < 0.499 * size_y) // almost always, and surely
      return {};
    return far_image_into_cell(x, y, offset);
  }

private:
  Image far_image_into_cell(double x, double y, double offset) const;
};

} // namespace keeler
