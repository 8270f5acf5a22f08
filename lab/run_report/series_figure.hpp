// The series of a run as one figure for a paper or a talk: the plots of its page, with numbers on their axes.
#pragma once

#include <keeler/plot/figure.hpp>

#include <filesystem>

namespace keeler::run_report {

/// Returns the figure of a run's folder: each plot with its curves, standard errors as bands, and the steady part
/// shaded, with its means. Throws IoError when it holds no run or no snapshot, UsageError when its series
/// has fewer than two rows.
plot::Figure run_series_figure(const std::filesystem::path& folder, bool light);

} // namespace keeler::run_report
