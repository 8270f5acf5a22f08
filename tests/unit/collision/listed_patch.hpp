// A patch that drifts, is hit and is kicked as in a run, with its neighbour lists, and the brute-force search of all
// pairs through all images that these must equal.
#pragma once

#include "neighbours/neighbour_lists.hpp"

#include <keeler/core/random.hpp>
#include <keeler/gravity/images.hpp>

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <tuple>
#include <utility>
#include <vector>

namespace keeler::test {

// A pair that may touch: particle indices, the lower first, and the image of the higher.
using FoundPair = std::tuple<std::size_t, std::size_t, std::int32_t, std::int32_t>;

inline FoundPair pair_of(std::size_t i, std::size_t j, const Image& image) {
  const Image of_higher = i < j ? image : -image;
  return {std::min(i, j), std::max(i, j), of_higher.nx, of_higher.ny};
}

struct Setting {
  std::size_t count = 200;
  double depth = 0.4;        // optical depth
  double ratio = 1.0;        // largest radius, 1 m, over the smallest
  double heat = 1.0;         // m
  double step = 0.02;        // rad
  double elongation = 1.0;   // of the box, along the orbit
  double hits = 0.1;         // per particle and step
  double speed = 0.0;        // of hits, m/rad, added to that from heat
  std::size_t kick_each = 0; // number of steps between kicks; 0: none
  Frequencies frequencies{};
};

// A patch that drifts as in a run. Spheres may overlap, since contacts are not searched for.
struct ListedPatch {
  Setting setting;
  RandomStream random;
  Particles particles;
  ShearingBox box;
  std::int64_t steps = 0;
  bool undisturbed = false;
  collision::NeighbourLists lists;
  std::vector<std::uint32_t> buffer;

  ListedPatch(const Setting& s, std::uint64_t seed)
      : setting(s), random(seed, RandomPurpose::position, 0), lists(s.frequencies, s.step) {
    double area = 0.0;
    for (std::size_t k = 0; k < s.count; ++k) {
      const double least = 1.0 / s.ratio;
      const double radius = std::min(1.0, least * std::pow(random.uniform(), -0.5)); // a cumulative index of 2
      particles.bodies.push_back({{}, radius, radius * radius * radius});
      particles.ids.push_back(k);
      area += 3.141592653589793 * radius * radius;
    }
    const double side = std::sqrt(area / s.depth);
    box = {side / std::sqrt(s.elongation), side * std::sqrt(s.elongation), s.frequencies.shear(), 0.0};
    box.first_offset = random.uniform() * box.size_y;
    for (Body& body : particles.bodies)
      body.elements = {centred(box.size_x),      centred(box.size_y),      random.normal() * s.heat,
                       random.normal() * s.heat, random.normal() * s.heat, random.normal() * s.heat};
  }

  double centred(double width) { return width * (random.uniform() - 0.5); }
  std::size_t below(std::size_t count) {
    return static_cast<std::size_t>(random.uniform() * static_cast<double>(count));
  }
  double offset() const { return box.offset(2 * steps + 1, 0.5 * setting.step); }
  double half() const { return 0.5 * setting.step; }

  bool begin() { return lists.begin(particles, box, offset(), undisturbed); }

  void move_on() {
    ++steps;
    const hill::Rebase rebase(setting.frequencies, setting.step);
    for (Body& body : particles.bodies) {
      rebase(body.elements);
      into_cell(body);
    }
    undisturbed = true;
  }
  void into_cell(Body& body) const {
    Elements& el = body.elements;
    el = box.image_of(el, box.image_into_cell(el.guiding_x, el.guiding_y, offset()), offset());
  }

  Vec3 random_velocity(double speed) { return speed * Vec3(random.normal(), random.normal(), random.normal()); }
  // Returns the velocity relative to the local shear when the step begins.
  Vec3 state_velocity(std::size_t i) const {
    const Elements& el = particles.bodies[i].elements;
    const State s = state_at(el, setting.frequencies, Rotation(setting.frequencies, -half()));
    return s.velocity + Vec3(0.0, box.shear * s.position.x(), 0.0);
  }
  void change_velocity(std::size_t i, double time, const Vec3& dv) {
    kick(particles.bodies[i].elements, dv, setting.frequencies, Rotation(setting.frequencies, time));
  }

  // Hits particle i with a random velocity change and updates the lists as the drift does.
  void hit(std::size_t i, double time, double speed) {
    change_velocity(i, time, random_velocity(speed));
    if (!lists.changed(i, time))
      lists.rebuild_list(i);
    if (lists.reaches_far())
      lists.rebuild_for_step();
  }

  // Calls visit(image) for each image of j through which the pair may touch from `start` on, by the exact test.
  template<class Visit>
  void visit_images(std::size_t i, std::size_t j, double start, int far, const Visit& visit) const {
    const finders::StraightLineTest test{setting.frequencies, half(), half(), 1e-13 * (box.size_x + box.size_y)};
    const Body &a = particles.bodies[i], &b = particles.bodies[j];
    const Image nearest = lists.nearest_image(a, b);
    for (int nx = -far; nx <= far; ++nx)
      for (int ny = -far; ny <= far; ++ny) {
        const Image image{nearest.nx + nx, nearest.ny + ny};
        const Vec3 shift = box.displacement(image, offset());
        if (test.may_touch(a, b, shift.x(), shift.y(), start))
          visit(image);
      }
  }

  // Tries the images beside the nearest one too, but only in every eighth step, since that takes long.
  std::vector<FoundPair> all_pairs() const {
    std::vector<FoundPair> all;
    const int far = steps % 8 == 0 ? 1 : 0;
    for (std::size_t i = 0; i < particles.size(); ++i)
      for (std::size_t j = i + 1; j < particles.size(); ++j)
        visit_images(i, j, -half(), far, [&](const Image& image) { all.push_back(pair_of(i, j, image)); });
    return all;
  }
  std::vector<FoundPair> visited(const collision::NeighbourLists& by) const {
    std::vector<FoundPair> all;
    for (std::size_t block = 0; block < by.blocks(); ++block)
      by.visit_block(block,
                     [&](std::size_t i, std::size_t j, const Image& image) { all.push_back(pair_of(i, j, image)); });
    std::sort(all.begin(), all.end());
    return all;
  }

  std::vector<FoundPair> all_partners(std::size_t i, double start, int far = 0) const {
    std::vector<FoundPair> all;
    for (std::size_t j = 0; j < particles.size(); ++j)
      if (j != i)
        visit_images(i, j, start, far, [&](const Image& image) { all.push_back(pair_of(i, j, image)); });
    std::sort(all.begin(), all.end());
    return all;
  }
  std::vector<FoundPair> visited_partners(std::size_t i, double start) {
    std::vector<FoundPair> all;
    const auto take = [&](std::size_t j, const Image& image) { all.push_back(pair_of(i, j, image)); };
    if (lists.reaches_far())
      lists.visit_everywhere(i, start, take);
    else
      lists.visit_partners(i, start, half(), buffer, take);
    std::sort(all.begin(), all.end());
    return all;
  }
};

inline bool once_each(const std::vector<FoundPair>& sorted) {
  return std::adjacent_find(sorted.begin(), sorted.end()) == sorted.end();
}

// True if lists are symmetric, without duplicates, and no particle is on its own list.
inline bool symmetric(const collision::NeighbourLists& lists, std::size_t count) {
  std::vector<std::pair<std::size_t, std::size_t>> forth, back;
  for (std::size_t i = 0; i < count; ++i)
    for (const std::uint32_t j : lists.list(i)) {
      forth.emplace_back(i, j);
      back.emplace_back(j, i);
    }
  std::sort(forth.begin(), forth.end());
  std::sort(back.begin(), back.end());
  const auto itself = [](const auto& entry) { return entry.first == entry.second; };
  return forth == back && std::adjacent_find(forth.begin(), forth.end()) == forth.end() &&
         std::none_of(forth.begin(), forth.end(), itself);
}

struct Seen {
  std::size_t pairs = 0, partners = 0, steps = 0, more = 0;
};

// Checks the pairs at the begin of a step, with and without the exact test.
inline void check_begin(ListedPatch& patch, Seen& seen) {
  const std::vector<FoundPair> expected = patch.all_pairs();
  patch.lists.visit_exactly(true);
  CHECK((patch.visited(patch.lists) == expected));
  patch.lists.visit_exactly(false);
  const std::vector<FoundPair> more = patch.visited(patch.lists);
  CHECK(once_each(more));
  CHECK(std::includes(more.begin(), more.end(), expected.begin(), expected.end()));
  patch.lists.visit_exactly(true);
  seen.pairs += expected.size();
  seen.more += more.size();
  ++seen.steps;
}

// Hits random pairs at random times, some particles repeatedly, and checks the partners of these and of others.
inline void hit_some(ListedPatch& patch, Seen& seen) {
  const std::size_t count = patch.particles.size();
  std::vector<double> times(static_cast<std::size_t>(0.5 * patch.setting.hits * static_cast<double>(count)));
  for (double& time : times)
    time = patch.centred(patch.setting.step);
  std::sort(times.begin(), times.end());
  std::vector<std::uint32_t> hit;
  for (const double time : times) {
    const double speed = (patch.below(6) ? 0.3 : 5.0) * (0.1 + patch.setting.heat) + patch.setting.speed;
    const std::size_t both[] = {patch.below(patch.below(4) ? count : 10), patch.below(count)};
    for (const std::size_t i : both) {
      patch.hit(i, time, speed);
      hit.push_back(static_cast<std::uint32_t>(i));
    }
    for (const std::size_t i : {both[0], both[1], patch.below(count)}) {
      const std::vector<FoundPair> expected = patch.all_partners(i, time);
      CAPTURE(i);
      CAPTURE(time);
      CHECK((patch.visited_partners(i, time) == expected));
      seen.partners += expected.size();
    }
  }
  std::sort(hit.begin(), hit.end());
  hit.erase(std::unique(hit.begin(), hit.end()), hit.end());
  std::reverse(hit.begin(), hit.end()); // in any order
  CHECK(symmetric(patch.lists, count));
  patch.lists.mark_dirty(hit);
}

inline void kick_all(ListedPatch& patch) {
  for (std::size_t i = 0; i < patch.particles.size(); ++i)
    patch.change_velocity(i, -patch.half(), patch.random_velocity(0.02 * patch.setting.heat));
  patch.undisturbed = false;
}

inline void drift(ListedPatch& patch, int steps, Seen& seen) {
  for (int step = 0; step < steps; ++step) {
    CAPTURE(patch.steps);
    REQUIRE(patch.begin());
    check_begin(patch, seen);
    CHECK(symmetric(patch.lists, patch.particles.size()));
    hit_some(patch, seen);
    patch.move_on();
    if (patch.setting.kick_each && patch.steps % static_cast<std::int64_t>(patch.setting.kick_each) == 0)
      kick_all(patch);
  }
}

} // namespace keeler::test
