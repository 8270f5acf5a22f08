// A long list of measurements that can be interrupted: each job has a name and gives one JSON object, which is kept as
// a line of a file as soon as it is known. Started again on the same file, the list does only what is missing.
#pragma once

#include <keeler/core/progress.hpp>

#include <nlohmann/json.hpp>

#include <atomic>
#include <filesystem>
#include <functional>
#include <map>
#include <string>
#include <vector>

namespace keeler {

using Json = nlohmann::ordered_json;

struct Job {
  std::string name;
  double weight; ///< expected duration, in any unit: for the time left
  std::function<Json()> work;
};

class JobList {
public:
  /// Reads the results that the file holds; a line that an interruption cut short is dropped.
  explicit JobList(const std::filesystem::path& file);

  /// Does the jobs that have no result yet, in order; returns false when `stop` was set, which is obeyed between jobs.
  bool run(const std::vector<Job>& jobs, const std::function<void(const Progress&)>& progress,
           const std::atomic<bool>& stop);

  /// By name of the job.
  const std::map<std::string, Json>& results() const { return results_; }

private:
  void keep(const std::string& name, const Json& result);

  std::filesystem::path file_;
  std::map<std::string, Json> results_;
};

} // namespace keeler
