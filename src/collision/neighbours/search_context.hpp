// The step in which partners are searched: particles, box and times. It is made when the step begins, and ends with it.
#pragma once

#include <keeler/finders/straight_line.hpp>
#include <keeler/hill/shearing_box.hpp>
#include <keeler/particles/store.hpp>

#include <cmath>

namespace keeler::collision {

/// A time after the epoch (rad) and the shear offset of that time (m).
struct Instant {
  double after = 0.0, offset = 0.0;
};

/// Precondition: the particles outlive the context.
struct SearchContext {
  SearchContext(const Particles& all, const Frequencies& f, const ShearingBox& periodic, double shear_offset,
                double length)
      : particles(all), frequencies(f), box(periodic), offset(shear_offset),
        step(length), test{f, 0.5 * length, 0.5 * length, 1e-13 * (periodic.size_x + periodic.size_y)} {}

  const Particles& particles;
  Frequencies frequencies;
  ShearingBox box;
  double offset;                  ///< shear offset at the epoch, the middle of the step, m
  double step;                    ///< length of the step, rad
  finders::StraightLineTest test; ///< in double precision, for this step

  Instant instant(double after) const {
    return {after, std::fmod(offset + box.shear * box.size_x * after, box.size_y)};
  }

  /// Returns the image of b that is nearest to a at the epoch.
  Image nearest_image(const Body& a, const Body& b) const {
    const Elements el = b.elements - a.elements;
    const double x = el.guiding_x - el.e_cos, y = el.guiding_y + (2.0 / frequencies.kappa) * el.e_sin;
    if (std::fabs(x) < 0.5 * box.size_x && std::fabs(y) < 0.5 * box.size_y)
      return {};
    return box.image_into_cell(x, y, offset);
  }

  /// False only if particle i cannot touch that image of particle j from `start` (rad after the epoch) on.
  bool may_touch(std::size_t i, std::size_t j, const Image& image, double start) const {
    const Vec3 shift = box.displacement(image, offset);
    return test.may_touch(particles.bodies[i], particles.bodies[j], shift.x(), shift.y(), start);
  }
};

} // namespace keeler::collision
