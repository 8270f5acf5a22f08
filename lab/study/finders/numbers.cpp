#include "numbers.hpp"

#include "measurements.hpp"

#include <keeler/statistics/median.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <cmath>

namespace keeler::study {

std::string number(double value) {
  return fmt::format("{:.3g}", value);
}

std::string percent(double fraction) {
  return fraction != 0.0 && std::fabs(fraction) < 0.001 ? fmt::format("{:.2g} %", 100.0 * fraction)
                                                        : fmt::format("{:.1f} %", 100.0 * fraction);
}

double calls_ended(const Json& audit, const std::vector<std::string>& exits) {
  double sum = 0.0;
  for (const std::string& exit : exits)
    if (audit.at("exits").contains(exit))
      sum += of(audit.at("exits").at(exit), "calls");
  return sum;
}

double fraction_from(const Json& audit, const std::vector<std::string>& exits, std::size_t min_iterations) {
  double sum = 0.0;
  for (const std::string& exit : exits)
    if (audit.at("exits").contains(exit)) {
      const Json& bins = audit.at("exits").at(exit).at("iterations");
      for (std::size_t k = min_iterations; k < bins.size(); ++k)
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

const Json& FinderStudyData::audit(const std::string& state, double step, const std::string& finder) const {
  return result(job_name("audit", state, step, finder));
}

std::vector<double> FinderStudyData::repeated(const std::string& state, double step, const std::string& finder,
                                              const char* field) const {
  std::vector<double> values;
  for (int repeat = 0; repeat < repeats; ++repeat)
    values.push_back(result(job_name("run", state, step, finder, repeat)).at(field).get<double>());
  return values;
}

double FinderStudyData::timed(const std::string& state, double step, const std::string& finder,
                              const char* field) const {
  return statistics::median(repeated(state, step, finder, field));
}

double FinderStudyData::finder_fraction(const std::string& state, const std::string& finder) const {
  const Json& times = result(job_name("share", state, shown_step, finder));
  return 1.0 - of(times, "cpu_s_without_finder") / of(times, "cpu_s");
}

double FinderStudyData::scatter() const {
  std::vector<double> all;
  each_panel([&](const std::string& state, double step) {
    for (const std::string& finder : all_finders()) {
      const std::vector<double> t = repeated(state, step, finder, "cpu_s");
      all.push_back(0.5 * (*std::max_element(t.begin(), t.end()) - *std::min_element(t.begin(), t.end())) /
                    statistics::median(t));
    }
  });
  return statistics::median(all);
}

const Json& FinderStudyData::shown(const std::string& kind, const std::string& state) const {
  return result(job_name(kind, state, shown_step));
}

const Json& FinderStudyData::local(double step, double moved_fraction) const {
  return result(fmt::format("local/{}/{:.6g}/{}", states.front().name, step, moved_fraction));
}

std::size_t FinderStudyData::best_step(const std::string& state, const std::string& finder) const {
  assert(!steps.empty());
  std::size_t best = 0;
  for (std::size_t k = 1; k < steps.size(); ++k)
    if (cpu(state, steps[k], finder) < cpu(state, steps[best], finder))
      best = k;
  return best;
}

StepLaw FinderStudyData::law_of(const std::string& state, const std::string& finder) const {
  std::vector<double> times;
  for (const double step : steps)
    times.push_back(cpu(state, step, finder));
  return fit_step_law(steps, times);
}

} // namespace keeler::study
