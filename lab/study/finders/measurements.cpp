#include "measurements.hpp"

#include "audit.hpp"

#include <keeler/bench/pair_set.hpp>
#include <keeler/cells/overlap.hpp>
#include <keeler/core/random.hpp>
#include <keeler/core/stopwatch.hpp>
#include <keeler/finders/finders.hpp>
#include <keeler/finders/motion/relative.hpp>
#include <keeler/finders/search/certified.hpp>
#include <keeler/simulation/simulation.hpp>
#include <keeler/statistics/median.hpp>

#include <algorithm>
#include <cassert>
#include <cmath>

namespace keeler::study {
namespace {

template<class Measure> double median_of(int repeats, const Measure& measure) {
  std::vector<double> values;
  for (int repeat = 0; repeat < repeats; ++repeat)
    values.push_back(measure());
  return statistics::median(values);
}

bench::PairSet first_pairs(const StudyState& state, const Scene& scene, bool every_candidate) {
  const Simulation simulation(scene, state.patch);
  const simulation::SimulationState& s = simulation.state();
  return bench::PairSet::of(s.particles, s.box, s.epoch_offset(), scene.collisions, scene.planet.frequencies,
                            s.step_length, every_candidate);
}

int steps_of(double step) {
  assert(step > 0.0);
  return static_cast<int>(std::lround(study_orbits / step));
}

// Returns the bins without the empty ones at the end.
Json trimmed(const finders::FinderCounts::Histogram& histogram) {
  std::size_t length = histogram.size();
  while (length > 0 && histogram[length - 1] == 0)
    --length;
  return Json(std::vector<std::uint64_t>(histogram.begin(), histogram.begin() + static_cast<std::ptrdiff_t>(length)));
}

Json exits_of(const finders::FinderCounts& counts) {
  Json exits = Json::object();
  for (int k = 0; k < finders::finder_exits; ++k) {
    const finders::FinderCounts::Calls& calls = counts.by_exit[static_cast<std::size_t>(k)];
    if (calls.count > 0)
      exits[name_of(static_cast<finders::FinderExit>(k))] = {{"calls", calls.count},
                                                             {"iterations", trimmed(calls.by_iterations)},
                                                             {"evaluations", trimmed(calls.by_evaluations)}};
  }
  return exits;
}

double run_seconds(Simulation& simulation, double step) {
  const double start = cpu_seconds();
  for (int k = steps_of(step); k > 0; --k)
    simulation.advance();
  return cpu_seconds() - start;
}

// Passes every candidate pair of the grid to the run's finder, or to `finder` in its place.
struct EveryCandidate final : collision::DriftObserver {
  explicit EveryCandidate(std::unique_ptr<finders::Finder> finder = nullptr) : finder_(std::move(finder)) {}
  bool wants_every_candidate() const override { return true; }
  finders::Finder* replacement_finder() override { return finder_.get(); }
  bool wants_events() const override { return false; }

private:
  std::unique_ptr<finders::Finder> finder_;
};

double run_seconds(const StudyState& state, const Scene& scene, bool every_candidate) {
  Simulation simulation(scene, state.patch);
  EveryCandidate everything;
  simulation.drift().observe(every_candidate ? &everything : nullptr);
  return run_seconds(simulation, scene.time.step);
}

// The certified finder's motion without its early rejection, so that every call performs the search.
struct UnrejectedMotion : finders::BoundedMotion {
  using finders::BoundedMotion::BoundedMotion;
  static bool surely_apart(const finders::Query&, const Body&, const Body&, const finders::DriftStep&) { return false; }
};

// Wraps a finder and appends its answers to `answers` in the order of the calls. (With an observer the calls of a run
// come in another order than without one.)
class TapeRecorder final : public finders::Finder {
public:
  TapeRecorder(std::unique_ptr<finders::Finder> finder, std::vector<finders::FinderResult>& answers)
      : finder_(std::move(finder)), answers_(answers) {}
  void begin(const finders::DriftStep& step) override { finder_->begin(step); }
  void changed(std::size_t particle) override { finder_->changed(particle); }
  finders::FinderResult find(const finders::Query& query) const override {
    answers_.push_back(finder_->find(query));
    return answers_.back();
  }
  std::size_t bytes_per_particle() const override { return finder_->bytes_per_particle(); }

private:
  std::unique_ptr<finders::Finder> finder_;
  std::vector<finders::FinderResult>& answers_;
};

// Replays recorded answers to a run with identical calls: the cost of such a run is everything except the finder.
class Tape final : public finders::Finder {
public:
  explicit Tape(const std::vector<finders::FinderResult>& answers) : answers_(answers) {}
  void begin(const finders::DriftStep&) override {}
  void changed(std::size_t) override {}
  finders::FinderResult find(const finders::Query&) const override { return answers_.at(next_++); }
  std::size_t bytes_per_particle() const override { return 0; }

private:
  const std::vector<finders::FinderResult>& answers_;
  mutable std::size_t next_ = 0;
};

// Returns the median time per call (ns) of every finder on the same pairs, measured in turn.
Json times_per_call(const bench::PairSet& pairs, const StudyState& state, int repeats) {
  assert(repeats > 0);
  std::vector<std::unique_ptr<finders::Finder>> finders;
  for (const finders::FinderEntry& entry : finders::finder_table())
    finders.push_back(entry.make());
  std::vector<std::vector<double>> times(finders.size());
  for (int repeat = 0; repeat < repeats; ++repeat)
    for (std::size_t k = 0; k < finders.size(); ++k)
      times[k].push_back(ns_per_call(pairs, *finders[k], state.call_seconds));
  Json json;
  for (std::size_t k = 0; k < finders.size(); ++k)
    json[finders::finder_table()[k].name] = statistics::median(times[k]);
  return json;
}

FinderVerdict verdict_on(const bench::PairSet& pairs, finders::Finder& finder) {
  const finders::DriftStep step = pairs.view();
  finder.begin(step);
  FinderAudit audit;
  audit.begins(step);
  for (const finders::Query& query : pairs.queries)
    audit.searched(query, finder.find(query));
  return audit.verdict();
}

// Removes pairs that overlap when their search begins: a run would have resolved their contact earlier.
void drop_overlapping(bench::PairSet& pairs) {
  const finders::DriftStep step = pairs.view();
  const auto overlapping = [&](const finders::Query& query) {
    const finders::Pair pair = pair_of(query, step);
    return finders::RelativeMotion(pair, step).at(query.start).gap(pair.radius_sum) <= 0.0;
  };
  pairs.queries.erase(std::remove_if(pairs.queries.begin(), pairs.queries.end(), overlapping), pairs.queries.end());
}

// Gives a fraction of the particles a small velocity change, each at a random time within the step.
void move_some(bench::PairSet& pairs, double fraction, double kick_speed) {
  assert(0.0 <= fraction && fraction <= 1.0);
  const finders::DriftStep step = pairs.view();
  std::vector<double> changed(pairs.bodies.size(), step.begin);
  for (std::size_t k = 0; k < pairs.bodies.size(); ++k) {
    RandomStream random(1, RandomPurpose::relaxation, k);
    if (random.uniform() >= fraction)
      continue;
    changed[k] = step.begin + (step.end - step.begin) * random.uniform();
    const Vec3 dv = kick_speed * Vec3(random.normal(), random.normal(), random.normal());
    kick(pairs.bodies[k].elements, dv, step.frequencies, Rotation(step.frequencies, changed[k]));
  }
  for (finders::Query& query : pairs.queries)
    query.start = std::max(changed[query.low], changed[query.high]);
  drop_overlapping(pairs);
}

} // namespace

std::vector<std::string> shown_finders() {
  std::vector<std::string> names = paper_finders;
  names.emplace_back("certified");
  return names;
}

std::vector<std::string> all_finders() {
  std::vector<std::string> names;
  for (const finders::FinderEntry& entry : finders::finder_table())
    names.emplace_back(entry.name);
  return names;
}

Json timed_run(const StudyState& state, double step, const std::string& finder) {
  const Scene scene = state.timed(step, finder);
  const bench::PairSet pairs = first_pairs(state, scene, true);
  const double call = ns_per_call(pairs, *finders::make_finder(finder), state.call_seconds);
  return {{"cpu_s", run_seconds(state, scene, true)}, {"ns_per_call", call}};
}

Json audited_run(const StudyState& state, double step, const std::string& finder) {
  Simulation simulation(state.timed(step, finder), state.patch);
  FinderAudit audit;
  simulation.drift().observe(&audit);
  for (int k = steps_of(step); k > 0; --k)
    simulation.advance();
  const FinderVerdict verdict = audit.verdict();
  const CollisionTally& tally = simulation.state().collisions;
  return {{"calls", verdict.calls()},
          {"hits", verdict.hits()},
          {"true_hits", verdict.true_hits},
          {"missed", verdict.missed},
          {"false_hits", verdict.false_hits},
          {"late", verdict.late},
          {"misordered", verdict.misordered},
          {"evaluations", verdict.counts.total().evaluations},
          {"iterations", verdict.counts.total().iterations},
          {"halvings", verdict.counts.total().halvings},
          {"collisions", tally.fast + tally.slow},
          {"deepest", verdict.deepest},
          {"largest_overlap", cells::largest_overlap(simulation.patch()).depth},
          {"bytes_per_particle", simulation.drift().finder().bytes_per_particle()},
          {"exits", exits_of(verdict.counts)}};
}

Json finder_fraction(const StudyState& state, double step, const std::string& finder, int repeats) {
  assert(repeats > 0);
  const Scene scene = state.timed(step, finder);
  std::vector<finders::FinderResult> answers;
  {
    EveryCandidate recording(std::make_unique<TapeRecorder>(finders::make_finder(finder), answers));
    Simulation simulation(scene, state.patch);
    simulation.drift().observe(&recording);
    run_seconds(simulation, step);
  }
  std::vector<double> with, without;
  for (int repeat = 0; repeat < repeats; ++repeat) {
    with.push_back(run_seconds(state, scene, true));
    EveryCandidate playing(std::make_unique<Tape>(answers));
    Simulation simulation(scene, state.patch);
    simulation.drift().observe(&playing);
    without.push_back(run_seconds(simulation, step));
  }
  return {{"cpu_s", statistics::median(with)}, {"cpu_s_without_finder", statistics::median(without)}};
}

Json call_details(const StudyState& state, double step, int repeats) {
  const bench::PairSet pairs = first_pairs(state, state.timed(step, "certified"), true);
  const finders::DriftStep view = pairs.view();
  Json begin;
  for (const finders::FinderEntry& entry : finders::finder_table()) {
    const std::unique_ptr<finders::Finder> finder = entry.make();
    if (finder->bytes_per_particle() == 0)
      continue;
    constexpr int rounds = 20;
    begin[entry.name] = median_of(repeats, [&] {
      const double start = cpu_seconds();
      for (int round = 0; round < rounds; ++round)
        finder->begin(view);
      return 1e9 * (cpu_seconds() - start) / (rounds * static_cast<double>(pairs.bodies.size()));
    });
  }
  finders::MotionSearch<UnrejectedMotion, finders::CertifiedSearch> search;
  const double alone = median_of(repeats, [&] { return ns_per_call(pairs, search, state.call_seconds); });
  return {{"begin_ns_per_particle", begin}, {"certified_search_alone_ns_per_call", alone}};
}

Json scan_check(const StudyState& state, double step) {
  const bench::PairSet pairs = first_pairs(state, state.timed(step, "certified"), true);
  const finders::DriftStep view = pairs.view();
  const std::unique_ptr<finders::Finder> certified = finders::make_finder("certified");
  certified->begin(view);
  std::uint64_t contacts = 0, only_scan = 0, only_certified = 0, other_time = 0;
  for (const finders::Query& query : pairs.queries) {
    const finders::FinderResult truth = certified->find(query);
    const bench::ScanResult scan = bench::dense_scan(pair_of(query, view), view.frequencies);
    contacts += truth.contact();
    only_scan += scan.contact && !truth.contact();
    only_certified += truth.contact() && !scan.contact;
    other_time += truth.contact() && scan.contact && std::fabs(truth.time - scan.time) > 1e-6 * (view.end - view.begin);
  }
  return {{"pairs", pairs.queries.size()},
          {"contacts", contacts},
          {"only_scan", only_scan},
          {"only_certified", only_certified},
          {"other_time", other_time}};
}

Json rejection(const StudyState& state, double step, int repeats) {
  const Scene plain = state.timed(step, "certified");
  const bench::PairSet all = first_pairs(state, plain, true), left = first_pairs(state, plain, false);
  const std::vector<std::string> finders = all_finders();
  std::vector<std::vector<double>> before(finders.size()), after(finders.size());
  for (int repeat = 0; repeat < repeats; ++repeat)
    for (std::size_t k = 0; k < finders.size(); ++k) {
      before[k].push_back(run_seconds(state, state.timed(step, finders[k]), true));
      after[k].push_back(run_seconds(state, state.timed(step, finders[k]), false));
    }
  Json times_before, times_after;
  for (std::size_t k = 0; k < finders.size(); ++k) {
    times_before[finders[k]] = statistics::median(before[k]);
    times_after[finders[k]] = statistics::median(after[k]);
  }
  const std::unique_ptr<finders::Finder> certified = finders::make_finder("certified");
  return {{"candidates", all.queries.size()},
          {"left", left.queries.size()},
          {"contacts", verdict_on(left, *certified).true_hits},
          {"cpu_s_every_candidate", times_before},
          {"cpu_s_after_rejection", times_after},
          {"ns_per_call_after_rejection", times_per_call(left, state, repeats)}};
}

Json local_times(const StudyState& state, double step, double moved_fraction, int repeats) {
  bench::PairSet pairs = first_pairs(state, state.timed(step, "certified"), true);
  double mean_radius = 0.0;
  for (const Body& body : pairs.bodies)
    mean_radius += body.radius / static_cast<double>(pairs.bodies.size());
  move_some(pairs, moved_fraction, 0.2 * mean_radius);
  Json missed, false_hits, late, evaluations;
  std::uint64_t true_hits = 0;
  for (const std::string& name : all_finders()) {
    const FinderVerdict verdict = verdict_on(pairs, *finders::make_finder(name));
    true_hits = verdict.true_hits;
    missed[name] = verdict.missed;
    false_hits[name] = verdict.false_hits;
    late[name] = verdict.late;
    evaluations[name] =
        static_cast<double>(verdict.counts.total().evaluations) / static_cast<double>(pairs.queries.size());
  }
  return {{"calls", pairs.queries.size()},
          {"true_hits", true_hits},
          {"missed", missed},
          {"false_hits", false_hits},
          {"late", late},
          {"evaluations_per_call", evaluations},
          {"ns_per_call", times_per_call(pairs, state, repeats)}};
}

Json drift_of_means(const PerturbedRing& ring, const std::string& path) {
  Json rows = Json::array();
  for (const DriftRow& row : perturbed_ring_drift(ring, path))
    rows.push_back({{"orbits", row.orbits},
                    {"mean_guiding_x_r", row.mean_guiding_x_r},
                    {"mean_vertical_r", row.mean_vertical_r},
                    {"collisions_per_particle", row.collisions_per_particle}});
  return {{"path", path}, {"step_orbits", ring.step_orbits}, {"rows", rows}};
}

} // namespace keeler::study
