#include <keeler/batch/workers.hpp>

#include "child.hpp"

#include <keeler/core/format.hpp>
#include <keeler/core/stopwatch.hpp>
#include <keeler/files/files.hpp>
#include <keeler/runs/folder_lock.hpp>
#include <keeler/runs/run_stage.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <chrono>
#include <iterator>
#include <map>
#include <memory>
#include <optional>
#include <thread>
#include <utility>

namespace keeler::batch {
namespace {

namespace fs = std::filesystem;

constexpr std::chrono::milliseconds pause(20);
constexpr double refresh_interval_s = 1.0; // between reads of the files of runs
constexpr double stop_interval_s = 0.5;    // between repeated requests to stop at once

// Returns true if the child stopped on request, which is not a failure.
bool is_stop(const ChildEnd& end) {
  return end.code == static_cast<int>(ExitCode::stopped);
}

// Returns a path as an argument; one that begins with a dash must not look like an option.
std::string argument_of(const fs::path& path) {
  const std::string text = path.string();
  return text.starts_with('-') ? "./" + text : text;
}

// Returns the order of execution: first one run of each point, then the second of each, so that all points have a
// result early.
std::vector<std::size_t> seed_by_seed(std::span<const PlannedRun> runs) {
  std::map<std::size_t, std::size_t> earlier; // number of earlier runs of each point
  std::vector<std::pair<std::size_t, std::size_t>> ranked;
  for (std::size_t k = 0; k < runs.size(); ++k)
    ranked.emplace_back(earlier[runs[k].point]++, k);
  std::sort(ranked.begin(), ranked.end());
  std::vector<std::size_t> order;
  for (const auto& [rank, run] : ranked)
    order.push_back(run);
  return order;
}

class Workers {
public:
  Workers(std::span<const PlannedRun> runs, const RunFolders& folders, Claims& claims, const BatchSettings& settings,
          const runs::RunRequests& requests)
      : runs_(runs), order_(seed_by_seed(runs)), folders_(folders), claims_(claims), settings_(settings),
        requests_(requests), states_(runs.size()) {
    assert(settings.jobs > 0 && settings.threads_per_run > 0 && settings.progress && settings.notice);
    for (std::size_t k = 0; k < states_.size(); ++k)
      states_[k].previous_failure = failure_time(k);
    refresh();
    done_at_start_ = done();
  }

  void work() {
    while (true) {
      collect();
      if (requests_.stop)
        stop_children();
      else if (free_slots() && due(next_start_))
        start_some();
      if (due(next_refresh_))
        refresh();
      report();
      if (running() == 0 && (requests_.stop || nothing_to_wait_for_))
        return;
      std::this_thread::sleep_for(pause);
    }
  }

private:
  struct State {
    std::unique_ptr<Child> child;
    bool finished = false, failed = false;
    double completed = 0.0;                             // fraction of its steps
    std::optional<fs::file_time_type> previous_failure; // time of a failure recorded before this call
  };

  const PlannedRun& run(std::size_t k) const { return runs_[k]; }
  fs::path path(std::size_t k) const { return folders_.run(run(k).name); }

  std::optional<fs::file_time_type> failure_time(std::size_t k) const {
    std::error_code none;
    const fs::file_time_type time = fs::last_write_time(folders_.failure(run(k).name), none);
    return none ? std::nullopt : std::optional(time);
  }

  std::size_t running() const {
    return static_cast<std::size_t>(
        std::count_if(states_.begin(), states_.end(), [](const State& s) { return s.child != nullptr; }));
  }
  bool free_slots() const { return running() < settings_.jobs; }

  // Returns true if a time has come, and then moves it to one interval from now.
  bool due(double& time) {
    if (watch_.elapsed() < time)
      return false;
    time = watch_.elapsed() + refresh_interval_s;
    return true;
  }

  void start_some() {
    nothing_to_wait_for_ = true;
    for (const std::size_t k : order_)
      if (free_slots())
        try_start(k);
      else
        nothing_to_wait_for_ = false;
  }

  // Starts a run if it is free. A run claimed by another program is left to it; one that is locked without a claim (by
  // a process of a dead program, or by hand) will be free soon.
  void try_start(std::size_t k) {
    State& state = states_[k];
    if (state.child || state.finished || state.failed || !claims_.take(run(k).name))
      return;
    const runs::RunStage stage = runs::run_stage(path(k));
    state.finished = stage == runs::RunStage::finished;
    const std::optional<fs::file_time_type> failure = failure_time(k);
    state.failed = !state.finished && failure && failure != state.previous_failure;
    const bool held = runs::folder_is_held(path(k));
    if (held)
      nothing_to_wait_for_ = false;
    if (state.finished || state.failed || held)
      claims_.release(run(k).name);
    else
      start(k, stage);
  }

  void start(std::size_t k, runs::RunStage stage) {
    assert(!states_[k].child && stage != runs::RunStage::finished);
    nothing_to_wait_for_ = false;
    std::error_code ignored; // it may not exist
    fs::remove(folders_.failure(run(k).name), ignored);
    states_[k].previous_failure.reset();
    std::vector<std::string> words;
    if (stage == runs::RunStage::resumable) {
      words = {"resume", argument_of(path(k))};
    } else {
      const fs::path scene = folders_.scene(run(k).name);
      files::write_text(scene, run(k).scene.resolved);
      words = {"run", argument_of(scene), "-o", argument_of(path(k))};
      if (stage == runs::RunStage::begun)
        words.emplace_back("--force");
    }
    words.insert(words.end(), {"--threads", fmt::format("{}", settings_.threads_per_run)});
    states_[k].child = std::make_unique<Child>(words);
  }

  void collect() {
    for (std::size_t k = 0; k < states_.size(); ++k) {
      if (!states_[k].child)
        continue;
      if (const std::optional<ChildEnd> end = states_[k].child->end()) {
        states_[k].child.reset();
        record_end(k, *end);
        claims_.release(run(k).name);
        next_start_ = 0.0;
      }
    }
  }

  void record_end(std::size_t k, const ChildEnd& end) {
    assert(!states_[k].child);
    State& state = states_[k];
    state.finished = runs::run_stage(path(k)) == runs::RunStage::finished;
    if (state.finished || is_stop(end) || requests_.stop)
      return;
    state.failed = true;
    const std::string reason =
        end.message.empty() ? fmt::format("the run ended with exit code {}", end.code) : end.message;
    files::write_text(folders_.failure(run(k).name), reason + "\n");
    settings_.notice(fmt::format("the run {} failed: {}", run(k).name, reason));
  }

  // Asks the children to stop: once, and repeatedly after a request to give up.
  void stop_children() {
    if (asked_to_stop_ && !(requests_.give_up && watch_.elapsed() >= next_stop_))
      return;
    for (State& state : states_)
      if (state.child)
        state.child->stop();
    asked_to_stop_ = true;
    next_stop_ = watch_.elapsed() + stop_interval_s;
  }

  void refresh() {
    for (std::size_t k = 0; k < states_.size(); ++k)
      if (State& state = states_[k]; !state.finished) {
        state.finished = !state.child && runs::run_stage(path(k)) == runs::RunStage::finished;
        state.completed = static_cast<double>(runs::last_recorded_step(path(k))) /
                          static_cast<double>(std::max<std::int64_t>(1, run(k).scene.time.end_step));
      }
  }

  // Returns the work of a run, in particle steps.
  double weight(std::size_t k) const {
    return static_cast<double>(std::max<std::size_t>(1, run(k).scene.particles.count)) *
           static_cast<double>(std::max<std::int64_t>(1, run(k).scene.time.end_step));
  }
  double done() const {
    double sum = 0.0;
    for (std::size_t k = 0; k < states_.size(); ++k)
      sum += weight(k) * (states_[k].finished ? 1.0 : states_[k].completed);
    return sum;
  }

  void report() const {
    double all = 0.0;
    for (std::size_t k = 0; k < states_.size(); ++k)
      all += weight(k);
    const auto finished = std::count_if(states_.begin(), states_.end(), [](const State& s) { return s.finished; });
    const double now = done(), gained = now - done_at_start_, elapsed = watch_.elapsed();
    Progress progress;
    progress.fraction = finished == std::ssize(states_) ? 1.0 : std::min(now / all, 0.999);
    progress.elapsed_s = elapsed;
    progress.remaining_s = gained > 0.0 ? elapsed * (all - now) / gained : 0.0;
    progress.what = fmt::format("{} of {} done, {} running", finished, pluralize(states_.size(), "run"), running());
    settings_.progress(progress);
  }

  std::span<const PlannedRun> runs_;
  std::vector<std::size_t> order_;
  const RunFolders& folders_;
  Claims& claims_;
  const BatchSettings& settings_;
  const runs::RunRequests& requests_;
  std::vector<State> states_; // one per run
  double elapsed_ = 0.0;
  Stopwatch watch_{elapsed_};
  double next_start_ = 0.0, next_refresh_ = 0.0, next_stop_ = 0.0;
  double done_at_start_ = 0.0;
  bool nothing_to_wait_for_ = false, asked_to_stop_ = false;
};

} // namespace

void work_on(std::span<const PlannedRun> runs, const RunFolders& folders, Claims& claims, const BatchSettings& settings,
             const runs::RunRequests& requests) {
  Workers(runs, folders, claims, settings, requests).work();
}

} // namespace keeler::batch
