#include "structure_report.hpp"

#include <keeler/core/words.hpp>

#include <fmt/format.h>

#include <string>

namespace keeler {
namespace {

nlohmann::ordered_json maybe(const std::optional<double>& value) {
  return value ? nlohmann::ordered_json(*value) : nlohmann::ordered_json(nullptr);
}

// NAME_UNIT and NAME_scatter_UNIT.
void put(nlohmann::ordered_json& json, const std::string& name, const char* unit, const Measured& number) {
  json[name + "_" + unit] = maybe(number.value);
  json[name + "_scatter_" + unit] = maybe(number.scatter);
}

// "20.1 +- 1.3 degrees", "unknown".
std::string text(const Measured& number, const char* unit) {
  if (!number.value)
    return "unknown";
  const std::string scatter = number.scatter ? fmt::format(" +- {:.2g}", *number.scatter) : "";
  return fmt::format("{}{} {}", figures(*number.value, 3), scatter, unit);
}

void print_wakes(const Analysis& a) {
  const WakeGeometry& w = a.wakes;
  fmt::print("wake waves           lambda {} across, {} radially, at {}\n", text(w.wavelength, "m"),
             text(w.radial_wavelength, "m"), text(w.angle_degrees, "degrees"));
  fmt::print("wake pitch of parts  inner {}, outer {}\n", text(w.inner_pitch_degrees, "degrees"),
             text(w.outer_pitch_degrees, "degrees"));
}

} // namespace

void add_structure(nlohmann::ordered_json& json, const Analysis& a) {
  put(json, "wake_wavelength", "m", a.wakes.wavelength);
  put(json, "wake_radial_wavelength", "m", a.wakes.radial_wavelength);
  put(json, "wake_angle", "degrees", a.wakes.angle_degrees);
  put(json, "wake_inner_pitch", "degrees", a.wakes.inner_pitch_degrees);
  put(json, "wake_outer_pitch", "degrees", a.wakes.outer_pitch_degrees);
  json["wake_contrast"] = a.wakes.contrast;
}

void print_structure(const Analysis& a) {
  print_wakes(a);
}

} // namespace keeler
