#include <keeler/runs/run.hpp>

#include "scenes.hpp"
#include "unit/files/disk.hpp"

#include <keeler/core/error.hpp>
#include <keeler/io/checkpoint_folder.hpp>

#include <doctest/doctest.h>

#include <chrono>
#include <map>
#include <sstream>
#include <thread>

namespace run_test {

using namespace keeler;
using namespace keeler::runs;
using namespace keeler::test;

namespace {

RunResult run(const std::filesystem::path& folder, const std::vector<std::string>& overrides) {
  RunRequests requests;
  RunOptions options;
  options.folder = folder;
  return start_run(small_scene(overrides), options, requests);
}

// The first column of series.csv.
std::vector<int> steps_in(const std::filesystem::path& series) {
  std::istringstream text(files::read_text(series));
  std::vector<int> steps;
  std::string line;
  std::getline(text, line); // the header
  while (std::getline(text, line))
    steps.push_back(std::stoi(line));
  return steps;
}

struct FileState {
  std::filesystem::file_time_type time;
  std::string content;
  bool operator==(const FileState&) const = default;
};

std::map<std::string, FileState> files_in(const std::filesystem::path& folder) {
  std::map<std::string, FileState> files;
  for (const auto& entry : std::filesystem::directory_iterator(folder))
    files[entry.path().filename().string()] = {entry.last_write_time(), files::read_text(entry.path())};
  return files;
}

} // namespace

TEST_CASE("rows of the series stand at the steps that the scene asks for") {
  const TemporaryFolder work;
  run(work / "a", {"time.end=0.1", "output.series_every=0.03"});
  CHECK(steps_in(work / "a" / "series.csv") == std::vector<int>{0, 6, 12, 18});
  run(work / "b", {"time.end=0.1", "output.series_every=0.03", "gravity.kick_every=4"}); // 1.5 kicks: rounded up
  CHECK(steps_in(work / "b" / "series.csv") == std::vector<int>{0, 8, 16});
  run(work / "c", {"time.end=0.1", "output.series_every=0"});
  CHECK(steps_in(work / "c" / "series.csv") == std::vector<int>{0});
}

TEST_CASE("checkpoints come by the step and by the clock, and the clock changes no state") {
  const TemporaryFolder work;
  const auto number = [](const std::filesystem::path& folder) {
    return io::list_checkpoints(folder).front().filename().string();
  };
  const std::string hash = run(work / "none", {"time.end=0.1", "output.checkpoint_every_minutes=0"}).state_hash;
  CHECK(number(work / "none") == "checkpoint_000000.h5"); // the one at the end
  run(work / "step", {"time.end=0.1", "output.checkpoint_every_minutes=0", "output.checkpoint_every=0.04"});
  CHECK(number(work / "step") == "checkpoint_000002.h5"); // at 0.04, 0.08 and the end
  run(work / "default", {"time.end=0.1"});
  CHECK(number(work / "default") == "checkpoint_000000.h5"); // ten minutes have not passed
  // so short that every kick is later: 20 steps of which every fourth ends with a kick
  const std::vector<std::string> clocked = {"time.end=0.1", "output.checkpoint_every_minutes=1e-12"};
  CHECK(run(work / "clock", clocked).state_hash == hash);
  CHECK(number(work / "clock") == "checkpoint_000019.h5");
  run(work / "kicks", {"time.end=0.1", "output.checkpoint_every_minutes=1e-12", "gravity.kick_every=4"});
  CHECK(number(work / "kicks") == "checkpoint_000004.h5");
}

TEST_CASE("an observer is called where kicks meet, and what it waits for is no part of a step") {
  const TemporaryFolder work;
  RunRequests requests;
  RunOptions options;
  options.folder = work / "observed";
  std::vector<std::int64_t> steps;
  options.observe = [&](const Simulation& simulation) {
    steps.push_back(simulation.state().step);
    std::this_thread::sleep_for(std::chrono::milliseconds(150));
  };
  double remaining_s = 0.0;
  options.progress = [&](const RunProgress& progress) {
    if (progress.step == 10)
      remaining_s = progress.remaining_s;
  };
  const Scene scene = small_scene({"time.end=0.1", "gravity.kick_every=4"});
  const RunResult observed = start_run(scene, options, requests);
  CHECK(steps == std::vector<std::int64_t>{0, 4, 8, 12, 16, 20});
  CHECK(remaining_s < 0.5 * 0.15 * 10.0 / 4.0); // the waits alone would take twice that
  CHECK(observed.state_hash == run(work / "alone", {"time.end=0.1", "gravity.kick_every=4"}).state_hash);
}

TEST_CASE("a finished run is left as it is, with a notice") {
  const TemporaryFolder work;
  const RunResult first = run(work / "run", {"time.end=0.1"});
  const auto before = files_in(work / "run");
  RunRequests requests;
  RunOptions options;
  options.folder = work / "run";
  std::string said;
  options.notice = [&](const std::string& line) { said += line; };
  const RunResult again = resume_run(options, requests);
  CHECK(again.finished);
  CHECK(again.step == first.step);
  CHECK(again.state_hash == first.state_hash);
  CHECK(said.find("is finished, nothing was changed") != said.npos);
  CHECK(files_in(work / "run") == before);

  options.until_orbits = 0.2;
  CHECK(resume_run(options, requests).state_hash == run(work / "whole", {"time.end=0.2"}).state_hash);
}

TEST_CASE("a run that was ended between its last checkpoint and its summary is brought to its end") {
  const TemporaryFolder work;
  const RunResult first = run(work / "run", {"time.end=0.1"});
  std::filesystem::remove(work / "run" / "summary.json");
  RunRequests requests;
  RunOptions options;
  options.folder = work / "run";
  CHECK(resume_run(options, requests).state_hash == first.state_hash);
  CHECK(std::filesystem::exists(work / "run" / "summary.json"));
}

TEST_CASE("a full disk: the message says how to go on, and going on leads to the same state") {
  const TemporaryFolder work;
  const std::string hash = run(work / "whole", {"time.end=0.2"}).state_hash;
  run(work / "run", {"time.end=0.1"});
  RunRequests requests;
  RunOptions options;
  options.folder = work / "run";
  options.until_orbits = 0.2;
  {
    const SmallDisk disk(20000); // less than a checkpoint
    CHECK_THROWS_WITH_AS(
        resume_run(options, requests),
        doctest::Contains(("continue with \"keeler resume " + options.folder.string() + " --until 0.2\"").c_str()),
        DiskFullError);
    CHECK_THROWS_WITH_AS(run(work / "new", {}), doctest::Contains("start again with --force (there is no checkpoint"),
                         DiskFullError);
  }
  CHECK(resume_run(options, requests).state_hash == hash);
}

} // namespace run_test
