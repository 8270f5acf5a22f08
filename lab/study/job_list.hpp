// An interruptible list of measurements. Each job has a name and returns one JSON object, which is appended to a file
// at once, one line per job. A later list on this file carries out only the missing jobs.
#pragma once

#include <keeler/core/progress.hpp>

#include <nlohmann/json.hpp>

#include <atomic>
#include <filesystem>
#include <functional>
#include <map>
#include <string>
#include <vector>

namespace keeler::study {

using Json = nlohmann::ordered_json;

struct Job {
  std::string name;
  double weight; ///< expected duration in any unit, for the estimate of the time left; not negative
  std::function<Json()> work;
};

class JobList {
public:
  /// Reads the results in the file and drops an incomplete line of an interrupted program.
  explicit JobList(const std::filesystem::path& file);

  /// Carries out the jobs without a result, in order. Checks `stop` between jobs and returns false if it is set.
  /// Precondition: each job has its `work` and a weight ≥ 0.
  bool run(const std::vector<Job>& jobs, const std::function<void(const Progress&)>& progress,
           const std::atomic<bool>& stop);

  /// Returns the results by job name.
  const std::map<std::string, Json>& results() const { return results_; }

private:
  void keep(const std::string& name, const Json& result);

  std::filesystem::path file_;
  std::map<std::string, Json> results_;
};

} // namespace keeler::study
