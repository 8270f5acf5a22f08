// One contact of rough spheres against the laws of mechanics, and many against kinetic theory.
#include <keeler/collision/friction.hpp>

#include <keeler/core/random.hpp>

#include <Eigen/Geometry>
#include <doctest/doctest.h>

#include <cmath>

namespace friction_test {

using namespace keeler;
using namespace keeler::collision;

namespace {

const Vec3 frame(0.0, 0.0, 1.0);

class Draw {
public:
  explicit Draw(std::uint64_t seed) : random_(seed, RandomPurpose::velocity, 0) {}
  double uniform(double low, double high) { return low + (high - low) * random_.uniform(); }
  double normal() {
    const double u = random_.uniform(), v = random_.uniform();
    return std::sqrt(-2.0 * std::log(1.0 - u)) * std::cos(2.0 * 3.14159265358979323846 * v);
  }
  Vec3 normals() {
    const double x = normal(), y = normal(), z = normal();
    return {x, y, z};
  }

private:
  RandomStream random_;
};

// Two spheres before and after a contact, in the rotating frame, a at the origin.
struct SpherePair {
  Body a, b;
  Vec3 normal, velocity_a, velocity_b, spin_a, spin_b;

  Touch touch() const { return {a, b, normal, velocity_b - velocity_a, spin_a, spin_b}; }
  Vec3 slip() const {
    const Vec3 at_a = velocity_a + (spin_a - frame).cross(a.radius * normal);
    const Vec3 at_b = velocity_b + (spin_b - frame).cross(-b.radius * normal);
    const Vec3 u = at_b - at_a;
    return u - u.dot(normal) * normal;
  }
  double inertia(const Body& body) const { return 0.4 * body.mass * body.radius * body.radius; }
  double energy() const {
    return 0.5 * (a.mass * velocity_a.squaredNorm() + b.mass * velocity_b.squaredNorm() +
                  inertia(a) * (spin_a - frame).squaredNorm() + inertia(b) * (spin_b - frame).squaredNorm());
  }
  // Returns the angular momentum about the point of contact.
  Vec3 angular_momentum() const {
    return (-a.radius * normal).cross(a.mass * velocity_a) + (b.radius * normal).cross(b.mass * velocity_b) +
           inertia(a) * spin_a + inertia(b) * spin_b;
  }
  Vec3 momentum() const { return a.mass * velocity_a + b.mass * velocity_b; }

  void apply(const Vec3& impulse, bool along_surfaces) {
    velocity_a -= impulse / a.mass;
    velocity_b += impulse / b.mass;
    if (!along_surfaces)
      return;
    spin_a += spin_change(a, normal, impulse);
    spin_b += spin_change(b, normal, impulse);
  }
};

SpherePair random_pair(Draw& draw) {
  SpherePair pair;
  pair.a.radius = draw.uniform(0.1, 3.0);
  pair.b.radius = draw.uniform(0.1, 3.0);
  pair.a.mass = draw.uniform(0.1, 10.0);
  pair.b.mass = draw.uniform(0.1, 10.0);
  pair.normal = draw.normals().normalized();
  pair.velocity_a = draw.normals();
  pair.velocity_b = draw.normals();
  pair.spin_a = draw.normals();
  pair.spin_b = draw.normals();
  return pair;
}

} // namespace

TEST_CASE("a rough contact: the slip becomes eps_t of it; momenta stay and the loss is what is gone, to rounding") {
  Draw draw(1);
  for (int k = 0; k < 1000; ++k) {
    const double restitution = draw.uniform(-1.0, 1.0);
    SpherePair pair = random_pair(draw);
    const SpherePair before = pair;
    const Sliding sliding = slide({.tangential_restitution = restitution}, pair.touch(), 1.0);
    pair.apply(sliding.impulse, true);
    CHECK((pair.slip() - restitution * before.slip()).norm() < 1e-13 * (1.0 + before.slip().norm()));
    CHECK((pair.angular_momentum() - before.angular_momentum()).norm() < 1e-13 * (1.0 + before.energy()));
    CHECK((pair.momentum() - before.momentum()).norm() < 1e-13 * (1.0 + before.energy()));
    CHECK(std::fabs(before.energy() - pair.energy() - sliding.energy_lost) < 1e-13 * (1.0 + before.energy()));
    CHECK(sliding.energy_lost >= 0.0);
    CHECK(std::fabs(sliding.impulse.dot(pair.normal)) < 1e-13 * (1.0 + sliding.impulse.norm()));
  }
}

TEST_CASE("Coulomb's law holds the impulse back, and the loss with it") {
  Draw draw(2);
  int sliding_pairs = 0;
  for (int k = 0; k < 1000; ++k) {
    SpherePair pair = random_pair(draw);
    const SpherePair before = pair;
    const Friction rough{.tangential_restitution = 0.0}, limited{.tangential_restitution = 0.0, .coefficient = 0.3};
    const double normal_impulse = draw.uniform(0.1, 3.0);
    const Sliding free = slide(rough, pair.touch(), normal_impulse),
                  held = slide(limited, pair.touch(), normal_impulse);
    CHECK(held.impulse.norm() == doctest::Approx(std::min(free.impulse.norm(), 0.3 * normal_impulse)).epsilon(1e-12));
    sliding_pairs += held.impulse.norm() < 0.999 * free.impulse.norm();
    pair.apply(held.impulse, true);
    CHECK(pair.slip().dot(before.slip()) >= -1e-12);
    CHECK(std::fabs(before.energy() - pair.energy() - held.energy_lost) < 1e-13 * (1.0 + before.energy()));
  }
  CHECK(sliding_pairs > 100);
  CHECK(sliding_pairs < 900);
}

TEST_CASE("spheres that roll on each other in the rotating frame do not rub") {
  SpherePair pair;
  pair.a = {{}, 1.0, 2.0};
  pair.b = {{}, 0.5, 3.0};
  pair.normal = Vec3(0.6, 0.8, 0.0);
  pair.spin_a = pair.spin_b = frame; // no spin in Hill's frame
  pair.velocity_a = pair.velocity_b = Vec3::Zero();
  CHECK(slide({.tangential_restitution = 0.0}, pair.touch(), 1.0).impulse == Vec3::Zero());
  pair.spin_a += Vec3(0.0, 0.0, 1.0); // as two gear wheels
  pair.spin_b -= Vec3(0.0, 0.0, 2.0);
  CHECK(slide({.tangential_restitution = 0.0}, pair.touch(), 1.0).impulse.norm() < 1e-15);
}

// In a gas of equal spheres with Maxwellian velocities and spins, spins neither gain nor lose in contacts at
// E_rot/E_kin = 2(1 − ε_t)/(14 − 5(1 − ε_t)) (Morishima & Salo 2004, a thin ring). Contacts come in proportion to the
// normal speed. The standard error of the mean over 4·10⁵ pairs is 0.3 to 0.5 % of what one contact exchanges.
TEST_CASE("spins of a thin rough ring: E_rot/E_kin = 2(1 - eps_t)/(14 - 5(1 - eps_t))") {
  for (const double restitution : {0.9, 0.5, 0.0}) {
    Draw draw(3);
    const double rough = 1.0 - restitution, ratio = 2.0 * rough / (14.0 - 5.0 * rough);
    const double spin = std::sqrt(ratio / 0.4); // per axis, for velocities of 1 and r = 1
    const auto gain = [&](double spins) {
      double sum = 0.0, weights = 0.0, exchanged = 0.0;
      for (int k = 0; k < 400000; ++k) {
        SpherePair pair;
        pair.a = pair.b = {{}, 1.0, 1.0};
        pair.normal = Vec3::UnitX();
        pair.velocity_a = draw.normals();
        pair.velocity_b = draw.normals();
        pair.spin_a = frame + spins * draw.normals();
        pair.spin_b = frame + spins * draw.normals();
        const double speed = (pair.velocity_a - pair.velocity_b).x();
        if (speed <= 0.0)
          continue;
        const auto energy = [&] { return (pair.spin_a - frame).squaredNorm() + (pair.spin_b - frame).squaredNorm(); };
        const double before = energy();
        pair.apply(slide({.tangential_restitution = restitution}, pair.touch(), speed).impulse, true);
        sum += speed * (energy() - before);
        exchanged += speed * std::fabs(energy() - before);
        weights += speed;
      }
      CHECK(weights > 0.0);
      return sum / exchanged;
    };
    CAPTURE(restitution);
    CHECK(std::fabs(gain(spin)) < 0.012);
    CHECK(gain(0.9 * spin) > 0.02); // spins too slow gain, too fast ones lose
    CHECK(gain(1.1 * spin) < -0.02);
  }
}

} // namespace friction_test
