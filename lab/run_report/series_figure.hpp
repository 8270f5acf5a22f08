// The series of a run as one figure for a paper or a talk: the plots of its page, with numbers on their axes.
#pragma once

#include <keeler/plot/figure.hpp>

#include <nlohmann/json.hpp>

#include <filesystem>
#include <string>

namespace keeler::run_report {

/// Returns the figure: each plot with its curves, standard errors as bands, and the steady part shaded, with its means.
/// Precondition: `plots` is a result of series_plots() with at least one plot.
plot::Figure series_figure(const nlohmann::ordered_json& plots, const std::string& title, bool light);

/// Returns the figure of a run's folder. Throws IoError when it holds no run or no snapshot, UsageError when its series
/// has fewer than two rows.
plot::Figure run_series_figure(const std::filesystem::path& folder, bool light);

} // namespace keeler::run_report
