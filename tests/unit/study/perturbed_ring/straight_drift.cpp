#include "perturbed_ring/straight_drift.hpp"

#include <keeler/core/units.hpp>
#include <keeler/initial_conditions/uniform.hpp>

#include <doctest/doctest.h>

#include <cstring>

namespace straight_drift_test {

using namespace keeler;
using namespace keeler::study;

namespace {

constexpr Frequencies f{1.0, 1.0};
constexpr double omega = 1.95e-4;

collision::CollisionSettings half_elastic() {
  collision::CollisionSettings settings;
  settings.restitution = collision::constant_restitution(0.5);
  return settings;
}

// Brute-force twin: searches every pair and image again after every event.
class Twin {
public:
  Twin(std::vector<Body>& bodies, const ShearingBox& box, double offset, double step)
      : bodies_(bodies), box_(box), offset_(offset), step_(step) {
    for (const Body& body : bodies_) {
      const State s = state_at(body.elements, f, Rotation(f, -0.5 * step));
      legs_.push_back({s.position, s.velocity, -0.5 * step});
    }
  }

  int collide() {
    int count = 0;
    for (Contact last{-step_, 0, 0, {}};;) {
      const Contact next = first_after(last);
      if (next.time >= 0.5 * step_)
        return count;
      count += bounce(next);
      last = next;
    }
  }

private:
  struct Leg {
    Vec3 position, velocity;
    double since;
  };
  struct Contact {
    double time;
    std::size_t i, j;
    Image image;
  };

  State relative(std::size_t i, std::size_t j, const Image& image, double time) const {
    const Leg &a = legs_[i], &b = legs_[j];
    const double slide = image.nx * box_.shear * box_.size_x;
    Vec3 d = b.position + (time - b.since) * b.velocity - a.position - (time - a.since) * a.velocity;
    d += Vec3(image.nx * box_.size_x, image.ny * box_.size_y - image.nx * offset_ - slide * time, 0.0);
    return {d, b.velocity - a.velocity - Vec3(0.0, slide, 0.0)};
  }

  Contact first_after(const Contact& last) const {
    Contact first{HUGE_VAL, 0, 0, {}};
    for (std::size_t i = 0; i < bodies_.size(); ++i)
      for (std::size_t j = i + 1; j < bodies_.size(); ++j)
        for (std::int32_t nx = -1; nx <= 1; ++nx)
          for (std::int32_t ny = -2; ny <= 2; ++ny) {
            const double start = std::max(legs_[i].since, legs_[j].since);
            const State s = relative(i, j, {nx, ny}, start);
            const double a = s.velocity.squaredNorm(), b = 2.0 * s.position.dot(s.velocity);
            const double reach = bodies_[i].radius + bodies_[j].radius, c = s.position.squaredNorm() - reach * reach;
            if (b >= 0.0 || b * b < 4.0 * a * c)
              continue;
            const double time = c <= 0.0 ? start : start + (-b - std::sqrt(b * b - 4.0 * a * c)) / (2.0 * a);
            if (time < first.time && std::tuple(time, i, j) > std::tuple(last.time, last.i, last.j))
              first = {time, i, j, {nx, ny}};
          }
    return first;
  }

  // Returns false when the lines approach but the particles, with the velocities of their epicycles, do not.
  bool bounce(const Contact& c) {
    const Rotation rotation(f, c.time);
    const Vec3 normal = relative(c.i, c.j, c.image, c.time).position.normalized();
    const Vec3 slide(0.0, c.image.nx * box_.shear * box_.size_x, 0.0);
    State states[2];
    for (const std::size_t k : {c.i, c.j})
      states[k == c.j] = {legs_[k].position + (c.time - legs_[k].since) * legs_[k].velocity,
                          state_at(bodies_[k].elements, f, rotation).velocity};
    const double speed = -(states[1].velocity - slide - states[0].velocity).dot(normal);
    const collision::Rebound after = rebound(half_elastic(), speed, bodies_[c.i].radius, bodies_[c.j].radius, omega);
    if (speed <= -after.speed)
      return false;
    states[0].velocity -= 0.5 * (speed + after.speed) * normal;
    states[1].velocity += 0.5 * (speed + after.speed) * normal;
    for (const std::size_t k : {c.i, c.j}) {
      bodies_[k].elements = elements_from(states[k == c.j], f, rotation);
      legs_[k] = {states[k == c.j].position, states[k == c.j].velocity, c.time};
    }
    return true;
  }

  std::vector<Body>& bodies_;
  ShearingBox box_;
  double offset_, step_;
  std::vector<Leg> legs_;
};

} // namespace

TEST_CASE("two particles move straight to the contact, and continue from there with velocities of the epicycle") {
  // 4 m apart they close at 8 m/rad on their tangents at −h/2: contact after t = 1/4 rad, by hand
  constexpr double h = 0.6;
  const Rotation start(f, -0.5 * h), contact(f, -0.5 * h + 0.25);
  Particles particles;
  particles.bodies = {{elements_from({{10.0, 0.0, 1.0}, {4.0, -15.0, 0.5}}, f, start), 1.0, 1.0},
                      {elements_from({{14.0, 0.0, 1.0}, {-4.0, -15.0, 0.5}}, f, start), 1.0, 1.0}};
  particles.ids = {0, 1};
  const Particles before = particles;
  StraightDrift drift(half_elastic(), f, omega, h);
  REQUIRE(drift.collide(particles, {1000.0, 1000.0, 1.5, 0.0}, 0.0) == 1);
  double displaced = 0.0, drifted = 0.0;
  Vec3 momentum = Vec3::Zero();
  for (std::size_t k = 0; k < 2; ++k) {
    const State now = state_at(particles.bodies[k].elements, f, contact);
    const State exact = state_at(before.bodies[k].elements, f, contact);
    CHECK((now.position - Vec3(k ? 13.0 : 11.0, -15.0 * 0.25, 1.125)).norm() < 1e-13); // x0 + v0 t, some units of 1e-15
    displaced += now.position.x() - exact.position.x();
    drifted += particles.bodies[k].elements.guiding_x - before.bodies[k].elements.guiding_x;
    momentum += now.velocity - exact.velocity;
  }
  CHECK(momentum.norm() < 1e-13);
  CHECK(drifted == doctest::Approx(4.0 * displaced).epsilon(1e-12)); // X = 4x + 2ẏ: no impulse is left over
  CHECK(std::fabs(drifted) > 0.01);
}

TEST_CASE("a particle without contacts stays on its epicycle, to the bit") {
  Particles particles;
  particles.bodies = {{{1.0, 2.0, 3.0, 4.0, 5.0, 6.0}, 1.0, 1.0}, {{40.0, 2.0, 1.0, 4.0, 5.0, 6.0}, 1.0, 1.0}};
  particles.ids = {0, 1};
  const Particles before = particles;
  StraightDrift drift(half_elastic(), f, omega, 0.06);
  CHECK(drift.collide(particles, {100.0, 100.0, 1.5, 0.0}, 0.0) == 0);
  CHECK(std::memcmp(particles.bodies.data(), before.bodies.data(), 2 * sizeof(Body)) == 0);
}

TEST_CASE("the drift equals a search of every pair and image after every event") {
  int collisions = 0;
  for (const double step : {two_pi * 1e-3, two_pi * 1e-2, two_pi * 3e-2})
    for (std::uint64_t seed = 1; seed <= 6; ++seed) {
      initial_conditions::UniformRequest request;
      request.radii.assign(50, 1.0);
      request.box = {20.0, 16.0, f.shear(), 0.41 * 16.0 * static_cast<double>(seed % 3)};
      request.dispersion_x = 4.0;
      request.dispersion_z = 2.6;
      request.seed = seed;
      Particles particles = particles_from(uniform_patch(request), 0.5 * step);
      std::vector<Body> expected = particles.bodies;
      const double offset = request.box.offset(1, 0.5 * step);
      const int count = Twin(expected, request.box, offset, step).collide();
      StraightDrift drift(half_elastic(), f, omega, step);
      REQUIRE(drift.collide(particles, request.box, offset) == static_cast<std::uint64_t>(count));
      collisions += count;
      double apart = 0.0;
      for (std::size_t k = 0; k < expected.size(); ++k) {
        const Elements d = particles.bodies[k].elements - expected[k].elements;
        apart = std::max({apart, std::fabs(d.guiding_x), std::fabs(d.guiding_y), d.eccentricity(), d.inclination()});
      }
      CHECK(apart < 1e-9); // roundings of contact times, which each further collision magnifies
    }
  CHECK(collisions > 100);
}

} // namespace straight_drift_test
