// Figures of numbers: panels with axes, curves with errors, shaded parts and legends, as PNG, SVG or PDF.
#pragma once

#include <keeler/plot/axes.hpp>

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace keeler::plot {

struct PlotPoint {
  double x = 0.0, y = 0.0;
  double error = 0.0;     ///< of y; 0 if it is not known
  std::string label = {}; ///< beside the point
};

struct PlotCurve {
  std::string name = {}; ///< in the legend; empty: it has no entry
  std::vector<PlotPoint> points = {};
  std::optional<std::size_t> colour = 0; ///< number of a colour and a shape of marks; none: grey
  bool line = true, dashed = false, marks = false;
  bool band = false;    ///< errors as a band instead of bars
  bool columns = false; ///< columns from the lower end of y, 0.9 wide, instead of a curve
};

struct Panel {
  std::string title = {};
  PlotAxis x = {}, y = {}; ///< an empty range is chosen by the points
  std::vector<PlotCurve> curves = {};
  std::optional<AxisRange> shaded = {}; ///< part of x
};

struct Figure {
  std::string title = {}, note = {}; ///< the note is on the right of the title
  std::vector<Panel> panels = {};
  std::size_t columns = 1;     ///< of panels
  int width = 720;             ///< units
  double panel_height = 330.0; ///< of the frames, units
  PlotLook look = {};
};

/// Returns the bytes of a file; `scale` is pixels (PDF: points) a unit. Points that are not finite, or not positive on
/// a logarithmic axis, are left out. Precondition: there is a panel.
std::vector<std::byte> figure_bytes(const Figure& figure, PageFormat format, double scale = 1.0);

/// Writes NAME.svg, and NAME.png with two pixels a unit. Throws IoError.
void save_figures(const Figure& figure, const std::filesystem::path& folder, const std::string& name);

} // namespace keeler::plot
