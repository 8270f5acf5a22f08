// The policy of neighbour lists by itself: counts in, lengths in steps out.
#include "neighbours/rebuild_policy.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <cstdint>

namespace rebuild_policy_test {

using namespace keeler;
using namespace keeler::collision;

TEST_CASE("the lifetime of lists finds the cheapest one and stays near it") {
  // rebuilding costs 60 · 1000, and each step of age k costs 1000 k more
  RebuildPolicy policy;
  StepInterval lists{0, 1};
  bool lived = false;
  std::uint64_t late = 0, sum = 0;
  for (int life = 0; life < 200; ++life) {
    lists = {0, policy.choose_lifetime(lived, lists, 1e-3)};
    lived = true;
    policy.rebuilt_all(1000, 0, 0);
    for (; !lists.over(); ++lists.age)
      policy.pruned(500 * static_cast<std::uint64_t>(lists.age));
    if (life >= 100) {
      ++late;
      sum += static_cast<std::uint64_t>(lists.length);
    }
  }
  const double mean = static_cast<double>(sum) / static_cast<double>(late); // the best: √(2 · 60) = 11 steps
  CHECK(mean > 8.0);
  CHECK(mean < 15.0);
}

TEST_CASE("lists last at most 64 steps and 1 rad, and at least a step") {
  for (const double step : {1e-4, 0.03, 0.4, 3.0}) {
    CAPTURE(step);
    RebuildPolicy policy;
    StepInterval lists{0, 1};
    for (int life = 0; life < 20; ++life) { // ageing costs nothing
      lists = {0, policy.choose_lifetime(life > 0, lists, step)};
      policy.rebuilt_all(1000, 100, 100);
      lists.age = lists.length;
    }
    CHECK(lists.length == std::max(1, std::min(64, static_cast<int>(1.0 / step))));
  }
}

TEST_CASE("lists that did not end by themselves teach nothing, and a lifetime can be halved") {
  RebuildPolicy policy;
  const int first = policy.choose_lifetime(false, {0, 1}, 1e-3);
  CHECK(policy.choose_lifetime(false, {5, first}, 1e-3) == first);
  CHECK(policy.halve_lifetime() == first / 2);
  CHECK(policy.choose_lifetime(false, {5, first}, 1e-3) == first / 2);
}

TEST_CASE("a pruning interval ends with the lists, before a disturbance is due, and while few particles are dirty") {
  RebuildPolicy policy;
  const StepInterval fresh{0, 50};
  policy.begin_step(true);
  CHECK(policy.pruning_interval(0, 1000, 8, fresh, 1e-3) == 8);
  CHECK(policy.pruning_interval(0, 1000, 8, {47, 50}, 1e-3) == 3);
  CHECK(policy.pruning_interval(0, 1000, 8, fresh, 0.05) == 4);   // 0.2 rad
  CHECK(policy.pruning_interval(0, 1000, 8, fresh, 0.5) == 1);    //
  CHECK(policy.pruning_interval(200, 1000, 8, fresh, 1e-3) == 3); // 25 a step, of 100
  CHECK(policy.pruning_interval(900, 1000, 1, fresh, 1e-3) == 1);
  for (int kick = 0; kick < 3; ++kick) { // a disturbance every five steps
    policy.begin_step(false);
    CHECK(policy.pruning_interval(0, 1000, 8, fresh, 1e-3) == (kick ? 5 : 2));
    for (int step = 0; step < 4; ++step)
      policy.begin_step(true);
  }
}

TEST_CASE("all lists are rebuilt when rebuilding them one by one has cost more") {
  RebuildPolicy policy;
  policy.rebuilt_all(600, 0, 0);
  CHECK_FALSE(policy.better_rebuild_all(100, 600));
  CHECK(policy.better_rebuild_all(101, 600));
  for (int k = 0; k < 60; ++k)
    policy.renewed_one();
  CHECK_FALSE(policy.better_rebuild_all(40, 600));
  CHECK(policy.better_rebuild_all(41, 600));
  policy.rebuilt_all(600, 0, 0);
  CHECK_FALSE(policy.better_rebuild_all(100, 600));
}

TEST_CASE("costs are those of the present lists") {
  RebuildPolicy policy;
  policy.rebuilt_all(10, 100, 20);
  CHECK(policy.cost() == doctest::Approx(600.0 + 130.0 + 120.0));
  policy.updated(2);
  policy.pruned(30);
  policy.hit(4);
  CHECK(policy.cost() == doctest::Approx(850.0 + 1600.0 + 60.0 + 20.0));
  policy.rebuilt_all(10, 0, 0);
  CHECK(policy.cost() == doctest::Approx(600.0));
}

} // namespace rebuild_policy_test
