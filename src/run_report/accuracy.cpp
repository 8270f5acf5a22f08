#include "accuracy.hpp"

#include <keeler/core/words.hpp>
#include <keeler/report/html.hpp>
#include <keeler/scene/derived.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <vector>

namespace keeler {
namespace {

using Json = nlohmann::ordered_json;
using Rows = std::vector<std::vector<std::string>>;

std::string number(const Json& json, int digits = 3) {
  return json.is_number() ? figures(json.get<double>(), digits) : "not measured";
}

// "12 s, 31 % of the time".
std::string price(const Json& summary, const std::string& part) {
  const double wall = summary.value("wall_s", 0.0), seconds = summary.at("split").value(part + "_s", 0.0);
  return wall > 0.0 ? fmt::format("{} s, {} % of the time", figures(seconds, 3), figures(100.0 * seconds / wall, 2))
                    : figures(seconds, 3) + " s";
}

void add_gravity(Rows& rows, const Scene& scene, const Json& summary) {
  if (!scene.gravity)
    return;
  const Json error = summary.value("force_error", Json());
  rows.push_back({"self-gravity",
                  in_words(chosen_for(static_cast<std::size_t>(summary.value("particle_count", 0.0)), *scene.gravity)),
                  error.is_object()
                      ? fmt::format("rms error of the forces {} of the rms force (worst of {} checks: {})",
                                    number(error.value("rms", Json())), error.value("checks", 0),
                                    number(error.value("worst_rms", Json())))
                      : "not measured",
                  price(summary, "gravity")});
}

} // namespace

std::string accuracy_table(const Scene& scene, const Json& summary) {
  Rows rows = {{"what", "as it was done", "how exact", "price"}};
  rows.push_back({"contacts", "finder " + scene.collisions.finder,
                  fmt::format("largest overlap {} of a radius sum; contacts slower than what a kick of the pair's "
                              "own gravity gives: {} of all; searches given up: {}",
                              number(summary.value("largest_overlap", Json())),
                              number(summary.value("unresolved_contacts_share", Json())),
                              number(summary.value("finder_gave_up", Json()))),
                  price(summary, "drift")});
  add_gravity(rows, scene, summary);
  const Json energy = summary.value("energy_j", Json::object()), balance = summary.value("energy_balance", Json());
  rows.push_back(
      {"energy, step by step", "booked in collisions and kicks",
       fmt::format("not booked (rounding): {} J beside {} J lost in collisions",
                   number(energy.value("residual", Json())), number(energy.value("lost_in_collisions", Json()))),
       price(summary, "series")});
  if (balance.is_object())
    rows.push_back(
        {"energy, of the steady part", "viscosity from the loss over that of the stresses; 1 is exact",
         fmt::format("{} ± {}", number(balance.value("ratio", Json()), 4), number(balance.value("error", Json()), 2)),
         price(summary, "stresses")});
  return html_table(rows);
}

std::string timing_table(const Json& summary) {
  Rows rows = {{"part", "wall time, s", "share"}};
  const double wall = summary.value("wall_s", 0.0);
  for (const auto& [name, seconds] : summary.at("split").items()) {
    const auto s = seconds.get<double>();
    std::string part = name.substr(0, name.size() - 2); // without "_s"
    std::replace(part.begin(), part.end(), '_', ' ');
    if (s > 0.0)
      rows.push_back({part, figures(s, 3), wall > 0.0 ? fmt::format("{:.1f} %", 100.0 * s / wall) : ""});
  }
  rows.push_back({"**all**", figures(wall, 4), ""});
  return html_table(rows);
}

} // namespace keeler
