// The parts of the parallel contact loop by themselves: cuts of the box, locks, and the logs of changes and contacts.
#include "change_log.hpp"
#include "domain_contacts.hpp"
#include "domain_cut.hpp"
#include "particle_locks.hpp"

#include <keeler/core/random.hpp>

#include <doctest/doctest.h>

#include <array>
#include <cmath>
#include <initializer_list>

namespace domains_test {

using namespace keeler;
using namespace keeler::collision;

namespace {

// The position at this displacement from another, through the edges of the box.
BoxPosition displaced(const BoxPosition& from, std::int64_t x, std::int64_t y, std::uint32_t offset_y) {
  const std::int64_t boxes = (std::int64_t{from.x} + x) >> 32; // outward
  return {static_cast<std::uint32_t>(from.x + x), static_cast<std::uint32_t>(from.y + y + boxes * offset_y)};
}

} // namespace

TEST_CASE(
    "in each round every position has one owner, and blocks reach as far as is_inside() says, through all edges") {
  RandomStream random(1, RandomPurpose::sample, 0);
  constexpr std::size_t last = DomainCut::rounds - 1;
  const auto position = [&] { return static_cast<std::uint32_t>(random.uniform() * full_turn); };
  std::array<std::size_t, last> first_inside{}; // places that no earlier round has inside
  for (const double x_over_y : {0.1, 1.0, 3.0})
    for (const std::size_t domains : std::initializer_list<std::size_t>{1, 2, 3, 8, 127, DomainCut::max_domains}) {
      CAPTURE(domains);
      CAPTURE(x_over_y);
      const std::uint32_t offset_y = position();
      DomainCut cut;
      cut.cut(domains, x_over_y, offset_y);
      const std::size_t per_round = cut.end_of(0);
      CHECK(per_round <= domains);
      CHECK(4 * per_round > domains);
      for (std::size_t round = 0; round < last; ++round) {
        CHECK(cut.end_of(round) == (round + 1) * per_round);
        CHECK(cut.begin_of(round + 1) == cut.end_of(round));
      }
      CHECK(cut.end_of(last) == cut.domains());
      CHECK(cut.domains() == last * per_round + 1);
      std::vector<std::size_t> counts(last * per_round);
      std::size_t inside = 0;
      const double reach = 0.1 * full_turn / static_cast<double>(per_round);
      for (int k = 0; k < 20000; ++k) {
        const BoxPosition place{position(), position()};
        const BoxDistance distance{static_cast<std::uint64_t>(reach * random.uniform()),
                                   static_cast<std::uint64_t>(reach * random.uniform())};
        bool was_inside = false;
        for (std::size_t round = 0; round < last; ++round) {
          const std::size_t owner = cut.owner(round, place);
          REQUIRE(owner < per_round);
          ++counts[cut.begin_of(round) + owner];
          if (!cut.is_inside(round, place, distance))
            continue;
          ++inside;
          first_inside[round] += was_inside ? 0 : 1;
          was_inside = true;
          for (const int side_x : {-1, 0, 1})
            for (const int side_y : {-1, 0, 1})
              REQUIRE(cut.owner(round, displaced(place, side_x * static_cast<std::int64_t>(distance.x),
                                                 side_y * static_cast<std::int64_t>(distance.y), offset_y)) == owner);
        }
        CHECK(cut.owner(last, place) == 0);
        CHECK(cut.is_inside(last, place, distance));
        if (place.x < 0.4 * full_turn) // no image in any round
          CHECK(was_inside);
      }
      CHECK(inside > 30000); // of 60000
      const double mean = 20000.0 / static_cast<double>(per_round);
      for (const std::size_t count : counts) // blocks are equal: within five standard errors
        CHECK(std::fabs(static_cast<double>(count) - mean) < 5.0 * std::sqrt(mean) + 5.0);
    }
  for (const std::size_t places : first_inside)
    CHECK(places > 0);
}

TEST_CASE("a change log restores orbits and spins, the last change first") {
  Particles particles;
  particles.rough = true;
  particles.bodies.resize(2);
  particles.ids = {0, 1};
  particles.spins.assign(2, Vec3::Zero());
  StepHistory history;
  history.begin_step(2, -1.0);
  ChangeLog log;
  log.resize(2, 3);
  std::vector<ChangeNumber> numbers;
  for (int k = 0; k < 3; ++k) { // particle 1, by domains 0, 1 and 2
    const auto domain = static_cast<std::size_t>(k);
    const ChangeNumber earlier = log.newest(history, 1);
    CHECK(earlier == (k > 0 ? numbers.back() : 0));
    log.add(domain, {1, earlier, history.last_change(1), 0.1 * k, particles.bodies[1].elements}, particles);
    history.change(1, 0.1 * k);
    particles.bodies[1].elements.guiding_x += 1.0;
    particles.spins[1].z() += 2.0;
    numbers.push_back(log.newest(history, 1));
    CHECK(ChangeLog::domain_of(numbers.back()) == domain);
    CHECK(ChangeLog::index_of(numbers.back()) == 0);
  }
  CHECK(log.newest(history, 0) == 0);
  CHECK(history.event_count(1) == 3);
  for (int k = 2; k >= 0; --k) {
    const ChangeNumber number = log.newest(history, 1);
    CHECK(number == numbers[static_cast<std::size_t>(k)]);
    log.restore(number, particles);
    history.reinstate(1, log[number].begin);
    CHECK(particles.bodies[1].elements.guiding_x == k);
    CHECK(particles.spins[1].z() == 2.0 * k);
  }
  CHECK(log.newest(history, 1) == 0);
  CHECK(history.event_count(1) == 6); // no event of a path that was rolled back becomes valid again
  CHECK(history.last_change(1) == -1.0);
  CHECK(ChangeLog::partner_of(ChangeLog::number_of(2, 6)) == ChangeLog::number_of(2, 7));
  CHECK(ChangeLog::partner_of(ChangeLog::number_of(2, 7)) == ChangeLog::number_of(2, 6));
  CHECK(ChangeLog::contact_of(ChangeLog::number_of(2, 7)) == 3);
}

TEST_CASE("a domain sets scheduled locks once, in the order of time, and releases its locks") {
  LockSchedule schedule;
  schedule.add(0.3, 3, 7);
  schedule.add(0.1, 1, 0);
  schedule.add(0.2, 2, 0);
  schedule.sort();
  ParticleLocks all;
  all.resize(4);
  {
    DomainLocks locks(all);
    const auto lock_due = [&](double time) {
      int count = 0;
      schedule.visit_due(time, [&](std::uint32_t i, std::uint32_t event_count) {
        CHECK(event_count == (i == 3 ? 7 : 0));
        locks.lock(i);
        ++count;
      });
      return count;
    };
    CHECK(lock_due(0.05) == 0);
    CHECK(lock_due(0.2) == 2);
    CHECK(lock_due(0.2) == 0);
    CHECK((all.is_locked(1) && all.is_locked(2) && !all.is_locked(3)));
    CHECK(lock_due(1.0) == 1);
    CHECK(all.is_locked(3));
  }
  for (std::size_t i = 0; i < 4; ++i)
    CHECK_FALSE(all.is_locked(i));
}

TEST_CASE("the contacts of a domain: the ones that were rolled back are skipped") {
  DomainContacts log;
  for (int k = 0; k < 5; ++k) {
    log.add(Contact{.time = 0.1 * k});
    log.add(CollisionRecord{.time = 0.1 * k, .low_id = 0, .high_id = 1, .image = {}, .normal_speed = 1, .fast = true});
  }
  log.roll_back(0);
  log.roll_back(2);
  CHECK(log.next_valid(0) == 1);
  CHECK(log.next_valid(2) == 3);
  CHECK(log.record(3)->time == log[3].time);
  log.remove_last();
  CHECK(log.size() == 4);
  log.roll_back(3);
  CHECK(log.next_valid(2) == log.size());
  log.clear();
  log.add(Contact{});
  CHECK(log.record(0) == nullptr);
}

} // namespace domains_test
