#include <keeler/study/finders/study.hpp>

#include "measurements.hpp"
#include "perturbed_ring/perturbed_ring.hpp"
#include "report.hpp"
#include "study_folder.hpp"

#include <keeler/core/error.hpp>
#include <keeler/core/interrupt.hpp>
#include <keeler/core/threads.hpp>
#include <keeler/runs/folder_lock.hpp>

#include <fmt/format.h>

#include <cassert>
#include <cmath>
#include <optional>

namespace keeler::study {
namespace {

namespace fs = std::filesystem;

struct Plan {
  std::size_t count;
  std::vector<double> steps; // orbits; a whole number of each makes up study_orbits
  int repeats;
  double drift_orbits;
  double call_seconds;
  std::vector<double> moved_fractions = {0.0, 0.25, 0.5, 0.75, 1.0};
};

Plan plan_of(const FinderStudySettings& settings) {
  if (settings.quick)
    return {std::min<std::size_t>(settings.count, 3000), {1e-3, 1.0 / 300.0, 1e-2}, 2, 2.0, 0.005};
  return {settings.count, {1e-4, 1.0 / 3000.0, 1e-3, 1.0 / 300.0, 1e-2}, 6, 100.0, 0.02};
}

Json options_of(const Plan& plan) {
  return {{"study", "finders"},
          {"count", plan.count},
          {"steps_orbits", plan.steps},
          {"repeats", plan.repeats},
          {"finders", all_finders()}};
}

// Throws UsageError when timed runs are missing and the others were measured with another build or on another machine:
// such times are not comparable. Other measurements may come from a newer program: each is compared only with itself,
// or is not a time.
void require_same_build(const Json& begun, const std::map<std::string, std::string>& made, const std::vector<Job>& jobs,
                        const JobList& list, const fs::path& folder) {
  std::size_t missing_runs = 0, runs = 0;
  for (const Job& job : jobs)
    if (job.name.starts_with("run/")) {
      ++runs;
      missing_runs += !list.results().contains(job.name);
    }
  if (missing_runs == 0 || missing_runs == runs)
    return;
  for (const char* key : {"commit", "host", "compiler", "flags"})
    if (begun.value(key, "") != made.at(key))
      throw UsageError(fmt::format("the timed runs of '{}' were started with another {} ({}), and such times are not "
                                   "comparable; continue with that {}, or name another folder",
                                   folder.string(), key, begun.value(key, ""), key));
}

std::size_t missing(const std::vector<Job>& jobs, const JobList& list) {
  std::size_t count = 0;
  for (const Job& job : jobs)
    count += !list.results().contains(job.name);
  return count;
}

// Estimates the time of a run (ns) with every candidate passed to the finder: fits to the means over the finders in
// docs/paper-reproduction.md.
double expected_cost(const StudyState& state, double step) {
  struct Cost {
    double base, linear, square; // ns per particle and step: base (1 + linear h + square h²)
  };
  assert(step > 0.0);
  const bool power = state.name.starts_with("power");
  const Cost c = state.name.ends_with("early") ? Cost{power ? 1500.0 : 500.0, 150.0, 4e4}
                                               : Cost{power ? 1700.0 : 1100.0, 300.0, power ? 2.6e5 : 6e5};
  return static_cast<double>(state.patch.size()) * study_orbits / step * c.base *
         (1.0 + c.linear * step + c.square * step * step);
}

class Jobs {
public:
  Jobs(const std::vector<StudyState>& states, const Plan& plan) : states_(states), plan_(plan) {}

  std::vector<Job> all() {
    for (const StudyState& state : states_)
      for (const double step : plan_.steps)
        add_truth(state, step);
    for (const StudyState& state : states_) {
      add_finder_fractions(state);
      add_rejection(state);
    }
    for (const double step : {1e-3, 1e-2})
      for (const double fraction : plan_.moved_fractions)
        add_local_times(step, fraction);
    add_drifts();
    for (int repeat = 0; repeat < plan_.repeats; ++repeat)
      for (const StudyState& state : states_)
        for (const double step : plan_.steps)
          add_runs(state, step, repeat);
    return std::move(jobs_);
  }

private:
  void add(std::string name, double weight, std::function<Json()> work) {
    jobs_.push_back({std::move(name), weight, std::move(work)});
  }

  void add_truth(const StudyState& state, double step) {
    const double cost = expected_cost(state, step);
    add(job_name("scan", state.name, step), 3e9, [&state, step] { return scan_check(state, step); });
    for (const std::string& finder : all_finders())
      add(job_name("audit", state.name, step, finder), 1.3 * cost,
          [&state, step, finder] { return audited_run(state, step, finder); });
  }

  void add_rejection(const StudyState& state) {
    const int repeats = std::min(plan_.repeats, 3);
    add(job_name("rejection", state.name, 1e-3), 20.0 * repeats * expected_cost(state, 1e-3),
        [&state, repeats] { return rejection(state, 1e-3, repeats); });
  }

  void add_finder_fractions(const StudyState& state) {
    const int repeats = std::min(plan_.repeats, 3);
    add(job_name("details", state.name, 1e-3), 1e9, [&state, repeats] { return call_details(state, 1e-3, repeats); });
    for (const std::string& finder : paper_finders)
      add(job_name("share", state.name, 1e-3, finder), 2.0 * repeats * expected_cost(state, 1e-3),
          [&state, finder, repeats] { return finder_fraction(state, 1e-3, finder, repeats); });
  }

  void add_local_times(double step, double moved_fraction) {
    const StudyState& state = states_.front();
    const int repeats = std::min(plan_.repeats, 5);
    add(fmt::format("local/{}/{:.6g}/{}", state.name, step, moved_fraction), 2e9,
        [&state, step, moved_fraction, repeats] { return local_times(state, step, moved_fraction, repeats); });
  }

  // Adds the runs of Figure 1. The finders need one step only: at any step their drift is rounding.
  void add_drifts() {
    for (const double step : {1e-3, 3e-3, 1e-2})
      for (const char* path : {straight_path, control_path})
        add_drift(path, step);
    for (const std::string& finder : all_finders())
      add_drift(finder, 1e-2);
  }

  void add_drift(const std::string& path, double step) {
    PerturbedRing ring;
    ring.step_orbits = step;
    ring.orbits = plan_.drift_orbits;
    add(fmt::format("drift/{}/{:.6g}", path, step), ring.orbits / step * 1e3 * 400.0,
        [ring, path] { return drift_of_means(ring, path); });
  }

  // Adds the timed runs, in another order in each repeat, so that a slow change of the machine's speed favours no
  // finder.
  void add_runs(const StudyState& state, double step, int repeat) {
    const std::vector<std::string> finders = all_finders();
    const std::size_t count = finders.size();
    for (std::size_t k = 0; k < count; ++k) {
      const std::size_t turned = (k + static_cast<std::size_t>(repeat) * 5) % count;
      const std::string& finder = finders[repeat % 2 ? count - 1 - turned : turned];
      add(job_name("run", state.name, step, finder, repeat), expected_cost(state, step),
          [&state, step, finder] { return timed_run(state, step, finder); });
    }
  }

  const std::vector<StudyState>& states_;
  const Plan& plan_;
  std::vector<Job> jobs_;
};

void announce(const std::vector<Job>& jobs, std::size_t left, const std::function<void(const std::string&)>& say) {
  double cost = 0.0;
  for (const Job& job : jobs)
    cost += job.weight;
  say(fmt::format("{} measurements on one thread, {} of them done; all take roughly {:.0f} minutes", jobs.size(),
                  jobs.size() - left, std::ceil(cost / 60e9)));
}

// Returns the states, or nothing after a stop. A stop interrupts the evolution at once: a partial state is useless.
std::optional<std::vector<StudyState>> states_unless_stopped(const FinderStudySettings& settings, const Plan& plan,
                                                             const std::atomic<bool>& stop) {
  try {
    const Interruptible by_stop(stop);
    std::vector<StudyState> states = study_states(settings.folder / "states", plan.count, settings.notice);
    for (StudyState& state : states)
      state.call_seconds = plan.call_seconds;
    return states;
  } catch (const Interrupted&) {
    return std::nullopt;
  }
}

} // namespace

std::string job_name(const std::string& kind, const std::string& state, double step, const std::string& finder,
                     int repeat) {
  std::string name = fmt::format("{}/{}/{:.6g}", kind, state, step);
  if (!finder.empty())
    name += "/" + finder;
  if (repeat >= 0)
    name += fmt::format("/{}", repeat);
  return name;
}

bool study_finders(const FinderStudySettings& settings, const std::atomic<bool>& stop) {
  constexpr std::size_t min_particles = 100, max_particles = 10000000;
  if (settings.count < min_particles || settings.count > max_particles)
    throw UsageError(fmt::format("a study of {} particles is not possible; --count takes {} to {}", settings.count,
                                 min_particles, max_particles));
  const Plan plan = plan_of(settings);
  const std::map<std::string, std::string> made = study_provenance(settings.arguments);
  const Json begun = open_study_folder(settings.folder, options_of(plan), made);
  const runs::FolderLock lock(settings.folder);
  const std::optional<std::vector<StudyState>> states = states_unless_stopped(settings, plan, stop);
  if (!states)
    return false;
  const std::vector<Job> jobs = Jobs(*states, plan).all();
  JobList list(settings.folder / "measurements.jsonl");
  const std::size_t left = missing(jobs, list);
  require_same_build(begun, made, jobs, list, settings.folder);
  if (left > 0)
    announce(jobs, left, settings.notice);

  const int threads_before = threads();
  set_threads(1); // the measurements are timed
  const bool finished = list.run(jobs, settings.progress, stop);
  set_threads(threads_before);
  if (!finished)
    return false;

  FinderStudyData data{settings.folder,      *states,        plan.steps, 1e-3, plan.repeats,
                       plan.moved_fractions, list.results(), made};
  for (auto& [key, value] : data.made)
    value = begun.value(key, value);
  write_finder_tables(data);
  const auto draw = [&] {
    draw_finder_figures(data);
    return true;
  };
  draw_and_report(draw, [&](bool drawn) { write_finder_report(data, drawn); });
  return true;
}

} // namespace keeler::study
