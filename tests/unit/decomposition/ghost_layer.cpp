// The invariant of ghost layers, for pairs that move: if both stay within the margin and touch, then the reference of
// one was within near_reach() of the other's.
#include "ghost_layer.hpp"

#include <keeler/core/random.hpp>
#include <keeler/hill/elements.hpp>

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>

using namespace keeler;
using decomposition::GhostLayer, decomposition::Point;

namespace {

// Returns the least scaled distance of two references through any image: at most 1 if one is within `reach` of the
// other.
double distance(const Point& a, const Point& b, const Point& reach, const ShearingBox& box, double offset) {
  double least = HUGE_VAL;
  for (int nx = -2; nx <= 2; ++nx)
    for (int ny = -8; ny <= 8; ++ny)
      least = std::min(least, std::max(std::fabs(a.x + nx * box.size_x - b.x) / reach.x,
                                       std::fabs(a.y + ny * box.size_y - nx * offset - b.y) / reach.y));
  return least;
}

} // namespace

TEST_CASE("particles that touch have references within reach of each other") {
  const double radius = 1.0, lifetime = 0.7, step = 0.02;
  const Frequencies frequencies{0.986, 1.013};
  ShearingBox box{60.0, 50.0, frequencies.shear(), 0.0};
  std::size_t touched = 0, tight = 0, strayed = 0;
  for (std::uint64_t pair = 0; pair < 20000; ++pair) {
    RandomStream random(4, RandomPurpose::position, pair);
    const auto between = [&](double low, double high) { return low + (high - low) * random.uniform(); };
    GhostLayer layer;
    layer.box = box;
    layer.has_rows = true;
    layer.kappa = frequencies.kappa;
    layer.margin = between(0.5, 3.0);
    const double first_offset = between(0.0, box.size_y);
    layer.built_at = 0.0;
    const Point reach = layer.near_reach(radius, lifetime);
    Elements bodies[2];
    Point references[2];
    const double x = between(-30.0, 30.0), y = between(-25.0, 25.0);
    for (int k = 0; k < 2; ++k) {
      Elements& el = bodies[k];
      el = {x + between(-12.0, 12.0), y + between(-25.0, 25.0), between(-2.0, 2.0), between(-2.0, 2.0), 0.0, 0.0};
      layer.epoch = {0.0, first_offset, step};
      const Image image = box.image_into_cell(el.guiding_x, el.guiding_y, first_offset);
      el = box.image_of(el, image, first_offset);
      references[k] = layer.position(el);
    }
    const double separation = distance(references[0], references[1], reach, box, first_offset);
    bool stays = true;
    const hill::Rebase next(frequencies, step);
    for (double time = 0.0; stays && time + 0.5 * step <= lifetime; time += step) {
      const double offset = std::fmod(first_offset + box.shear * box.size_x * time, box.size_y);
      layer.epoch = {time, offset, step};
      for (int k = 0; k < 2; ++k)
        stays = stays && layer.excursion(references[k], bodies[k]) <= layer.margin;
      strayed += !stays;
      for (const double part : {-0.5, -0.25, 0.0, 0.25, 0.5}) {
        const Rotation rotation(frequencies, part * step);
        const double then = offset + box.shear * box.size_x * part * step;
        const Vec3 a = state_at(bodies[0], frequencies, rotation).position,
                   b = state_at(bodies[1], frequencies, rotation).position;
        const bool touch = distance({a.x(), a.y()}, {b.x(), b.y()}, {2.0 * radius, 2.0 * radius}, box, then) <= 1.0;
        if (stays && touch) {
          ++touched;
          tight += separation > 0.5;
          REQUIRE(separation <= 1.0);
        }
      }
      for (int k = 0; k < 2; ++k) { // as a run does
        next(bodies[k]);
        const double later = std::fmod(first_offset + box.shear * box.size_x * (time + step), box.size_y);
        const Image image = box.image_into_cell(bodies[k].guiding_x, bodies[k].guiding_y, later);
        bodies[k] = box.image_of(bodies[k], image, later);
      }
    }
  }
  CHECK(touched > 1000);
  CHECK(tight > 50);
  CHECK(strayed > 1000);
}
