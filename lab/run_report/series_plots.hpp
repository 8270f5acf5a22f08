// The columns of a run's series as plots: bin means over consecutive rows, and means over the steady part with errors.
#pragma once

#include <keeler/io/series.hpp>
#include <keeler/quantities/quantity.hpp>
#include <keeler/runs/transport_report.hpp>

#include <nlohmann/json.hpp>

#include <optional>
#include <span>
#include <string>
#include <vector>

namespace keeler::run_report {

/// The mean over some consecutive rows.
struct SeriesPoint {
  double orbits, value;
  std::optional<double> error; ///< standard error; none for a single row
};

struct SeriesCurve {
  std::string name;
  std::vector<SeriesPoint> points;
  std::optional<Estimate> mean{}; ///< over the steady part
};

/// Curves of one unit. Not empty.
struct SeriesPlot {
  std::string title, unit;
  std::vector<SeriesCurve> curves;
};

struct SeriesPlots {
  std::optional<runs::Transport> steady; ///< the part that the means are of
  std::vector<SeriesPlot> plots;
};

/// The units in which velocities and viscosities are drawn.
struct DrawnUnits {
  quantities::UnitSystem system = quantities::UnitSystem::si;
  quantities::PatchUnits patch{}; ///< not used for SI
};

/// Returns the steady part of a run, over which plots give means; none if it was not detected.
std::optional<runs::Transport> steady_part(const runs::TransportReport& report);

/// Returns a plot for each quantity of the series, with the means over `steady`, if any, and its viscosities.
SeriesPlots series_plots(const io::SeriesTable& series, const runs::RingScale& scale,
                         const std::optional<runs::Transport>& steady, const DrawnUnits& units = {});

/// Returns a curve for each plain number of the records, over their `time_orbits`; components of vectors are numbers of
/// their own. Their titles are the names in JSON.
std::vector<SeriesPlot> number_curves(std::span<const quantities::Record> records, const DrawnUnits& units = {});

/// Returns the data that plots.js draws. `snapshots` are further quantities that may be an axis.
nlohmann::ordered_json json_of(const SeriesPlots& plots, std::span<const SeriesPlot> snapshots = {});

} // namespace keeler::run_report
