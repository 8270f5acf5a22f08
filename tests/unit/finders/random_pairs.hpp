// Random pairs that are hard for finders, in families: each draws the relative orbit so that something happens close to
// contact inside the step. Steps of 1e-5 to 0.2 orbit, sizes to 1:1000, speeds of 1e-6 to 100 rΩ, κ and ν of Hill's
// frame, of oblate planets and of the thickened disks of the literature; at the origin and anywhere in large boxes.
#pragma once

#include "draws.hpp"

#include <keeler/core/random.hpp>
#include <keeler/core/units.hpp>
#include <keeler/finders/finder.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>

namespace keeler::test {

// Returns the number of pairs of all families to draw: the default, or KEELER_PAIRS of the environment.
inline std::uint64_t pairs_asked_for() {
  const char* text = std::getenv("KEELER_PAIRS");
  return text ? std::strtoull(text, nullptr, 10) : draws(60000);
}

enum class Family { neighbours, hit, grazing, inflexion, tidal, co_orbital, bounced };
inline constexpr int families = 7;
inline constexpr std::array<const char*, families> family_names = {
    "neighbours", "constructed hit", "grazing", "inflexion", "tidal speeds", "co-orbital", "after a bounce"};

struct PairCase {
  std::array<Body, 2> bodies; ///< lower id first
  finders::Query query;       ///< of these two
  Frequencies frequencies;
  double begin = 0.0, end = 0.0; ///< the step
  double size = 0.0;             ///< the largest coordinate
};

class RandomPairs {
public:
  RandomPairs(std::uint64_t seed, Family family)
      : random_(seed, RandomPurpose::position, static_cast<std::uint64_t>(family)), family_(family) {}

  PairCase draw() {
    PairCase c;
    draw_step(c);
    const double unit = power_of_ten(-2.0, 2.0); // the larger radius
    c.bodies[0].radius = unit * power_of_ten(-3.0, 0.0);
    c.bodies[1].radius = unit;
    if (random_.uniform() < 0.5)
      std::swap(c.bodies[0].radius, c.bodies[1].radius);
    for (Body& body : c.bodies)
      body.mass = body.radius * body.radius * body.radius;
    place(c, relative_orbit(c, c.bodies[0].radius + c.bodies[1].radius), unit);
    return c;
  }

  /// Returns the pair after a bounce at a time: restitution 0 to 1, but no slower than the drift phase lets a pair
  /// leave.
  bool bounce(PairCase& c, double time) {
    auto& [a, b] = c.bodies;
    const Rotation r(c.frequencies, time);
    Elements image = b.elements;
    image.guiding_x += c.query.shift_x;
    image.guiding_y += c.query.shift_y;
    const State s = state_at(image - a.elements, c.frequencies, r);
    const Vec3 n = s.position.normalized();
    const double speed = -s.velocity.dot(n);
    const double cut = 1e-2 * 0.5 * (a.radius + b.radius);
    const double after = speed < cut ? std::max(speed, 1e-3 * cut) : std::max(random_.uniform() * speed, 1e-3 * cut);
    if (!(speed > -after))
      return false;
    const Vec3 impulse = a.mass * b.mass / (a.mass + b.mass) * (speed + after) * n;
    kick(a.elements, -impulse / a.mass, c.frequencies, r);
    kick(b.elements, impulse / b.mass, c.frequencies, r);
    c.query.start = time;
    return true;
  }

private:
  double power_of_ten(double least, double most) { return std::pow(10.0, least + (most - least) * random_.uniform()); }
  double centred() { return 2.0 * random_.uniform() - 1.0; }
  double either_sign(double x) { return random_.uniform() < 0.5 ? -x : x; }

  Vec3 direction() {
    const double z = centred(), rho = std::sqrt(1.0 - z * z), angle = two_pi * random_.uniform();
    return {rho * std::cos(angle), rho * std::sin(angle), z};
  }

  Vec3 across(const Vec3& d) {
    const Vec3 v = direction();
    return (v - d * (v.dot(d) / d.squaredNorm())).normalized();
  }

  void draw_step(PairCase& c) {
    const double step = two_pi * power_of_ten(-5.0, std::log10(0.2));
    c.begin = -0.5 * step;
    c.end = 0.5 * step;
    c.query.low = 0;
    c.query.high = 1;
    c.query.start = random_.uniform() < 0.7 ? c.begin : c.begin + step * random_.uniform();
    switch (static_cast<int>(5.0 * random_.uniform())) {
    case 0:
      break;
    case 1:
      c.frequencies = {0.95 + 0.05 * random_.uniform(), 1.0 + 0.05 * random_.uniform()};
      break;
    case 2:
      c.frequencies = {1.0, 3.6};
      break;
    case 3:
      c.frequencies = {1.0, 1.0 + 3.0 * random_.uniform()};
      break;
    default:
      c.frequencies = {0.98647, 1.01335}; // C ring
    }
  }

  Elements relative_orbit(const PairCase& c, double radius_sum) {
    const double span = c.end - c.query.start;
    const double when = c.query.start + span * (1.1 * random_.uniform() - 0.05);
    const double speed = radius_sum * power_of_ten(-6.0, 2.0);
    const double depth = either_sign(power_of_ten(-12.0, -3.0));
    State s;
    switch (family_) {
    case Family::neighbours: {
      s.position = direction() * (radius_sum + 2.0 * span * (speed + radius_sum) * random_.uniform());
      s.velocity = direction() * speed;
      break;
    }
    case Family::grazing:
      s.position = direction() * radius_sum * (1.0 - depth);
      s.velocity = across(s.position) * speed;
      break;
    case Family::inflexion:
      s = inflexion(c.frequencies, radius_sum, depth);
      break;
    case Family::tidal: // close to contact and slow: tides decide
      s.position = direction() * radius_sum * (1.0 - depth);
      s.velocity = direction() * radius_sum * power_of_ten(-6.0, -3.0);
      break;
    case Family::co_orbital:
      return co_orbital(radius_sum, depth);
    default:
      s.position = direction() * radius_sum;
      s.velocity = direction() * speed;
      if (s.velocity.dot(s.position) > 0.0)
        s.velocity = -s.velocity;
    }
    return elements_from(s, c.frequencies, Rotation(c.frequencies, when));
  }

  // At contact within a depth with f′ = 0 and f″ = 2|v|² + 2 d·a = 0, or almost: with v = σw, w across d,
  // a = (2(v_y + S x), −2 v_x, −ν² z) makes that a quadratic in σ.
  State inflexion(const Frequencies& f, double radius_sum, double depth) {
    for (;;) {
      const Vec3 d = direction() * radius_sum * (1.0 - depth), w = across(d);
      const double half = d.x() * w.y() - d.y() * w.x();
      const double rest = 2.0 * f.shear() * d.x() * d.x() - f.nu * f.nu * d.z() * d.z();
      const double discriminant = half * half - rest;
      if (discriminant < 0.0)
        continue;
      const double sigma = -half + either_sign(std::sqrt(discriminant));
      const double off = random_.uniform() < 0.5 ? 0.0 : either_sign(power_of_ten(-12.0, -2.0));
      return {d, sigma * (1.0 + off) * w + off * sigma * random_.uniform() * d / radius_sum};
    }
  }

  // Almost one orbit, a contact's length ahead or behind; sometimes at a constant distance.
  Elements co_orbital(double radius_sum, double depth) {
    Elements el;
    if (random_.uniform() < 0.1) { // |d|² = e²cos² + 4e²sin² + i²sin² is constant for i = √3 e in phase (κ = ν = 1)
      const double angle = two_pi * random_.uniform(), e = 0.5 * radius_sum * (1.0 - depth);
      el.e_cos = e * std::cos(angle);
      el.e_sin = e * std::sin(angle);
      el.i_sin = std::sqrt(3.0) * el.e_cos;
      el.i_cos = -std::sqrt(3.0) * el.e_sin;
      return el;
    }
    const double small = radius_sum * power_of_ten(-9.0, -1.0);
    el = {small * centred() * 1e-2, either_sign(radius_sum * (1.0 - depth)),
          small * centred(),        small * centred(),
          small * centred(),        small * centred()};
    return el;
  }

  // Moves the pair: to the origin, to another orbit, or across the edge of a large box.
  void place(PairCase& c, const Elements& relative, double unit) {
    Elements& lo = c.bodies[0].elements;
    Elements& hi = c.bodies[1].elements;
    const double choice = random_.uniform(), box = choice < 0.7 ? 10.0 * unit : unit * power_of_ten(2.0, 5.0);
    if (choice > 0.3) {
      const double e = unit * power_of_ten(-2.0, 1.0);
      lo = {0.5 * box * centred(), 0.5 * box * centred(), e * centred(), e * centred(), e * centred(), e * centred()};
    }
    if (choice > 0.7) {
      c.query.shift_x = either_sign(box);
      c.query.shift_y = box * centred();
    }
    hi = {lo.guiding_x + relative.guiding_x - c.query.shift_x,
          lo.guiding_y + relative.guiding_y - c.query.shift_y,
          lo.e_cos + relative.e_cos,
          lo.e_sin + relative.e_sin,
          lo.i_sin + relative.i_sin,
          lo.i_cos + relative.i_cos};
    c.size = std::max(box, unit);
    for (const Elements& el : {lo, hi})
      c.size = std::max(
          {c.size, std::fabs(el.guiding_x), std::fabs(el.guiding_y), 2.0 * el.eccentricity(), el.inclination()});
  }

  RandomStream random_;
  Family family_;
};

} // namespace keeler::test
