#include "rows.hpp"

#include "unit/files/disk.hpp"

#include <keeler/runs/run.hpp>
#include <keeler/runs/stored_patches.hpp>
#include <keeler/scene/load.hpp>
#include <keeler/statistics/scatter.hpp>
#include <keeler/statistics/time_series.hpp>

#include <fmt/format.h>

namespace keeler::validation {

Ran run_example(const std::string& example, const std::vector<std::string>& overrides) {
  const test::TemporaryFolder work;
  const std::string file = fmt::format("examples/{}{}", example, example.ends_with(".toml") ? "" : "/scene.toml");
  runs::RunRequests requests;
  runs::RunOptions options;
  options.folder = work / "run";
  start_run(load_scene(std::string(KEELER_SOURCE_DIR) + "/" + file, overrides), options, requests);
  Ran ran;
  ran.command = fmt::format("keeler run {}", file);
  for (const std::string& key : overrides)
    ran.command += fmt::format(" --set '{}'", key);
  ran.series = io::read_series(work / "run" / "series.csv");
  if (std::filesystem::exists(work / "run" / "moonlets.csv"))
    ran.moonlets = io::read_series(work / "run" / "moonlets.csv");
  ran.snapshots = runs::load_patches(work / "run", 1e9).patches;
  return ran;
}

Estimate mean_since(const Ran& ran, const char* column, double orbit) {
  const std::vector<double>&values = ran.series.of(column), &orbits = ran.series.of("time_orbits");
  std::vector<double> later;
  for (std::size_t k = 0; k < values.size(); ++k)
    if (orbits[k] >= orbit)
      later.push_back(values[k]);
  return statistics::block_mean(later);
}

Estimate mean_of(const std::vector<double>& values) {
  const statistics::Scatter scatter = statistics::scatter_of(values);
  return {scatter.mean, scatter.mean_error()};
}

runs::Transport transport_since(const Ran& ran, double orbit) {
  return transport(ran.series,
                   runs::RingScale::of(ran.snapshots.back(), false, ran.series.find("kick_work_j")->back() != 0.0),
                   {.since = orbit, .until = {}});
}

} // namespace keeler::validation
