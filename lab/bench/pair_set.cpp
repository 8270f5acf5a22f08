#include <keeler/bench/pair_set.hpp>

#include <keeler/core/stopwatch.hpp>

#include <cassert>
#include <limits>

namespace keeler::bench {
namespace {

// Records the queries of a step up to its first collision.
struct Recorder : collision::DriftObserver {
  explicit Recorder(bool every_candidate) : every_candidate_(every_candidate) {}
  bool wants_every_candidate() const override { return every_candidate_; }

  std::vector<finders::Query> queries;
  const finders::DriftStep* step = nullptr;
  bool before_events = true;

  void begins(const finders::DriftStep& now) override { step = &now; }
  void searched(const finders::Query& query, const finders::FinderResult&) override {
    if (before_events)
      queries.push_back(query);
  }
  void collided(const collision::CollisionRecord&) override { before_events = false; }

private:
  bool every_candidate_;
};

finders::Separation separation(const finders::Pair& pair, const Frequencies& f, double time) {
  const Rotation r(f, time);
  const State lo = state_at(pair.lo, f, r), hi = state_at(pair.hi, f, r);
  return {hi.position - lo.position, hi.velocity - lo.velocity};
}

// Returns the time between a and b at which a condition that holds at a ends.
template<class Condition> double bisect(double a, double b, const Condition& holds) {
  for (int k = 0; k < 60; ++k) {
    const double middle = 0.5 * (a + b);
    (holds(middle) ? a : b) = middle;
  }
  return b;
}

} // namespace

PairSet PairSet::of(Particles particles, const ShearingBox& box, double offset,
                    const collision::CollisionSettings& settings, const Frequencies& frequencies, double step,
                    bool every_candidate) {
  const std::vector<Body> before = particles.bodies;
  collision::DriftPhase drift(settings, frequencies, 1.0, step);
  Recorder recorder(every_candidate);
  drift.observe(&recorder);
  CollisionTally tally;
  drift.collide(particles, box, offset, tally);
  assert(recorder.step && "the drift called begins()");
  PairSet set(*recorder.step);
  set.bodies = before;
  set.queries = std::move(recorder.queries);
  return set;
}

finders::DriftStep PairSet::view() const {
  finders::DriftStep step = step_;
  step.bodies = bodies;
  step.tested = false; // the caller may have changed `bodies`
  return step;
}

double ns_per_call(const PairSet& pairs, finders::Finder& finder, double min_seconds) {
  assert(min_seconds > 0.0);
  if (pairs.queries.empty())
    return 0.0;
  const finders::DriftStep step = pairs.view();
  finder.begin(step);
  double seconds = 0.0, used = 0.0; // `used` prevents the compiler from removing the calls
  std::size_t calls = 0;
  while (seconds < min_seconds) {
    const double start = cpu_seconds();
    for (const finders::Query& query : pairs.queries)
      used += finder.find(query).time;
    seconds += cpu_seconds() - start;
    calls += pairs.queries.size();
  }
  return used == std::numeric_limits<double>::infinity() ? 0.0 : 1e9 * seconds / static_cast<double>(calls);
}

ScanResult dense_scan(const finders::Pair& pair, const Frequencies& f) {
  assert(pair.radius_sum > 0.0 && pair.start <= pair.end);
  constexpr int points = 512;
  const auto approaching = [&](double t) { return separation(pair, f, t).closing() < 0.0; };
  const auto apart = [&](double t) { return separation(pair, f, t).gap(pair.radius_sum) > 0.0; };
  ScanResult result;
  result.closest = std::numeric_limits<double>::infinity();
  double before = pair.start;
  finders::Separation last = separation(pair, f, before);
  for (int k = 1; k <= points; ++k) {
    const double now = pair.start + (pair.end - pair.start) * k / points;
    const finders::Separation here = separation(pair, f, now);
    if (last.closing() < 0.0) {
      const double deepest = here.closing() < 0.0 ? now : bisect(before, now, approaching);
      const finders::Separation there = separation(pair, f, deepest);
      result.closest = std::min(result.closest, there.d.norm() / pair.radius_sum - 1.0);
      if (there.gap(pair.radius_sum) <= 0.0) {
        result.contact = true;
        result.time = last.gap(pair.radius_sum) > 0.0 ? bisect(before, deepest, apart) : before;
        return result;
      }
    }
    before = now;
    last = here;
  }
  return result;
}

} // namespace keeler::bench
