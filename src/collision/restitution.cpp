#include <keeler/collision/restitution.hpp>

#include <keeler/collision/settings.hpp>
#include <keeler/core/error.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <map>
#include <mutex>

namespace keeler::collision {
namespace {

constexpr double centimetre = 0.01;

void check_table(const NumberRows& table) {
  if (table.empty())
    throw UsageError("it has no rows; give at least one speed and its coefficient");
  for (std::size_t k = 0; k < table.size(); ++k) {
    const double speed = table[k][0], coefficient = table[k][1];
    if (!(speed > (k == 0 ? 0.0 : table[k - 1][0])))
      throw UsageError(fmt::format("row {}: the speed {:g} is not above {}; let the speeds rise from above 0", k + 1,
                                   speed, k == 0 ? "0" : "the one before it"));
    if (!(coefficient >= 0.0 && coefficient <= 1.0))
      throw UsageError(fmt::format("row {}: the coefficient {:g} is not from 0 to 1; correct it", k + 1, coefficient));
  }
}

// Laws that the calling program has registered. Scenes are read in any thread.
struct OwnLaws {
  std::mutex guard;
  std::map<std::string, RestitutionLaw> laws;
};

OwnLaws& own_laws() {
  static OwnLaws laws;
  return laws;
}

void require_coefficient(double kept, const std::string& name, const Impact& impact) {
  if (!(kept >= 0.0 && kept <= 1.0))
    throw UsageError(
        fmt::format("the restitution law '{}' gives {:g} for an impact of {:g} m/s of radii {:g} m and {:g} "
                    "m (coefficients are from 0 to 1); correct the law",
                    name, kept, impact.speed, impact.radius_low, impact.radius_high));
}

RestitutionLaw own_restitution(const std::string& name) {
  OwnLaws& own = own_laws();
  const std::lock_guard lock(own.guard);
  const auto found = own.laws.find(name);
  if (found == own.laws.end())
    throw UsageError(fmt::format("the law '{}' is a function of the program that made this, and this program has no "
                                 "such function; continue in that program, or choose another law",
                                 name));
  return found->second;
}

} // namespace

void add_own_restitution(const std::string& name, const RestitutionLaw& law) {
  if (name.empty())
    throw UsageError("a custom restitution law needs a name; states and checkpoints refer to it by name");
  for (double speed = 1e-6; speed < 101.0; speed *= 10.0)
    require_coefficient(law({speed, 1.0, 1.0}), name, {speed, 1.0, 1.0});
  const auto held_to_range = [name, law](const Impact& impact) {
    const double kept = law(impact);
    require_coefficient(kept, name, impact);
    return kept;
  };
  OwnLaws& own = own_laws();
  const std::lock_guard lock(own.guard);
  if (!own.laws.try_emplace(name, held_to_range).second)
    throw UsageError(fmt::format("there is a restitution law '{}' already; give this one another name", name));
}

RestitutionLaw constant_restitution(double coefficient) {
  return [coefficient](const Impact&) { return coefficient; };
}

RestitutionLaw bridges_restitution(double scale) {
  assert(scale > 0.0);
  return [scale](const Impact& impact) {
    return impact.speed > 0.0 ? std::min(1.0, scale * std::pow(impact.speed / centimetre, -0.234)) : 1.0;
  };
}

RestitutionLaw borderies_restitution(double critical_speed) {
  assert(critical_speed > 0.0);
  return [critical_speed](const Impact& impact) {
    if (impact.speed <= critical_speed)
      return 1.0;
    const double u = critical_speed / impact.speed, u2 = u * u;
    return std::sqrt(-2.0 / 3.0 * u2 + std::sqrt(10.0 / 3.0 * u2 - 5.0 / 9.0 * u2 * u2));
  };
}

RestitutionLaw hatzes_restitution() {
  return [](const Impact& impact) {
    const double v = impact.speed / centimetre;
    return v > 0.0 ? std::min(1.0, 0.90 * std::exp(-0.22 * v) + 0.01 * std::pow(v, -0.6)) : 1.0;
  };
}

RestitutionLaw viscoelastic_restitution(double speed, double radius) {
  assert(speed > 0.0 && radius > 0.0);
  const auto stiffness = [](double a, double b) { // √R_eff / m_eff, up to a factor of the material
    const double a3 = a * a * a, b3 = b * b * b;
    return std::sqrt(a * b / (a + b)) * (a3 + b3) / (a3 * b3);
  };
  return [speed, stiffness, of_one = stiffness(radius, radius)](const Impact& impact) {
    const double k = stiffness(impact.radius_low, impact.radius_high) / of_one;
    const double x = std::pow(impact.speed / speed, 0.2) * std::pow(k, 0.4);
    return (1.0 + 2.583 * x) / (1.0 + x * (3.583 + x * (2.983 + x * (1.148 + x * 0.326))));
  };
}

RestitutionLaw tabulated_restitution(NumberRows table) {
  check_table(table);
  return [table = std::move(table)](const Impact& impact) {
    const auto after = std::upper_bound(table.begin(), table.end(), impact.speed,
                                        [](double speed, const std::vector<double>& row) { return speed < row[0]; });
    if (after == table.begin())
      return table.front()[1];
    if (after == table.end())
      return table.back()[1];
    const std::vector<double>&low = after[-1], &high = after[0];
    const double fraction = std::log(impact.speed / low[0]) / std::log(high[0] / low[0]);
    return low[1] + fraction * (high[1] - low[1]);
  };
}

const std::vector<RestitutionEntry>& restitution_laws() {
  static const std::vector<RestitutionEntry> laws = {
      {"bridges",
       {{.path = "scale",
         .type = KeyType::number,
         .fallback = "0.34",
         .unit = "1",
         .meaning = "c in min(1, c (v / 1 cm/s)^-0.234) (Bridges et al. 1984)",
         .range = {.low = 0, .high = 1000, .low_open = true}}},
       [](const Parameters& p) { return bridges_restitution(p.number("scale")); }},
      {"constant",
       {{.path = "value",
         .type = KeyType::number,
         .example = "0.5",
         .unit = "1",
         .meaning = "the constant coefficient",
         .range = {.low = 0, .high = 1}}},
       [](const Parameters& p) { return constant_restitution(p.number("value")); }},
      {"borderies",
       {{.path = "critical_speed",
         .type = KeyType::number,
         .example = "1e-4",
         .unit = "m/s",
         .meaning = "normal speed up to which bounces are elastic (Borderies et al. 1984)",
         .range = {.low = 0, .high = 1000, .low_open = true}}},
       [](const Parameters& p) { return borderies_restitution(p.number("critical_speed")); }},
      {"hatzes", {}, [](const Parameters&) { return hatzes_restitution(); }},
      {"viscoelastic",
       {{.path = "reference_speed",
         .type = KeyType::number,
         .example = "5e-3",
         .unit = "m/s",
         .meaning =
             "normal speed at which two spheres of reference_radius have a coefficient of 0.396 (Ramirez et al. 1999)",
         .range = {.low = 0, .high = 1000, .low_open = true},
         .former_name = "speed"},
        {.path = "reference_radius",
         .type = KeyType::number,
         .example = "1.0",
         .unit = "m",
         .meaning = "radius of the spheres of reference_speed; larger ones are more elastic",
         .range = {.low = 1e-6, .high = 1e6},
         .former_name = "radius"}},
       [](const Parameters& p) {
         return viscoelastic_restitution(p.number("reference_speed"), p.number("reference_radius"));
       }},
      {"table",
       {{.path = "table",
         .type = KeyType::rows,
         .example = "\"ice.txt\"",
         .meaning = "measured coefficients; linear in log speed between rows, constant beyond them",
         .range = {.low = 0, .high = 1e6},
         .columns = {"normal speed in m/s", "coefficient"}}},
       [](const Parameters& p) { return tabulated_restitution(p.rows("table")); }},
      {"own",
       {{.path = "name",
         .type = KeyType::text,
         .example = "\"my-ice\"",
         .meaning = "name of a function that the calling program registers, from Python or C++"}},
       [](const Parameters& p) { return own_restitution(p.text("name")); }},
  };
  return laws;
}

Rebound rebound(const CollisionSettings& settings, double approach_speed, double radius_low, double radius_high,
                double orbital_frequency) {
  assert(radius_low > 0.0 && radius_high > 0.0 && orbital_frequency > 0.0);
  const double radius_sum = radius_low + radius_high;
  const bool fast = approach_speed >= settings.cut_speed(radius_sum);
  const double kept = fast ? settings.restitution({approach_speed * orbital_frequency, radius_low, radius_high}) : 1.0;
  return {std::max(kept * approach_speed, settings.min_rebound(radius_sum)), fast};
}

} // namespace keeler::collision
