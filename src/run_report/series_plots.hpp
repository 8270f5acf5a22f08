// The columns of a run's series as plots: means of rows that follow each other, and of the steady part with their
// errors.
#pragma once

#include <keeler/io/series.hpp>
#include <keeler/runs/transport_report.hpp>

#include <nlohmann/json.hpp>

#include <optional>

namespace keeler {

/// The part of a run whose means a plot tells: none where it was not found.
std::optional<Transport> steady_part(const TransportReport& report);

/// What plots.js draws: a plot for each quantity, none left out. `steady` is the part whose means are told, and has
/// those of the viscosities; none: no means.
nlohmann::ordered_json series_plots(const SeriesTable& series, const RingScale& scale,
                                    const std::optional<Transport>& steady);

} // namespace keeler
