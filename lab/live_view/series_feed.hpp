// The growing series of a run, as the data that plots.js draws: from series.csv of its folder, or from rows that are
// sampled from a simulation in memory while a page asks.
#pragma once

#include "throttle.hpp"

#include <keeler/io/series.hpp>
#include <keeler/runs/transport.hpp>
#include <keeler/simulation/simulation.hpp>

#include <filesystem>
#include <memory>
#include <optional>
#include <string>

namespace keeler::live_view {

class SeriesFeed {
public:
  /// `folder` is that of a run; empty: rows come by sample().
  explicit SeriesFeed(std::filesystem::path folder) : folder_(std::move(folder)) {}

  bool is_sampled() const { return folder_.empty(); }
  bool sample_due() const { return throttle_.due(); }
  /// Adds a row, unless there is one of this step. Precondition: is_sampled().
  void sample(const Simulation& simulation, const Scene& scene);

  /// Reads the folder if it is time. There are no plots without the scale of the series.
  void refresh(const std::optional<runs::RingScale>& scale);
  /// Returns the JSON of the plots, which is updated at times.
  std::shared_ptr<const std::string> text();

private:
  static constexpr double fraction = 0.0015; // of the time

  std::filesystem::path folder_;
  io::SeriesTable table_;
  std::optional<runs::RingScale> scale_;
  Throttle throttle_{0.5, fraction}, writing_{1.0, fraction};
  std::size_t written_rows_ = 0;
  std::shared_ptr<const std::string> text_ =
      std::make_shared<std::string>(R"({"steady":null,"plots":[],"snapshots":[]})");
};

} // namespace keeler::live_view
