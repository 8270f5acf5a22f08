// The plain search for the partners of a particle within a step: all other particles through all images, without lists,
// cells or single precision. Audits and tests compare the fast searches with it.
#pragma once

#include <keeler/finders/straight_line.hpp>
#include <keeler/hill/shearing_box.hpp>
#include <keeler/particles/store.hpp>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <vector>

namespace keeler::collision {

struct PlainPartner {
  std::uint32_t index = 0; ///< in the store
  Image image;
  friend bool operator==(const PlainPartner&, const PlainPartner&) = default;
};

/// True if no image of `other` comes near because its guiding centre is too far out or in. This cheap test rejects
/// nearly all particles. `allowance` (m) is added to the contact distance.
inline bool too_far_out(const Body& body, const Body& other, double allowance, double size_x) {
  const auto bound = [](const Elements& el) { return std::fabs(el.e_cos) + std::fabs(el.e_sin); }; // of e
  const double x = std::fabs(other.elements.guiding_x - body.elements.guiding_x);
  return x < size_x && std::min(x, size_x - x) >
                           body.radius + other.radius + allowance + bound(body.elements) + bound(other.elements);
}

/// Returns the partners of particle i by the straight lines of the step. start(k) is the time (rad after the epoch) at
/// which particle k got its present orbit; `offset` is the shear offset at the epoch.
template<class Start>
std::vector<PlainPartner> plain_search(const Particles& particles, const ShearingBox& box, double offset,
                                       const finders::StraightLineTest& test, std::uint32_t i, const Start& start) {
  assert(i < particles.size() && box.size_x > 0.0 && box.size_y > 0.0);
  std::vector<PlainPartner> partners;
  const Frequencies& f = test.frequencies;
  const Body& body = particles.bodies[i];
  for (std::uint32_t j = 0; j < particles.size(); ++j) {
    if (j == i)
      continue;
    const Body& other = particles.bodies[j];
    if (too_far_out(body, other, test.allowance, box.size_x))
      continue;
    // |x − X| <= e and |y − Y + S X t| <= 2e/κ
    const double e = body.elements.eccentricity() + other.elements.eccentricity();
    const double contact = body.radius + other.radius + test.allowance;
    const double x = other.elements.guiding_x - body.elements.guiding_x, reach_x = contact + e;
    const double y = other.elements.guiding_y - body.elements.guiding_y;
    const auto first_x = static_cast<std::int32_t>(std::ceil((-x - reach_x) / box.size_x)),
               last_x = static_cast<std::int32_t>(std::floor((-x + reach_x) / box.size_x));
    for (std::int32_t nx = first_x; nx <= last_x; ++nx) {
      const double there = y - nx * offset;
      const double reach_y = contact + 2.0 / f.kappa * e + f.shear() * std::fabs(x + nx * box.size_x) * test.longest;
      const auto first_y = static_cast<std::int32_t>(std::ceil((-there - reach_y) / box.size_y)),
                 last_y = static_cast<std::int32_t>(std::floor((-there + reach_y) / box.size_y));
      for (std::int32_t ny = first_y; ny <= last_y; ++ny) {
        const Vec3 shift = box.displacement({nx, ny}, offset);
        if (test.may_touch(body, other, shift.x(), shift.y(), std::max(start(i), start(j))))
          partners.push_back({j, {nx, ny}});
      }
    }
  }
  return partners;
}

} // namespace keeler::collision
