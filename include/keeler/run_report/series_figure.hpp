// The series of a run as one figure in SVG: the plots of its page, with numbers on their axes, for a paper or a talk.
#pragma once

#include <nlohmann/json.hpp>

#include <filesystem>
#include <string>

namespace keeler {

struct SeriesFigureLook {
  int width = 1600; ///< pixels, where the viewer does not scale it
  bool light = false;
};

/// Each plot with its curves, the standard errors as bands, and the steady part shaded with its means. `plots` as
/// series_plots() makes them; at least one.
std::string series_svg(const nlohmann::ordered_json& plots, const std::string& title, const SeriesFigureLook& look);

/// The same of a run's folder. Throws IoError when it holds no run or no snapshot, UsageError when its series has
/// fewer than two rows.
std::string run_series_svg(const std::filesystem::path& folder, const SeriesFigureLook& look);

} // namespace keeler
