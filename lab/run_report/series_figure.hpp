// The series of a run as one SVG figure for a paper or a talk: the plots of its page, with numbers on their axes.
#pragma once

#include <nlohmann/json.hpp>

#include <filesystem>
#include <string>

namespace keeler {

struct SeriesFigureLook {
  int width = 1600; ///< pixels, if the viewer does not scale the figure
  bool light = false;
};

/// Returns the figure: each plot with its curves, standard errors as bands, and the steady part shaded, with its means.
/// Precondition: `plots` is a result of series_plots() with at least one plot.
std::string series_svg(const nlohmann::ordered_json& plots, const std::string& title, const SeriesFigureLook& look);

/// Returns the figure of a run's folder. Throws IoError when it holds no run or no snapshot, UsageError when its series
/// has fewer than two rows.
std::string run_series_svg(const std::filesystem::path& folder, const SeriesFigureLook& look);

} // namespace keeler
