#include <keeler/study/gravity/study.hpp>

#include "report.hpp"
#include "runs.hpp"
#include "study_folder.hpp"

#include <keeler/bench/gravity.hpp>
#include <keeler/core/error.hpp>
#include <keeler/core/threads.hpp>
#include <keeler/runs/folder_lock.hpp>

#include <fmt/format.h>

#include <cmath>
#include <map>

namespace keeler {
namespace {

constexpr const char* bench_job = "bench";

// Returns the options that identify a study. They include solvers and settings: a folder with others cannot continue.
Json options_of(const GravityStudySettings& settings) {
  Json texts = Json::array();
  for (const GravityChoice& choice : gravity_choices(true))
    texts.push_back(choice.solver + " " + choice.text);
  Json runs = Json::array();
  for (const GravityChoice& choice : gravity_run_choices())
    runs.push_back(run_label(choice));
  return {{"study", "gravity"},
          {"count", settings.count},
          {"repeats", settings.repeats},
          {"orbits", settings.orbits},
          {"seeds", settings.seeds},
          {"settings", texts},
          {"runs", runs}};
}

// Measures errors and times of all settings on one thread, as bench gravity does.
Json measure_forces(const GravityStudySettings& settings) {
  GravityBenchSettings bench;
  bench.count = settings.count;
  bench.repeats = settings.repeats;
  bench.dense = true;
  const int threads_before = threads();
  set_threads(1);
  const GravityBench measured = bench_gravity(bench);
  set_threads(threads_before);
  Json rows = Json::array();
  for (const GravityBenchRow& row : measured.rows) {
    Json line = {{"solver", row.choice.solver},
                 {"settings", row.choice.text},
                 {"parameter", row.choice.parameter},
                 {"value", row.choice.value}};
    for (const auto& [name, value] : row.numbers())
      line[name] = value;
    rows.push_back(line);
  }
  return {{"rows", rows},
          {"count", measured.count},
          {"box_m", {measured.size_x_m, measured.size_y_m}},
          {"offset_m", measured.offset_m},
          {"sample", measured.sample},
          {"edge_sample", measured.edge_sample},
          {"edge_width_m", measured.edge_width_m},
          {"repeats", settings.repeats}};
}

// Estimates the duration of measure_forces() (s): the state, the exact forces, and the timing.
double expected_cost(const GravityStudySettings& settings) {
  const auto count = static_cast<double>(settings.count);
  return 15.0 + 1e-4 * count +
         2e-6 * count * (1.0 + settings.repeats) * static_cast<double>(gravity_choices(true).size());
}

std::string run_job(const GravityChoice& choice, int seed) {
  return fmt::format("run/{}/{}", run_label(choice), seed);
}

// Common states by seed. The first run of a seed makes its state.
using Starts = std::map<int, RunStart>;

std::vector<Job> jobs_of(const GravityStudySettings& settings, Starts& starts) {
  std::vector<Job> jobs = {{bench_job, expected_cost(settings), [&settings] { return measure_forces(settings); }}};
  const double orbits = settings.orbits;
  for (int seed = 1; seed <= settings.seeds; ++seed)
    for (const GravityChoice& choice : gravity_run_choices())
      jobs.push_back({run_job(choice, seed), gravity_run_cost(choice, orbits), [choice, seed, orbits, &starts] {
                        if (!starts.contains(seed))
                          starts.emplace(seed, gravity_run_start(static_cast<std::uint64_t>(seed), orbits));
                        return gravity_run(starts.at(seed), choice, orbits);
                      }});
  return jobs;
}

void announce(const std::vector<Job>& jobs, const JobList& list, const std::function<void(const std::string&)>& say) {
  double cost = 0.0;
  std::size_t left = 0;
  for (const Job& job : jobs)
    if (!list.results().contains(job.name)) {
      cost += job.weight;
      ++left;
    }
  if (left > 0)
    say(fmt::format("{} of {} measurements to do, roughly {:.0f} minutes", left, jobs.size(), std::ceil(cost / 60.0)));
}

} // namespace

bool study_gravity(const GravityStudySettings& settings, const std::atomic<bool>& stop) {
  if (settings.seeds < 2)
    throw UsageError("a study with one seed cannot measure the scatter; --seeds takes 2 or more");
  const std::map<std::string, std::string> made = study_provenance(settings.arguments);
  const Json begun = open_study_folder(settings.folder, options_of(settings), made);
  const FolderLock lock(settings.folder);
  Starts starts;
  const std::vector<Job> jobs = jobs_of(settings, starts);
  JobList list(settings.folder / "measurements.jsonl");
  announce(jobs, list, settings.notice);
  if (!list.run(jobs, settings.progress, stop))
    return false;

  GravityStudyData data{settings.folder, list.results().at(bench_job), {}, settings.orbits, made};
  for (const GravityChoice& choice : gravity_run_choices())
    for (int seed = 1; seed <= settings.seeds; ++seed)
      data.runs[run_label(choice)].push_back(list.results().at(run_job(choice, seed)));
  for (auto& [key, value] : data.made)
    value = begun.value(key, value);
  write_gravity_tables(data);
  write_gravity_report(data, false);
  return true;
}

} // namespace keeler
