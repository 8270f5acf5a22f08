#include "separation.hpp"

#include "sphere_neighbours.hpp"

#include <keeler/core/parallel.hpp>

#include <algorithm>
#include <atomic>
#include <cassert>
#include <cmath>
#include <limits>
#include <tuple>

namespace keeler::initial_conditions {
namespace {

// In units of the smaller radius of a pair: the target gap of a push, and the gap that is sufficient at the end.
constexpr double clearance = 2e-3, enough = 2e-5;
constexpr double strength = 0.5;      // of a push, in units of the missing distance
constexpr double kept_momentum = 0.7; // fraction of a move that is kept in the next
constexpr double first_tether = 0.3, tether_decay = 0.95, last_tether = 1e-4;
constexpr double skin = 0.3;       // displacement in radii before the lists are rebuilt
constexpr int sweeps_per_list = 8; // at least: a few spheres that would go far wait for the others

class SphereSeparation {
public:
  SphereSeparation(std::vector<Sphere>& spheres, const ShearingBox& box, double offset, SphereSlabs& slabs)
      : spheres_(spheres), box_(box), offset_(offset), slabs_(slabs), own_(spheres.size()), moves_(own_, Vec3::Zero()),
        listed_positions_(own_) {}
  ~SphereSeparation() { spheres_.resize(own_); }
  SphereSeparation(const SphereSeparation&) = delete;
  SphereSeparation& operator=(const SphereSeparation&) = delete;

  // Confines the spheres to a ball about the origin; no sphere has a tether.
  void enclose(double ball_radius) {
    assert(ball_radius > 0.0);
    ball_radius_ = ball_radius;
    tether_ = 0.0;
  }

  bool run(int max_sweeps, const std::function<void(int)>& after_sweep) {
    assert(max_sweeps > 0);
    int list_age = sweeps_per_list;
    bool held = true; // at least one sphere is held back by its skin
    const Communicator& ranks = slabs_.ranks();
    for (int sweeps = 0; sweeps < max_sweeps; after_sweep(++sweeps)) {
      if (list_age >= sweeps_per_list && ranks.any(held)) {
        make_lists();
        list_age = 0;
      }
      if (!ranks.any(push()))
        return true;
      held = move();
      slabs_.update_copies(spheres_);
      ++list_age;
      tether_ = tether_ > last_tether ? tether_ * tether_decay : 0.0;
    }
    return false;
  }

private:
  void make_lists() {
    spheres_.resize(own_);
    slabs_.add_copies(spheres_, 1.0 + skin);
    lists_.build(spheres_, own_, box_, offset_, skin);
    parallel_for(own_, [&](std::size_t i) { listed_positions_[i] = spheres_[i].position; });
  }

  // Computes the next move of each sphere; false if no overlap is left.
  bool push() {
    std::atomic<bool> overlaps = false;
    parallel_for(own_, [&](std::size_t i) {
      if (spheres_[i].held)
        return;
      bool overlapping = false;
      Vec3 shift = push_on(i, overlapping);
      shift.z() += tether_ * (spheres_[i].height - spheres_[i].position.z());
      moves_[i] = kept_momentum * moves_[i] + strength * shift;
      if (overlapping)
        overlaps.store(true, std::memory_order_relaxed);
    });
    return overlaps;
  }

  Vec3 push_on(std::size_t i, bool& overlapping) const {
    Vec3 shift = Vec3::Zero();
    const Sphere& sphere = spheres_[i];
    for (const Neighbour& neighbour : lists_.of(i)) {
      const Sphere& other = spheres_[neighbour.sphere];
      Vec3 d = sphere.position - other.position;
      if (neighbour.image != Image{})
        d -= box_.displacement(neighbour.image, offset_);
      const double sum = sphere.radius + other.radius, smaller = std::min(sphere.radius, other.radius);
      const double target = sum + clearance * smaller, square = d.squaredNorm();
      if (square >= target * target)
        continue;
      const double distance = std::sqrt(square), mass = sphere.mass(), other_mass = other.mass();
      const Vec3 direction =
          distance > 0.0 ? Vec3(d / distance) : Vec3(0.0, 0.0, sphere.particle < other.particle ? -1.0 : 1.0);
      shift += direction * ((target - distance) * other_mass / (mass + other_mass));
      overlapping = overlapping || distance < sum + enough * smaller;
    }
    if (std::isfinite(ball_radius_))
      push_inward(sphere, shift, overlapping);
    return shift;
  }

  void push_inward(const Sphere& sphere, Vec3& shift, bool& overlapping) const {
    const double distance = sphere.position.norm(), room = ball_radius_ - sphere.radius;
    const double missing = distance - (room - clearance * sphere.radius);
    if (missing <= 0.0)
      return;
    shift -= sphere.position * (missing / distance);
    overlapping = overlapping || distance > room - enough * sphere.radius;
  }

  // Moves the spheres. None leaves its skin, so that the lists stay complete; true if a sphere was held back.
  bool move() {
    std::atomic<bool> held = false;
    parallel_for(own_, [&](std::size_t i) {
      Sphere& sphere = spheres_[i];
      const Vec3 moved = sphere.position + moves_[i] - listed_positions_[i];
      const double square = moved.squaredNorm(), allowed = 0.999 * skin * sphere.radius;
      if (square <= allowed * allowed) {
        sphere.position += moves_[i];
      } else {
        sphere.position = listed_positions_[i] + moved * (allowed / std::sqrt(square));
        held.store(true, std::memory_order_relaxed);
      }
    });
    return held;
  }

  std::vector<Sphere>& spheres_;
  const ShearingBox& box_;
  double offset_;
  SphereSlabs& slabs_;
  std::size_t own_; // number of this rank's spheres; copies follow them
  double ball_radius_ = std::numeric_limits<double>::infinity();
  std::vector<Vec3> moves_, listed_positions_;
  SphereNeighbours lists_;
  double tether_ = first_tether;
};

} // namespace

void sort_by_position(std::vector<Sphere>& spheres, const ShearingBox& box) {
  assert(box.area() > 0.0);
  const double width = 2.0 * std::sqrt(box.area() / static_cast<double>(spheres.size()));
  const auto strip = [&](const Sphere& sphere) { return std::floor(sphere.position.x() / width); };
  std::sort(spheres.begin(), spheres.end(), [&](const Sphere& a, const Sphere& b) {
    return std::tuple(strip(a), a.position.y(), a.particle) < std::tuple(strip(b), b.position.y(), b.particle);
  });
}

bool separate(std::vector<Sphere>& spheres, const ShearingBox& box, double offset, SphereSlabs& slabs, int max_sweeps,
              const std::function<void(int)>& after_sweep) {
  return SphereSeparation(spheres, box, offset, slabs).run(max_sweeps, after_sweep);
}

bool separate_in_ball(std::vector<Sphere>& spheres, double ball_radius, int max_sweeps) {
  const double side = 8.0 * ball_radius; // beyond the reach of images
  const ShearingBox box{side, side, 0.0, 0.0};
  SphereSlabs slabs({}, box);
  SphereSeparation separation(spheres, box, 0.0, slabs);
  separation.enclose(ball_radius);
  return separation.run(max_sweeps, [](int) {});
}

} // namespace keeler::initial_conditions
