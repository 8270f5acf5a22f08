#include <keeler/run_report/series_figure.hpp>

#include "series_plots.hpp"

#include <keeler/core/error.hpp>
#include <keeler/core/format.hpp>
#include <keeler/report/html.hpp>
#include <keeler/runs/run_view.hpp>
#include <keeler/runs/stored_patches.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <limits>
#include <vector>

namespace keeler {
namespace {

using Json = nlohmann::ordered_json;

struct Ink {
  const char *page, *frame, *text, *faint, *steady;
  std::array<const char*, 4> curves;
};
constexpr Ink dark_ink{"#0c0d11", "#4a4c52", "#ede8db",
                       "#a8a6a2", "#20242d", {"#73ccf2", "#f2a65a", "#8fd694", "#d4a5e8"}};
constexpr Ink light_ink{"#ffffff", "#9a9a9e", "#1a1a1f",
                        "#5c5c61", "#eceff4", {"#2166ac", "#b2182b", "#1b7837", "#762a83"}};

// Lengths, in units of the drawing of width 1200.
constexpr double drawing_width = 1200, head = 70, panel_height = 316, panel_width = drawing_width / 2;
constexpr double frame_left = 96, frame_right = 26, frame_top = 78, frame_bottom = 44;

struct Range {
  double low = std::numeric_limits<double>::infinity(), high = -std::numeric_limits<double>::infinity();

  void include(double value) {
    low = std::min(low, value);
    high = std::max(high, value);
  }
  // Returns the range with a margin above and below: 6 % of it, or a tenth of a constant value.
  Range widened() const {
    const double span = high - low, rounding = 1e-9 * std::max(std::fabs(low), std::fabs(high));
    const double margin = span > rounding ? 0.06 * span : std::max(0.1 * std::fabs(high), 1e-12);
    // the axis of a non-negative quantity begins at 0 if that is near
    return {low >= 0.0 && low < 0.5 * high ? 0.0 : low - margin, high + margin};
  }
};

// Returns 1, 2 or 5 times a power of ten, for three to eight steps in the range.
double tick_step(const Range& range) {
  assert(range.high > range.low);
  const double span = range.high - range.low, power = std::pow(10.0, std::floor(std::log10(span / 3.0)));
  for (const double step : {5.0, 2.0})
    if (span / (step * power) >= 3.0)
      return step * power;
  return power;
}

std::string tick_label(double value, double step) {
  return format_number(std::fabs(value) < 1e-6 * step ? 0.0 : value, 4);
}

std::string text_at(double x, double y, const char* colour, double size, const char* anchor, const std::string& words) {
  return fmt::format("<text x=\"{:.1f}\" y=\"{:.1f}\" fill=\"{}\" font-size=\"{}\" text-anchor=\"{}\">{}</text>\n", x,
                     y, colour, size, anchor, html_text(words));
}

// Returns "0.0017 ± 0.0001", or an empty string if there is no mean.
std::string mean_of(const Json& curve) {
  const Json& mean = curve["mean"];
  if (!mean.is_object() || !mean["value"].is_number())
    return "";
  return format_number(mean["value"], 3) + (mean["error"].is_number() ? " ± " + format_number(mean["error"], 2) : "");
}

class Panel {
public:
  Panel(const Json& plot, const Json& steady, const Ink& ink, double left, double top)
      : plot_(plot), steady_(steady), ink_(ink), left_(left + frame_left), top_(top + frame_top) {
    for (const Json& curve : plot["curves"])
      for (const Json& point : curve["points"]) {
        times_.include(point[0]);
        values_.include(point[1]);
      }
    if (!(times_.high > times_.low))
      times_ = times_.widened();
    values_ = values_.widened();
  }

  std::string svg() const {
    const auto title = plot_["title"].get<std::string>(), unit = plot_["unit"].get<std::string>();
    std::string all = text_at(left_, top_ - 50, ink_.text, 17, "start", unit.empty() ? title : title + ", " + unit);
    all += shade();
    for (std::size_t k = 0; k < plot_["curves"].size(); ++k)
      all += curve(plot_["curves"][k], ink_.curves[k % ink_.curves.size()]);
    return all + legend() + axes();
  }

private:
  static constexpr double width = panel_width - frame_left - frame_right;
  static constexpr double height = panel_height - frame_top - frame_bottom;

  double x(double time) const { return left_ + width * (time - times_.low) / (times_.high - times_.low); }
  double y(double value) const { return top_ + height * (1.0 - (value - values_.low) / (values_.high - values_.low)); }

  std::string rectangle(double from, double to, const char* fill, const char* stroke) const {
    return fmt::format(
        "<rect x=\"{:.1f}\" y=\"{:.1f}\" width=\"{:.1f}\" height=\"{:.1f}\" fill=\"{}\" stroke=\"{}\"/>\n", from, top_,
        to - from, height, fill, stroke);
  }

  std::string shade() const {
    if (!steady_.is_array())
      return "";
    const double from = std::clamp<double>(steady_[0], times_.low, times_.high);
    const double to = std::clamp<double>(steady_[1], times_.low, times_.high);
    return rectangle(x(from), x(to), ink_.steady, "none");
  }

  std::string curve(const Json& curve, const char* colour) const {
    std::string line, upper, lower;
    for (const Json& point : curve["points"]) {
      const double at = x(point[0]), value = point[1], error = point[2].is_number() ? point[2].get<double>() : 0.0;
      const auto vertex = [&](double v) {
        return fmt::format("{:.1f},{:.1f} ", at, y(std::clamp(v, values_.low, values_.high)));
      };
      line += vertex(value);
      upper += vertex(value + error);
      lower = vertex(value - error) + lower;
    }
    return fmt::format("<polygon points=\"{}{}\" fill=\"{}\" fill-opacity=\"0.25\" stroke=\"none\"/>\n"
                       "<polyline points=\"{}\" fill=\"none\" stroke=\"{}\" stroke-width=\"1.6\" "
                       "stroke-linejoin=\"round\"/>\n",
                       upper, lower, colour, line, colour);
  }

  // Returns the names of the curves and, below, their means. Each is one text with coloured parts, since only the
  // viewer can lay out text of unknown width.
  std::string legend() const {
    std::string names, means;
    for (std::size_t k = 0; k < plot_["curves"].size(); ++k) {
      const Json& curve = plot_["curves"][k];
      const std::string style =
          fmt::format("fill=\"{}\"{}", ink_.curves[k % ink_.curves.size()], k > 0 ? " dx=\"14\"" : "");
      names += fmt::format("<tspan {}>{}</tspan>", style, html_text(curve["name"].get<std::string>()));
      means += fmt::format("<tspan {}>{}</tspan>", style, mean_of(curve));
    }
    return fmt::format("<text x=\"{0:.1f}\" y=\"{1:.1f}\" font-size=\"13\">{2}</text>\n"
                       "<text x=\"{0:.1f}\" y=\"{3:.1f}\" font-size=\"13\">{4}</text>\n",
                       left_, top_ - 27, names, top_ - 9, means);
  }

  std::string tick(double x1, double y1, double x2, double y2) const {
    return fmt::format("<line x1=\"{:.1f}\" y1=\"{:.1f}\" x2=\"{:.1f}\" y2=\"{:.1f}\" stroke=\"{}\"/>\n", x1, y1, x2,
                       y2, ink_.frame);
  }

  std::string axes() const {
    const double bottom = top_ + height;
    std::string all = rectangle(left_, left_ + width, "none", ink_.frame);
    const double time_step = tick_step(times_), value_step = tick_step(values_);
    for (double k = std::ceil(times_.low / time_step); k * time_step <= times_.high; ++k) {
      const double at = x(k * time_step);
      all += tick(at, bottom, at, bottom + 5) +
             text_at(at, bottom + 19, ink_.faint, 13, "middle", tick_label(k * time_step, time_step));
    }
    for (double k = std::ceil(values_.low / value_step); k * value_step <= values_.high; ++k) {
      const double at = y(k * value_step);
      all += tick(left_ - 5, at, left_, at) +
             text_at(left_ - 9, at + 4.5, ink_.faint, 13, "end", tick_label(k * value_step, value_step));
    }
    return all + text_at(left_ + 0.5 * width, bottom + 37, ink_.faint, 13, "middle", "orbits");
  }

  const Json& plot_;
  const Json& steady_;
  const Ink& ink_;
  double left_, top_; // of the frame
  Range times_, values_;
};

} // namespace

std::string series_svg(const Json& plots, const std::string& title, const SeriesFigureLook& look) {
  const Ink& ink = look.light ? light_ink : dark_ink;
  const Json& panels = plots["plots"];
  assert(!panels.empty());
  const double drawing_height = head + panel_height * std::ceil(0.5 * static_cast<double>(panels.size())) + 10;
  std::string svg = fmt::format(
      "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{}\" height=\"{:.0f}\" viewBox=\"0 0 {} {}\" "
      "font-family=\"DejaVu Sans, Verdana, sans-serif\">\n<rect width=\"100%\" height=\"100%\" fill=\"{}\"/>\n",
      look.width, drawing_height * look.width / drawing_width, drawing_width, drawing_height, ink.page);
  svg += text_at(frame_left, 40, ink.text, 24, "start", title);
  if (const Json& steady = plots["steady"]; steady.is_array())
    svg += text_at(
        drawing_width - frame_right, 40, ink.faint, 14, "end",
        fmt::format("means of orbits {} to {} (shaded)", format_number(steady[0], 3), format_number(steady[1], 4)));
  for (std::size_t k = 0; k < panels.size(); ++k) {
    const std::size_t row = k / 2;
    svg += Panel(panels[k], plots["steady"], ink, k % 2 == 0 ? 0.0 : panel_width,
                 head + panel_height * static_cast<double>(row))
               .svg();
  }
  return svg + "</svg>\n";
}

std::string run_series_svg(const std::filesystem::path& folder, const SeriesFigureLook& look) {
  const RunView run = view_run(folder);
  const StoredPatches newest = load_newest_patch(folder);
  if (run.series.rows() < 2)
    throw UsageError(fmt::format("no plots of '{}': its series has fewer than two rows; let it run longer, or give "
                                 "output.series_every a smaller value",
                                 folder.string()));
  const RingScale scale = RingScale::of(newest.patches.back(), newest.driven);
  const TransportReport report = TransportReport::of_run(folder, scale, {});
  return series_svg(series_plots(run.series, scale, steady_part(report)),
                    newest.title.empty() ? "Ring patch" : newest.title, look);
}

} // namespace keeler
