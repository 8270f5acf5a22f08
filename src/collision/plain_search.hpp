// Whoever may touch a particle within the step at hand: among all others and through all images, without lists, cells
// or single precision. It is what these are held against.
#pragma once

#include <keeler/finders/straight_line.hpp>
#include <keeler/hill/shearing_box.hpp>
#include <keeler/particles/store.hpp>

#include <algorithm>
#include <cmath>
#include <vector>

namespace keeler {

struct PlainPartner {
  std::uint32_t place = 0;
  Image image;
  friend bool operator==(const PlainPartner&, const PlainPartner&) = default;
};

/// No image of the other comes near, since its guiding centre is too far out or in. Nearly all are ruled out by this
/// before anything that costs more.
inline bool too_far_out(const Body& body, const Body& other, double allowance, double size_x) {
  const auto bound = [](const Elements& el) { return std::fabs(el.e_cos) + std::fabs(el.e_sin); }; // of e
  const double x = std::fabs(other.elements.guiding_x - body.elements.guiding_x);
  return x < size_x && std::min(x, size_x - x) >
                           body.radius + other.radius + allowance + bound(body.elements) + bound(other.elements);
}

/// The partners of the particle at that place, by the straight lines of the step. `start` gives the time (rad after the
/// epoch) from which on a place has its present orbit; `offset` is the box's at the epoch.
template<class Start>
std::vector<PlainPartner> plain_search(const Particles& particles, const ShearingBox& box, double offset,
                                       const StraightLineTest& test, std::uint32_t place, const Start& start) {
  std::vector<PlainPartner> partners;
  const Frequencies& f = test.frequencies;
  const Body& body = particles.bodies[place];
  for (std::uint32_t j = 0; j < particles.size(); ++j) {
    if (j == place)
      continue;
    const Body& other = particles.bodies[j];
    if (too_far_out(body, other, test.allowance, box.size_x))
      continue;
    // x − X is never more than e, y − Y + S X t never more than 2e/κ
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
        if (test.may_touch(body, other, shift.x(), shift.y(), std::max(start(place), start(j))))
          partners.push_back({j, {nx, ny}});
      }
    }
  }
  return partners;
}

} // namespace keeler
