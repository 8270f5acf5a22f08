// The columns of a run's series as plots: bin means over consecutive rows, and means over the steady part with errors.
#pragma once

#include <keeler/io/series.hpp>
#include <keeler/runs/transport_report.hpp>

#include <nlohmann/json.hpp>

#include <optional>

namespace keeler::run_report {

/// Returns the steady part of a run, over which plots give means; none if it was not detected.
std::optional<runs::Transport> steady_part(const runs::TransportReport& report);

/// Returns the data that plots.js draws: a plot for each quantity of the series, with the means over `steady`, if any,
/// and its viscosities.
nlohmann::ordered_json series_plots(const io::SeriesTable& series, const runs::RingScale& scale,
                                    const std::optional<runs::Transport>& steady);

} // namespace keeler::run_report
