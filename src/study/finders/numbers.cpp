#include "numbers.hpp"

#include "measurements.hpp"

#include <keeler/statistics/median.hpp>

#include <fmt/format.h>

#include <algorithm>

namespace keeler {

std::string number(double value) {
  return fmt::format("{:.3g}", value);
}

std::string percent(double share) {
  return share != 0.0 && std::fabs(share) < 0.001 ? fmt::format("{:.2g} %", 100.0 * share)
                                                  : fmt::format("{:.1f} %", 100.0 * share);
}

double calls_ended(const Json& audit, const std::vector<std::string>& exits) {
  double sum = 0.0;
  for (const std::string& exit : exits)
    if (audit.at("exits").contains(exit))
      sum += of(audit.at("exits").at(exit), "calls");
  return sum;
}

double share_from(const Json& audit, const std::vector<std::string>& exits, std::size_t least) {
  double sum = 0.0;
  for (const std::string& exit : exits)
    if (audit.at("exits").contains(exit)) {
      const Json& bins = audit.at("exits").at(exit).at("iterations");
      for (std::size_t k = least; k < bins.size(); ++k)
        sum += bins[k].get<double>();
    }
  return sum / std::max(1.0, calls_ended(audit, exits));
}

double mean_over(const Json& audit, const std::string& exit, const char* field) {
  if (!audit.at("exits").contains(exit))
    return 0.0;
  const Json& calls = audit.at("exits").at(exit);
  double sum = 0.0;
  for (std::size_t k = 0; k < calls.at(field).size(); ++k)
    sum += static_cast<double>(k) * calls.at(field)[k].get<double>();
  return sum / of(calls, "calls");
}

double FinderNumbers::finder_fraction(const std::string& state, const std::string& finder) const {
  const Json& share = data.result(job_name("share", state, data.shown_step, finder));
  return 1.0 - of(share, "cpu_s_without_finder") / of(share, "cpu_s");
}

double FinderNumbers::scatter() const {
  std::vector<double> all;
  each_panel([&](const std::string& state, double step) {
    for (const std::string& finder : all_finders()) {
      const std::vector<double> t = data.repeated(state, step, finder, "cpu_s");
      all.push_back(0.5 * (*std::max_element(t.begin(), t.end()) - *std::min_element(t.begin(), t.end())) / median(t));
    }
  });
  return median(all);
}

const Json& FinderNumbers::local(double step, double share) const {
  return data.result(fmt::format("local/{}/{:.6g}/{}", data.states.front().name, step, share));
}

std::size_t FinderNumbers::best_step(const std::string& state, const std::string& finder) const {
  std::size_t best = 0;
  for (std::size_t k = 1; k < data.steps.size(); ++k)
    if (cpu(state, data.steps[k], finder) < cpu(state, data.steps[best], finder))
      best = k;
  return best;
}

StepLaw FinderNumbers::law_of(const std::string& state, const std::string& finder) const {
  std::vector<double> times;
  for (const double step : data.steps)
    times.push_back(cpu(state, step, finder));
  return fit_step_law(data.steps, times);
}

} // namespace keeler
