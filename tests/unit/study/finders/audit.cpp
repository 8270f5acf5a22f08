#include "finders/audit.hpp"

#include <keeler/bench/pair_set.hpp>
#include <keeler/core/units.hpp>
#include <keeler/finders/finders.hpp>
#include <keeler/finders/motion/relative.hpp>
#include <keeler/initial_conditions/uniform.hpp>

#include <doctest/doctest.h>

#include <cmath>

namespace audit_test {

using namespace keeler;
using namespace keeler::study;

namespace {

const Frequencies kepler{1.0, 1.0};

// A particle at rest, a second that hits it from the left at 0.2 of the step, a third from the right at 0.6, and a
// fourth that passes far away.
struct Trio {
  std::vector<Body> bodies;
  finders::DriftStep step{kepler, -0.5e-3, 0.5e-3, 100.0};

  Trio() {
    add({0.0, 0.0, 0.0}, {0.0, 0.0, 0.0}, 0.0);
    add({-2.0, 0.0, 0.0}, {50.0, 0.0, 0.0}, at(0.2));
    add({2.0, 0.0, 0.0}, {-50.0, 0.0, 0.0}, at(0.6));
    add({20.0, 20.0, 0.0}, {-50.0, 0.0, 0.0}, at(0.5));
    step.bodies = bodies;
  }
  void add(const Vec3& position, const Vec3& velocity, double time) {
    bodies.push_back({elements_from({position, velocity}, kepler, Rotation(kepler, time)), 1.0, 1.0});
  }
  double at(double fraction) const { return step.begin + fraction * (step.end - step.begin); }
  finders::Query query(std::uint32_t other) const { return {0, other, 0.0, 0.0, step.begin}; }
};

finders::FinderResult called(finders::FinderExit exit, double time) {
  return {exit, time, 3, 4};
}

} // namespace

TEST_CASE("an audit tells true contacts, missed, false, late and misordered ones") {
  const Trio trio;
  SUBCASE("all right") {
    FinderAudit audit;
    audit.begins(trio.step);
    const std::unique_ptr<finders::Finder> certified = finders::make_finder("certified");
    certified->begin(trio.step);
    for (const std::uint32_t other : {1U, 2U, 3U})
      audit.searched(trio.query(other), certified->find(trio.query(other)));
    const FinderVerdict v = audit.verdict();
    CHECK(v.calls() == 3);
    CHECK(v.hits() == 2);
    CHECK(v.true_hits == 2);
    CHECK(v.missed + v.false_hits + v.late + v.misordered == 0);
    CHECK(std::fabs(v.deepest) < 1e-12);
  }
  SUBCASE("missed and false") {
    FinderAudit audit;
    audit.begins(trio.step);
    audit.searched(trio.query(1), called(finders::FinderExit::missed, 0.0));
    audit.searched(trio.query(2), called(finders::FinderExit::hit, trio.at(0.5))); // still apart
    audit.searched(trio.query(3), called(finders::FinderExit::hit, trio.at(0.5)));
    const FinderVerdict v = audit.verdict();
    CHECK(v.true_hits == 2);
    CHECK(v.missed == 1);
    CHECK(v.false_hits == 2);
  }
  SUBCASE("late, and therefore out of order for the particle in the middle") {
    FinderAudit audit;
    audit.begins(trio.step);
    audit.searched(trio.query(1), called(finders::FinderExit::hit, trio.at(0.7)));
    audit.searched(trio.query(2), called(finders::FinderExit::hit, trio.at(0.6)));
    const FinderVerdict v = audit.verdict();
    CHECK(v.late == 1);
    CHECK(v.misordered == 1); // particle 0 meets 2 first, and 1 in truth
    CHECK(v.deepest == doctest::Approx(50.0 * 0.5 * 1e-3 / 2.0).epsilon(0.01));
  }
}

TEST_CASE("a contact that was passed is late, though the spheres just touch when it is called") {
  std::vector<Body> bodies(2, {{}, 1.0, 1.0});
  bodies[1].elements = elements_from({{0.5, 0.0, 0.0}, {0.0, -50.0, 0.0}}, kepler, Rotation(kepler, 0.0));
  finders::DriftStep step(kepler, -0.2, 0.2, 100.0);
  step.bodies = bodies;
  const finders::Query query{0, 1, 0.0, 0.0, step.begin};
  const finders::Pair pair = pair_of(query, step);
  double inside = 0.0, outside = 0.1; // when they part again
  for (int k = 0; k < 60; ++k) {
    const double middle = 0.5 * (inside + outside);
    (finders::RelativeMotion(pair, step).at(middle).gap(pair.radius_sum) < 0.0 ? inside : outside) = middle;
  }
  FinderAudit audit;
  audit.begins(step);
  audit.searched(query, called(finders::FinderExit::hit, outside));
  const FinderVerdict v = audit.verdict();
  CHECK(v.true_hits == 1);
  CHECK(v.missed == 0);
  CHECK(v.false_hits == 0);
  CHECK(v.late == 1);
  CHECK(v.deepest > 0.5);
}

TEST_CASE("on the pairs of a real step the dense scan finds what the certified finder finds") {
  initial_conditions::UniformRequest request;
  const std::size_t count = 400;
  request.radii.assign(count, 1.0);
  const double size = std::sqrt(pi * static_cast<double>(count) / 0.5);
  request.box = {size, size, 1.5, 0.3 * size};
  request.dispersion_x = 2.2, request.dispersion_z = 1.4;
  const double h = 2e-2 * two_pi;
  const Patch patch = uniform_patch(request);
  collision::CollisionSettings settings;
  settings.finder = "linear-full"; // what drives the step does not matter to the pairs
  const auto pairs = [&](bool all) {
    return bench::PairSet::of(particles_from(patch, 0.5 * h), request.box, request.box.offset(1, 0.5 * h), settings,
                              kepler, h, all);
  };
  const bench::PairSet all = pairs(true), left = pairs(false);
  CHECK(left.queries.size() < all.queries.size() / 4);
  CHECK(ns_per_call(all, *finders::make_finder("certified"), 1e-3) > 0.0);

  const auto contacts = [&](const bench::PairSet& set) {
    const finders::DriftStep step = set.view();
    const std::unique_ptr<finders::Finder> certified = finders::make_finder("certified");
    certified->begin(step);
    int found = 0;
    for (const finders::Query& query : set.queries) {
      const finders::FinderResult truth = certified->find(query);
      const bench::ScanResult scan = bench::dense_scan(pair_of(query, step), kepler);
      CHECK(truth.contact() == scan.contact);
      if (truth.contact() && scan.contact)
        CHECK(std::fabs(truth.time - scan.time) < 1e-9 * h);
      found += truth.contact();
    }
    return found;
  };
  CHECK(contacts(all) > 30);
  CHECK(contacts(all) == contacts(left)); // the rejection loses none
}

} // namespace audit_test
