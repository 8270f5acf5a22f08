// The invariant of ghost layers, for pairs that touch: if both have stayed within the margin since the layer was built,
// then the reference of one was within near_reach() of the other's.
#include "ghost_layer.hpp"

#include <keeler/core/random.hpp>
#include <keeler/hill/elements.hpp>

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>

using namespace keeler;
using decomposition::GhostLayer, decomposition::Point;

namespace {

constexpr double lifetime = 0.7, step = 0.02; // rad
const Frequencies frequencies{0.986, 1.013};
const ShearingBox ring{60.0, 50.0, frequencies.shear(), 0.0};

double offset_at(double time) {
  const double offset = std::fmod(17.0 + ring.shear * ring.size_x * time, ring.size_y);
  return offset < 0.0 ? offset + ring.size_y : offset;
}

Elements wrapped(const Elements& el, double time) {
  const Image image = ring.image_into_cell(el.guiding_x, el.guiding_y, offset_at(time));
  return ring.image_of(el, image, offset_at(time));
}

GhostLayer layer_of(double margin) {
  GhostLayer layer;
  layer.box = ring;
  layer.has_rows = true;
  layer.kappa = frequencies.kappa;
  layer.margin = margin;
  layer.epoch = {0.0, offset_at(0.0), step};
  return layer;
}

// Returns the least distance of two references through any image, in units of `reach`.
double distance(const Point& a, const Point& b, const Point& reach, double offset) {
  double least = HUGE_VAL;
  for (int nx = -2; nx <= 2; ++nx)
    for (int ny = -8; ny <= 8; ++ny)
      least = std::min(least, std::max(std::fabs(a.x + nx * ring.size_x - b.x) / reach.x,
                                       std::fabs(a.y + ny * ring.size_y - nx * offset - b.y) / reach.y));
  return least;
}

} // namespace

TEST_CASE("particles that touch have references within reach of each other") {
  constexpr double radius = 0.1;
  const hill::Rebase back(frequencies, -step), next(frequencies, step);
  std::size_t stayed = 0, strayed = 0;
  double farthest = 0.0;
  for (std::uint64_t pair = 0; pair < 100000; ++pair) {
    RandomStream random(4, RandomPurpose::position, pair);
    const auto between = [&](double low, double high) { return low + (high - low) * random.uniform(); };
    GhostLayer layer = layer_of(between(0.5, 1.5));
    const int steps = static_cast<int>(between(0.0, (lifetime - 0.5 * step) / step));
    const double angle = between(0.0, 6.2831853), x = between(-30.0, 30.0), y = between(-25.0, 25.0);
    Elements bodies[2];
    Point references[2];
    for (int k = 0; k < 2; ++k) { // they touch at the last epoch; back from there
      Elements& el = bodies[k];
      el = {0.0, 0.0, between(-3.0, 3.0), between(-3.0, 3.0), 0.0, 0.0};
      const Point from_guiding_centre = layer.position(el);
      el.guiding_x = x + k * 2.0 * radius * std::cos(angle) - from_guiding_centre.x;
      el.guiding_y = y + k * 2.0 * radius * std::sin(angle) - from_guiding_centre.y;
      for (int n = steps; n > 0; --n) {
        el = wrapped(el, n * step);
        back(el);
      }
      el = wrapped(el, 0.0);
      references[k] = layer.position(el);
    }
    bool stays = true;
    for (int n = 0; stays && n <= steps; ++n) {
      layer.epoch = {n * step, offset_at(n * step), step};
      for (int k = 0; k < 2; ++k) {
        stays = stays && layer.excursion(references[k], bodies[k]) <= layer.margin;
        next(bodies[k]);
        bodies[k] = wrapped(bodies[k], (n + 1) * step);
      }
    }
    (stays ? stayed : strayed) += 1;
    if (!stays)
      continue;
    farthest =
        std::max(farthest, distance(references[0], references[1], layer.near_reach(radius, lifetime), offset_at(0.0)));
  }
  CHECK(stayed > 10000);
  CHECK(strayed > 10000);
  CHECK(farthest > 0.9);
  CHECK(farthest <= 1.0);
}

// Contacts may lead a particle to any place within its margin.
TEST_CASE("positions within the margins that touch have references within reach, which must allow for shear") {
  constexpr double radius = 0.1;
  double farthest = 0.0, without_shear = 0.0;
  for (std::uint64_t pair = 0; pair < 50000; ++pair) {
    RandomStream random(5, RandomPurpose::position, pair);
    const auto between = [&](double low, double high) { return low + (high - low) * random.uniform(); };
    GhostLayer layer = layer_of(between(0.5, 1.5));
    const double time = between(0.0, lifetime), angle = between(0.0, 6.2831853), m = layer.margin;
    layer.epoch = {time, offset_at(time), 0.0};
    const Point middle{between(-30.0, 30.0), between(-25.0, 25.0)};
    Point references[2];
    for (int k = 0; k < 2; ++k) {
      const Point at{middle.x + k * 2.0 * radius * std::cos(angle), middle.y + k * 2.0 * radius * std::sin(angle)};
      const Point then{at.x + between(-m, m), at.y + between(-2.0 * m, 2.0 * m)};
      const Elements before = wrapped({then.x, then.y + ring.shear * then.x * time, 0.0, 0.0, 0.0, 0.0}, 0.0);
      references[k] = layer.position(before);
      REQUIRE(layer.excursion(references[k], wrapped({at.x, at.y, 0.0, 0.0, 0.0, 0.0}, time)) <= m * (1.0 + 1e-9));
    }
    farthest =
        std::max(farthest, distance(references[0], references[1], layer.near_reach(radius, lifetime), offset_at(0.0)));
    without_shear =
        std::max(without_shear, distance(references[0], references[1], layer.near_reach(radius, 0.0), offset_at(0.0)));
  }
  CHECK(farthest > 0.9);
  CHECK(farthest <= 1.0);
  CHECK(without_shear > 1.1);
}

TEST_CASE("a particle on a circle stays within a small margin anywhere in the box, and across its edges") {
  const hill::Rebase next(frequencies, step);
  for (const double x : {-29.9, -20.0, 0.0, 7.0, 29.9})
    for (const double y : {-24.9, 0.0, 24.9}) {
      GhostLayer layer = layer_of(1e-9);
      Elements el{x, y, 0.0, 0.0, 0.0, 0.0};
      const Point reference = layer.position(el);
      for (int n = 0; n * step < lifetime; ++n) {
        layer.epoch = {n * step, offset_at(n * step), step};
        CHECK(layer.excursion(reference, el) <= layer.margin);
        const Elements outward = ring.image_of(el, {1, 0}, layer.epoch.offset);
        CHECK(layer.excursion(reference, outward) <= layer.margin);
        next(el);
        el = wrapped(el, (n + 1) * step);
      }
    }
}
