// Everything that a run writes. It works on copies and never touches the state.
#pragma once

#include "run_folder.hpp"

#include <keeler/io/provenance.hpp>
#include <keeler/io/series.hpp>
#include <keeler/simulation/simulation.hpp>

#include <nlohmann/json.hpp>

#include <optional>

namespace keeler {

/// What has been written so far; stored in the checkpoint, so that a resumed run counts on.
struct OutputCounters {
  std::int64_t snapshots = 0;
  std::int64_t checkpoints = 0;
  std::int64_t last_snapshot_step = -1; ///< -1: none yet

  void list_fields(FieldTable& table);
};

class Recorder {
public:
  /// `resumed`: the series is continued, else begun anew.
  Recorder(const RunFolder& folder, const Scene& scene, const std::vector<std::string>& arguments,
           OutputCounters counters, std::optional<std::int64_t> resumed_at);

  void snapshot(const Simulation& simulation);
  void checkpoint(const Simulation& simulation);
  void sample(const Simulation& simulation);
  void log(const std::string& event, const nlohmann::ordered_json& details);
  const OutputCounters& counters() const { return counters_; }
  const Provenance& provenance() const { return provenance_; }
  double seconds() const { return seconds_; } ///< wall time spent writing

private:
  RunFolder folder_;
  std::string scene_text_;
  Provenance provenance_;
  OutputCounters counters_;
  Series series_;
  double seconds_ = 0.0;
};

} // namespace keeler
