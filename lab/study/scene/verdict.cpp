#include "verdict.hpp"

#include <keeler/core/format.hpp>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cassert>
#include <cmath>

namespace keeler::study {
namespace {

double cost_of(const StudyMeans& means, std::size_t setting) {
  return means.settings[setting].scatter[number_at("cpu_s_per_orbit")].mean;
}

double reference_mean(const StudyMeans& means, std::size_t number) {
  return means.settings[means.reference].scatter[number].mean;
}

std::string balance_words(const SettingVerdict& verdict) {
  if (!verdict.balance_off)
    return " The balance of energy is not measured in these runs.";
  const std::string found = fmt::format(" Its loss over stress differs from the reference's by {:+.1f} ± {:.1f} %",
                                        100.0 * *verdict.balance_off, 100.0 * *verdict.balance_bound);
  return verdict.balance_shown()
             ? found + fmt::format(", so it is within {:g} %.", 100.0 * balance_tolerance)
             : found + fmt::format(": within {:g} % by its mean, but a difference of up to {:.1f} % is not excluded; "
                                   "more seeds or orbits would decide.",
                                   100.0 * balance_tolerance,
                                   100.0 * (std::fabs(*verdict.balance_off) + *verdict.balance_bound));
}

// Lists the settings that are cheaper than the chosen one but not acceptable, with their deviations.
std::string refused_words(const StudyMeans& means, std::size_t chosen) {
  std::string text;
  for (std::size_t s = 0; s < means.settings.size(); ++s) {
    const SettingVerdict verdict = verdict_on(means, s);
    if (s == means.reference || !verdict.compared || verdict.acceptable() ||
        !(cost_of(means, s) < cost_of(means, chosen)))
      continue;
    std::vector<std::string> faults = verdict.beyond;
    if (verdict.balance_off && std::fabs(*verdict.balance_off) > balance_tolerance)
      faults.push_back(fmt::format("loss over stress by {:+.1f} %", 100.0 * *verdict.balance_off));
    text += fmt::format(" `{}` is cheaper and differs in {}.", means.settings[s].name, fmt::join(faults, ", "));
  }
  return text;
}

// Returns the number of differences beyond the scatter, and the number expected by chance.
std::string chance_words(const StudyMeans& means) {
  int compared = 0, beyond = 0;
  for (const SettingMeans& setting : means.settings)
    for (const statistics::MeanDifference& difference : setting.from_reference)
      if (difference.known()) {
        ++compared;
        beyond += difference.within() ? 0 : 1;
      }
  return fmt::format(" Of {} differences {} are beyond the scatter (Student's t at 95 %); about {:.0f} are expected by "
                     "chance alone.",
                     compared, beyond, 0.05 * compared);
}

} // namespace

bool SettingVerdict::acceptable() const {
  return compared && beyond.empty() && (!balance_off || std::fabs(*balance_off) <= balance_tolerance);
}

bool SettingVerdict::balance_shown() const {
  return balance_off && std::fabs(*balance_off) + *balance_bound <= balance_tolerance;
}

SettingVerdict verdict_on(const StudyMeans& means, std::size_t setting) {
  assert(setting < means.settings.size() && means.settings[setting].from_reference.size() == means.numbers.size());
  SettingVerdict verdict;
  for (std::size_t n = 0; n < means.numbers.size(); ++n) {
    const statistics::MeanDifference& difference = means.settings[setting].from_reference[n];
    if (!difference.known())
      continue;
    verdict.compared = true;
    if (means.numbers[n].column == "energy_balance") {
      verdict.balance_off = difference.difference / std::fabs(reference_mean(means, n));
      verdict.balance_bound = difference.bound / std::fabs(reference_mean(means, n));
    } else if (!difference.within()) {
      verdict.beyond.push_back(means.numbers[n].title);
    }
  }
  return verdict;
}

std::optional<std::size_t> cheapest_acceptable(const StudyMeans& means) {
  std::optional<std::size_t> best;
  for (std::size_t s = 0; s < means.settings.size(); ++s)
    if ((s == means.reference || verdict_on(means, s).acceptable()) && !std::isnan(cost_of(means, s)) &&
        (!best || cost_of(means, s) < cost_of(means, *best)))
      best = s;
  return best;
}

std::string verdict_text(const StudyMeans& means) {
  const std::optional<std::size_t> best = cheapest_acceptable(means);
  if (!best)
    return "**Verdict**: no run is finished, so there is no verdict.";
  const std::string& reference = means.settings[means.reference].name;
  const std::string cost = fmt::format("{} s of processor time per orbit", format_number(cost_of(means, *best), 3));
  std::string text;
  if (*best == means.reference)
    text = fmt::format("**Verdict**: no setting that is cheaper than the most accurate one, `{}` ({}), agrees with it "
                       "within the scatter.",
                       reference, cost);
  else
    text =
        fmt::format(
            "**Verdict**: the cheapest setting that agrees with the most accurate one, `{1}`, in loss over stress to "
            "{0:g} % and in the other means within the scatter, is `{2}`: {3}, {4} times the speed.",
            100.0 * balance_tolerance, reference, means.settings[*best].name, cost,
            format_number(cost_of(means, means.reference) / cost_of(means, *best), 3)) +
        balance_words(verdict_on(means, *best));
  return text + refused_words(means, *best) + chance_words(means);
}

std::string sensitivity_text(const StudyMeans& means) {
  std::string list;
  for (std::size_t n = 0; n < means.numbers.size(); ++n) {
    double largest = 0.0;
    for (const SettingMeans& setting : means.settings)
      if (const statistics::MeanDifference& difference = setting.from_reference[n]; difference.known())
        largest = std::max(largest, difference.bound / std::fabs(reference_mean(means, n)));
    if (largest > 0.0)
      list += fmt::format("{}{} {:.1f} %", list.empty() ? "" : ", ", means.numbers[n].title, 100.0 * largest);
  }
  return list.empty()
             ? list
             : "**Sensitivity**: these runs could not detect smaller differences than the following, in per cent of "
               "the reference (the largest of all settings): " +
                   list + ". Agreement within the scatter is not equality.";
}

} // namespace keeler::study
