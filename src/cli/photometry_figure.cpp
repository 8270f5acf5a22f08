#include "photometry_figure.hpp"

#include "results.hpp"

#include <keeler/core/error.hpp>
#include <keeler/core/format.hpp>
#include <keeler/core/units.hpp>
#include <keeler/files/files.hpp>
#include <keeler/files/new_file.hpp>
#include <keeler/light/photometry_record.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <map>

namespace keeler::cli {
namespace {

std::string_view first_bytes(plot::PageFormat format) {
  return format == plot::PageFormat::png ? "\x89PNG" : format == plot::PageFormat::svg ? "<svg " : "%PDF-";
}

double shown_degrees(double radians) {
  return radians * 180.0 / pi;
}

// Sorts the points by longitude so that the curve does not cross the widest gap between them: the longitudes 190 to 350
// and 0 are 190 to 360.
void sort_by_longitude(plot::PlotCurve& curve) {
  std::vector<plot::PlotPoint>& points = curve.points;
  const auto sort = [&] {
    std::sort(points.begin(), points.end(),
              [](const plot::PlotPoint& a, const plot::PlotPoint& b) { return a.x < b.x; });
  };
  constexpr double turn = 360.0;
  sort();
  double widest = points.front().x + turn - points.back().x, first = points.front().x;
  for (std::size_t k = 1; k < points.size(); ++k)
    if (points[k].x - points[k - 1].x > widest) {
      widest = points[k].x - points[k - 1].x;
      first = points[k].x;
    }
  for (plot::PlotPoint& point : points)
    if (point.x < first)
      point.x += turn;
  sort();
}

plot::Panel against_longitude(const std::vector<light::AzimuthGroup>& groups) {
  plot::Panel panel{.x = {.label = "ring longitude, degrees"}, .y = {.label = "I/F"}};
  for (std::size_t k = 0; k < groups.size(); ++k) {
    const light::Sight& first = groups[k].sights.front().sight;
    plot::PlotCurve curve{.name = fmt::format("B {}, B' {}, phase {}",
                                              format_number(shown_degrees(first.observer.elevation), 4),
                                              format_number(shown_degrees(first.sun.elevation), 4),
                                              format_number(shown_degrees(first.phase()), 4)),
                          .colour = k,
                          .marks = true};
    for (const light::Photometry& one : groups[k].sights)
      curve.points.push_back({shown_degrees(one.sight.longitude()), one.reflectance.value, one.reflectance.error});
    sort_by_longitude(curve);
    panel.curves.push_back(curve);
  }
  return panel;
}

// One curve for each elevation of observer and Sun: means over the azimuths.
plot::Panel against_phase(std::span<const light::Photometry> found) {
  struct Sum {
    double value = 0.0, variance = 0.0, count = 0.0;
  };
  std::map<std::pair<double, double>, std::map<double, Sum>> curves;
  for (const light::Photometry& one : found) {
    const double phase = std::round(shown_degrees(one.sight.phase()) * 1e6) * 1e-6;
    Sum& sum = curves[{one.sight.observer.elevation, one.sight.sun.elevation}][phase];
    sum.value += one.reflectance.value;
    sum.variance += one.reflectance.error * one.reflectance.error;
    sum.count += 1.0;
  }
  plot::Panel panel{.x = {.label = "phase angle, degrees"}, .y = {.label = "I/F, mean over azimuths"}};
  for (const auto& [elevations, points] : curves) {
    plot::PlotCurve curve{.name = fmt::format("B {}, B' {}", format_number(shown_degrees(elevations.first), 4),
                                              format_number(shown_degrees(elevations.second), 4)),
                          .colour = panel.curves.size(),
                          .marks = true};
    for (const auto& [phase, sum] : points)
      curve.points.push_back({phase, sum.value / sum.count, std::sqrt(sum.variance) / sum.count});
    panel.curves.push_back(curve);
  }
  return panel;
}

} // namespace

PhotometryFigureFile::PhotometryFigureFile(const std::string& name) : file_(output_named(name)) {
  const std::optional<plot::PageFormat> format =
      files::is_stream(file_) ? plot::PageFormat::svg : plot::page_format(file_);
  if (!format)
    throw UsageError(fmt::format(
        "'{}' cannot be the figure: it is an .svg, .png or .pdf file; give it one of these endings", file_.string()));
  format_ = *format;
  require_replaceable(file_, "the figure", first_bytes(format_));
}

void PhotometryFigureFile::write(std::span<const light::Photometry> found) const {
  plot::Figure figure{.title = "Brightness of the patch"};
  const std::vector<light::AzimuthGroup> groups = light::azimuth_groups(found);
  if (!groups.empty())
    figure.panels.push_back(against_longitude(groups));
  plot::Panel phases = against_phase(found);
  const auto is_curve = [](const plot::PlotCurve& curve) { return curve.points.size() > 1; };
  if (groups.empty() || std::any_of(phases.curves.begin(), phases.curves.end(), is_curve))
    figure.panels.push_back(std::move(phases));
  files::write_file(file_, figure_bytes(figure, format_));
  print_written(file_);
}

} // namespace keeler::cli
