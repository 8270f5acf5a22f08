#include "transport_text.hpp"

#include "print.hpp"

#include <keeler/core/words.hpp>

#include <fmt/format.h>

#include <cmath>
#include <string>

namespace keeler {
namespace {

std::string with_error(const Estimate& e, double unit) {
  return std::isfinite(e.error) ? fmt::format("{:.4g} +- {:.1g}", e.value / unit, e.error / unit)
                                : fmt::format("{:.3g}", e.value / unit);
}

void print_viscosity(const char* label, const char* name, const std::optional<Estimate>& nu,
                     const ViscosityUnits& units) {
  if (nu)
    print("{:<20} {:<14} {} m^2/s = {:.3g} r^2 Omega = {:.3g} G^2 Sigma^2/Omega^3\n", label, name, with_error(*nu, 1.0),
          nu->value / units.radii, nu->value / units.gravity);
  else
    print("{:<20} {:<14} not measured\n", label, name);
}

} // namespace

void print_transport(const TransportReport& report, const Patch& patch) {
  if (!report.transport()) {
    print("viscosities          not known because series.csv has fewer than three rows with all stresses here\n");
    return;
  }
  const ViscosityUnits units(patch);
  const Transport& t = *report.transport();
  if (report.is_of_run())
    print("viscosities          orbits {} to {}, {}\n", figures(t.since_orbit, 4), figures(t.until_orbit, 4),
          t.steady ? "where the run is steady" : "which are not steady or too few to tell: run longer");
  print_viscosity(report.is_of_run() ? "" : "viscosity", "translational", t.translational, units);
  if (report.is_of_run())
    print_viscosity("", "collisional", t.collisional, units);
  print_viscosity("", "gravitational", t.gravitational, units);
  if (!report.is_of_run())
    return;
  print_viscosity("", "total", t.total, units);
  print_viscosity("", "from the loss", t.from_loss, units);
  if (t.balance)
    print("energy balance       {}: energy lost over the work of the shear; 1 but for its error\n",
          with_error(*t.balance, 1.0));
  if (t.waves)
    print("epicyclic waves      {}\n", words_of(*t.waves));
}

} // namespace keeler
