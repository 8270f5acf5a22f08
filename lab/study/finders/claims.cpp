#include "measurements.hpp"
#include "numbers.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <map>

namespace keeler::study {
namespace {

constexpr double tie = 1.02; // ratio of times that six repeats do not resolve

// Returns the verdict on a claim that holds in `in_favour` of `cases` cases.
std::string verdict(int in_favour, int cases) {
  assert(0 <= in_favour && in_favour <= cases);
  if (in_favour == cases)
    return "confirmed";
  return in_favour == 0 ? "refuted" : 2 * in_favour > cases ? "confirmed in most cases" : "refuted in most cases";
}

// Lists the entries of a map of counts: "name<between>count, …".
template<class Counts> std::string list_counts(const Counts& counts, const char* between) {
  std::string text;
  for (const auto& [name, count] : counts)
    text += fmt::format("{}{}{}{}", text.empty() ? "" : ", ", name, between, count);
  return text;
}

void time_in_finder(const FinderStudyData& n, Rows& rows) {
  double smallest = 1.0, largest = 0.0;
  for (const StudyState& state : n.states)
    for (const std::string& finder : paper_finders) {
      smallest = std::min(smallest, n.finder_fraction(state.name, finder));
      largest = std::max(largest, n.finder_fraction(state.name, finder));
    }
  rows.push_back(
      {"Over 90 % of the run time is often spent in the finder.",
       fmt::format("{} to {} at step {}, over the states and the paper's five (a run against the same run on "
                   "recorded answers)",
                   percent(smallest), percent(largest), n.shown_step),
       smallest > 0.9  ? "confirmed"
       : largest > 0.9 ? "confirmed for the slowest finders"
                       : "refuted for this code"});
}

// Adds the claims on the fastest and the slowest of five finders.
// Precondition: five[3] is the linear search on the full motion.
void ranking(const FinderStudyData& n, Rows& rows, const std::string& forms, const std::vector<std::string>& five) {
  assert(five.size() == 5 && five[3].starts_with("linear-full"));
  int first = 0, last = 0;
  double worst_ratio = 0.0;
  std::map<std::string, int> fastest, slowest;
  n.each_panel([&](const std::string& state, double step) {
    std::vector<std::pair<double, std::string>> order;
    for (const std::string& finder : five)
      order.emplace_back(n.cpu(state, step, finder), finder);
    std::sort(order.begin(), order.end());
    const double ratio = n.cpu(state, step, five[3]) / order.front().first;
    ++fastest[order.front().second];
    ++slowest[order.back().second];
    last += order.back().second == "original" || order.back().second == "newton-cubic";
    first += ratio < tie;
    worst_ratio = std::max(worst_ratio, ratio);
  });
  rows.push_back(
      {forms + "linear-full is the fastest across the board.",
       fmt::format("fastest of the five, or within 2 %, in {} of {} panels (state × step), at worst {:.2f} times "
                   "the fastest (first: {})",
                   first, n.panels(), worst_ratio, list_counts(fastest, " ")),
       verdict(first, n.panels())});
  rows.push_back(
      {forms + "original and newton-cubic compete for the last place.",
       fmt::format("one of them is last in {} of {} panels (last: {})", last, n.panels(), list_counts(slowest, " ")),
       verdict(last, n.panels())});
}

void slower(const FinderStudyData& n, Rows& rows, const std::string& claim, const char* slow, const char* fast) {
  int count = 0;
  n.each_panel([&](const std::string& state, double step) {
    count += n.cpu(state, step, slow) > tie * n.cpu(state, step, fast);
  });
  rows.push_back({claim, fmt::format("{} is slower than {} in {} of {} panels", slow, fast, count, n.panels()),
                  verdict(count, n.panels())});
}

void cubics(const FinderStudyData& n, Rows& rows) {
  slower(n, rows, "Newton on cubics is slower than on the full motion.", "newton-cubic", "newton-full");
  slower(n, rows, "newton-cubic is slower than newton-full as the paper's code has it.", "newton-cubic",
         "newton-full-as-coded");
  slower(n, rows, "The linear search on cubics is slower than on the full motion.", "linear-cubic", "linear-full");
  slower(n, rows, "It is the fits that cost: with cubics stored per particle, newton-cubic is faster.", "newton-cubic",
         "newton-cubic-cached");
  slower(n, rows, "With cubics stored per particle, linear-cubic is faster.", "linear-cubic", "linear-cubic-cached");
}

void early_exits(const FinderStudyData& n, Rows& rows) {
  std::string ended;
  int in_favour = 0;
  for (const std::string& finder : paper_finders) {
    const double fraction = calls_ended(n.early(finder), {"receding", "overlapping"}) / of(n.early(finder), "calls");
    in_favour += fraction > 0.5;
    ended += fmt::format("{}{} {}", ended.empty() ? "" : ", ", finder, percent(fraction));
  }
  rows.push_back({"Most calls end at once, because the particles recede.",
                  fmt::format("calls that end before the loop, equal sizes, early, step {}: {}", n.shown_step, ended),
                  verdict(in_favour, static_cast<int>(paper_finders.size()))});
}

void iterations(const FinderStudyData& n, Rows& rows) {
  const double original = fraction_from(n.early("original"), {"hit"}, 20);
  double others = 1.0;
  for (const std::string& finder : paper_finders)
    if (finder != "original")
      others = std::min(others, 1.0 - fraction_from(n.early(finder), {"hit"}, 6));
  rows.push_back(
      {"The original method needs some twenty iterations for a collision, the others five or fewer.",
       fmt::format("original: {} of its hits take 20 or more (mean {:.1f}); the others: at least {} take five "
                   "or fewer",
                   percent(original), mean_over(n.early("original"), "hit", "iterations"), percent(others)),
       original > 0.5 && others > 0.9 ? "confirmed" : "refuted"});

  const auto tail = [&](const char* finder) { return fraction_from(n.early(finder), {"missed", "gave up"}, 6); };
  rows.push_back(
      {"Linear methods have a low tail of many iterations where there is no collision.",
       fmt::format("of the calls that enter the loop and find nothing, more than five iterations: linear-full "
                   "{}, linear-cubic {}, newton-full {}",
                   percent(tail("linear-full")), percent(tail("linear-cubic")), percent(tail("newton-full"))),
       tail("linear-full") > 10.0 * tail("newton-full") ? "confirmed" : "refuted"});

  const auto halvings = [&](const char* finder) {
    return of(n.early(finder), "halvings") / std::max(1.0, of(n.early(finder), "iterations"));
  };
  rows.push_back({"Newton's method on the full motion spends its time scaling steps back, the linear one does not.",
                  fmt::format("steps halved per iteration: newton-full {:.2f}, as coded {:.3f}, linear-full {:.3f}",
                              halvings("newton-full"), halvings("newton-full-as-coded"), halvings("linear-full")),
                  halvings("newton-full") > 0.5 && halvings("newton-full") > 2.0 * halvings("linear-full")
                      ? "confirmed"
                      : "refuted"});
}

void steps(const FinderStudyData& n, Rows& rows) {
  std::map<std::string, int> best;
  int inside = 0, curves = 0;
  double worst = 0.0;
  for (const StudyState& state : n.states)
    for (const std::string& finder : paper_finders) {
      const std::size_t k = n.best_step(state.name, finder);
      ++best[fmt::format("{:.2g}", n.steps[k])];
      inside += k > 0 && k + 1 < n.steps.size();
      ++curves;
      worst = std::max(worst, n.law_of(state.name, finder).largest_error);
    }
  rows.push_back({"The best step is often 1/1000 orbit, in some cases 3/1000 or 1/100.",
                  fmt::format("best step and number of curves, of {} (state × the paper's five): {}", curves,
                              list_counts(best, " × ")),
                  verdict(best["0.001"], curves)});
  rows.push_back({"Time against step has a minimum within the range.",
                  fmt::format("{} of {} curves have their minimum inside the range", inside, curves),
                  verdict(inside, curves)});
  if (n.steps.size() >= 4)
    rows.push_back({"Time scales roughly as A/h + B h^d.",
                    fmt::format("the fit to each of the {} curves differs by {} at most from a measured time", curves,
                                percent(worst)),
                    worst < 0.1   ? "confirmed"
                    : worst < 0.3 ? "confirmed, roughly"
                                  : "refuted"});
}

void straight_paths(const FinderStudyData& n, Rows& rows) {
  const auto drift = [&](const std::string& path, double step) {
    const Json& last = n.result(fmt::format("drift/{}/{:.6g}", path, step)).at("rows").back();
    return std::fabs(of(last, "mean_guiding_x_r"));
  };
  double finders = 0.0;
  for (const std::string& finder : all_finders())
    finders = std::max(finders, drift(finder, 1e-2));
  const double orbits = of(n.result("drift/straight/0.01").at("rows").back(), "orbits");
  rows.push_back(
      {"Straight paths within a step make a perturbed ring drift (Figure 1).",
       fmt::format(
           "in {:.3g} orbits the mean guiding centre moves by {:.2g}, {:.2g} and {:.2g} r at steps of 1/1000, "
           "3/1000 and 1/100 orbit; in an unperturbed ring by {:.1g} r at 1/100; with any finder by {:.0e} r at "
           "most",
           orbits, drift("straight", 1e-3), drift("straight", 3e-3), drift("straight", 1e-2),
           drift("straight-unperturbed", 1e-2), finders),
       drift("straight", 1e-2) > 10.0 * drift("straight-unperturbed", 1e-2) && finders < 1e-10 ? "confirmed"
                                                                                               : "refuted"});
}

} // namespace

Rows paper_claims(const FinderStudyData& n) {
  Rows rows = {{"claim", "measured", "verdict"}};
  time_in_finder(n, rows);
  ranking(n, rows, "", paper_finders);
  ranking(n, rows, "With newton-full as the paper's code has it and linear-full without its stored start: ",
          {"original", "newton-full-as-coded", "newton-cubic", "linear-full-no-start", "linear-cubic"});
  cubics(n, rows);
  early_exits(n, rows);
  iterations(n, rows);
  steps(n, rows);
  straight_paths(n, rows);
  return rows;
}

} // namespace keeler::study
