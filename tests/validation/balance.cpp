// The loss of energy in collisions against the work of the shear on the three stresses, which must be equal.
#include "rows.hpp"

#include <fmt/format.h>

#include <cmath>

namespace keeler::validation {
namespace {

constexpr const char* energy_law = "conservation of energy";

Row balance_row(const std::string& what, const Ran& ran, double since) {
  const runs::Transport t = transport_since(ran, since);
  return {.what = what,
          .measured = t.balance->value,
          .error = t.balance->error,
          .expected = 1.0,
          .tolerance = 0.03,
          .tolerance_is = "several times what rounding and kicks leave open",
          .source = energy_law,
          .command = fmt::format("{}; keeler analyze DIR --since {}", ran.command, since)};
}

std::vector<Row> without_gravity() {
  std::vector<Row> rows;
  for (const double depth : {0.25, 0.5, 1.0, 2.0}) {
    const double side = std::sqrt(3.141592653589793 * 2000.0 / depth);
    const Ran ran = run_example("equilibrium", {fmt::format("particles.optical_depth={}", depth),
                                                fmt::format("box.size=[{0:.2f},{0:.2f}]", side), "time.end=25",
                                                "time.step=5e-3", "output.series_every=0.1"});
    rows.push_back(balance_row(fmt::format("loss over work of the shear, tau {}", depth), ran, 10.0));
  }
  return rows;
}

std::vector<Row> with_gravity() {
  std::vector<Row> rows;
  for (const double hill : {0.65, 0.85, 0.93}) {
    const Ran ran = run_example("a-ring-wakes", wakes(hill, 1, 8.5));
    rows.push_back(balance_row(fmt::format("loss over work of the shear, r_h {}", hill), ran, 5.5));
  }
  return rows;
}

} // namespace

std::vector<Subject> balance_subjects() {
  return {{"balance", "The balance of energy", false, without_gravity},
          {"balance-wakes", "The balance of energy", false, with_gravity}};
}

} // namespace keeler::validation
