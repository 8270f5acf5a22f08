#include "finder_report.hpp"

#include "document.hpp"
#include "measurements.hpp"
#include "step_law.hpp"

#include <keeler/io/files.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <numeric>

namespace keeler {
namespace {

using Row = std::vector<std::string>;
using Rows = std::vector<Row>;

std::string number(double value) {
  return fmt::format("{:.3g}", value);
}

std::string percent(double share) {
  return share != 0.0 && share < 0.001 ? fmt::format("{:.2g} %", 100.0 * share)
                                       : fmt::format("{:.1f} %", 100.0 * share);
}

double of(const Json& json, const char* key) {
  return json.at(key).get<double>();
}

// Calls of an audited run that ended for these reasons.
double calls_ended(const Json& audit, const std::vector<std::string>& exits) {
  double sum = 0.0;
  for (const std::string& exit : exits)
    if (audit.at("exits").contains(exit))
      sum += of(audit.at("exits").at(exit), "calls");
  return sum;
}

// Share of the calls with these exits that took `least` iterations or more.
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

double mean_from(const Json& audit, const std::string& exit, const char* field) {
  if (!audit.at("exits").contains(exit))
    return 0.0;
  const Json& calls = audit.at("exits").at(exit);
  double sum = 0.0;
  for (std::size_t k = 0; k < calls.at(field).size(); ++k)
    sum += static_cast<double>(k) * calls.at(field)[k].get<double>();
  return sum / of(calls, "calls");
}

class Report {
public:
  explicit Report(const FinderStudyData& data) : data_(data), document_("The finders' study: the paper's experiment") {}

  void write(bool with_figures) {
    with_figures_ = with_figures;
    introduction();
    claims();
    truth();
    times();
    calls();
    iterations();
    caching();
    best_steps();
    local_times();
    rejection();
    straight_lines();
    write_text(data_.folder / "report.md", document_.markdown());
    write_text(data_.folder / "report.html", document_.html());
  }

private:
  double cpu(const std::string& state, double step, const std::string& finder) const {
    return data_.timed(state, step, finder, "cpu_s");
  }
  double per_call(const std::string& state, double step, const std::string& finder) const {
    return data_.timed(state, step, finder, "ns_per_call");
  }
  // Calls × time of a call, of the whole run's time.
  double finder_share(const std::string& state, double step, const std::string& finder) const {
    return 1e-9 * of(data_.audit(state, step, finder), "calls") * per_call(state, step, finder) /
           cpu(state, step, finder);
  }
  const Json& early(const std::string& finder) const {
    return data_.audit(data_.states.front().name, data_.shown_step, finder);
  }
  template<class Visit> void each_panel(const Visit& visit) const { // state × step
    for (const StudyState& state : data_.states)
      for (const double step : data_.steps)
        visit(state.name, step);
  }
  void figure(const std::string& name, const std::string& caption) {
    if (with_figures_ || name == "figure3")
      document_.figure(data_.folder / "figures", name, caption);
  }

  void introduction();
  void claims();
  void ranking_claims(Rows& rows, const std::string& forms, const std::vector<std::string>& five);
  void truth();
  void times();
  void calls();
  void iterations();
  void caching();
  void best_steps();
  void local_times();
  void rejection();
  void straight_lines();

  const FinderStudyData& data_;
  Document document_;
  bool with_figures_ = false;
};

void Report::introduction() {
  document_.paragraph(fmt::format(
      "M. C. Lewis, \"Collision Finding for Particles on Non-linear Paths\" (draft), compares five ways to find the "
      "time "
      "at which two ring particles touch. This is its experiment, carried out by `{}` on {}, commit {}: {} states × {} "
      "time steps × {} finders × {} repeats, each {} orbit, one thread, processor time, medians. In the timed runs "
      "every "
      "pair that the grid's cells hold goes to the finder, as in the paper, and self-gravity is off: it made the "
      "clumped "
      "states, and its cost is given apart, with the states. All runs of a state start from the same particles. Sines "
      "and "
      "cosines come from the program's own polynomials, which are cheaper than a C library's: the price of "
      "trigonometry is "
      "understated here against the paper.",
      data_.command, data_.host, data_.commit, data_.states.size(), data_.steps.size(), all_finders().size(),
      data_.repeats, study_orbits));
  Rows rows = {{"state", "how it was made"}};
  for (const StudyState& state : data_.states)
    rows.push_back({state.name, state.made});
  document_.table(rows);
  figure("figure3", "Figure 3: the clumped state of equal particles.");
}

// Who is first and last of five finders, the fourth of which is the linear one on the full motion.
void Report::ranking_claims(Rows& rows, const std::string& forms, const std::vector<std::string>& five) {
  int first = 0, last = 0, panels = 0;
  double worst_ratio = 0.0;
  std::map<std::string, int> others;
  each_panel([&](const std::string& state, double step) {
    std::vector<std::pair<double, std::string>> order;
    for (const std::string& finder : five)
      order.emplace_back(cpu(state, step, finder), finder);
    std::sort(order.begin(), order.end());
    ++panels;
    first += order.front().second == five[3];
    last += order.back().second == "original" || order.back().second == "newton-cubic";
    ++others[order.back().second];
    worst_ratio = std::max(worst_ratio, cpu(state, step, five[3]) / order.front().first);
  });
  const auto verdict = [&](int count) {
    return count == panels ? "confirmed" : 2 * count > panels ? "confirmed in most panels" : "refuted";
  };
  rows.push_back(
      {"linear-full is the fastest across the board." + forms,
       fmt::format("fastest of the five in {} of {} panels (state × step), at worst {:.2f} times the fastest", first,
                   panels, worst_ratio),
       verdict(first)});
  std::string places;
  for (const auto& [finder, count] : others)
    places += fmt::format("{}{} {} times", places.empty() ? "" : ", ", finder, count);
  rows.push_back({"original and newton-cubic compete for the last place." + forms,
                  fmt::format("one of them is last in {} of {} panels (last: {})", last, panels, places),
                  verdict(last)});
}

void Report::claims() {
  document_.heading("The paper's claims");
  Rows rows = {{"claim", "measured", "verdict"}};

  double least_share = 1.0, most_share = 0.0;
  for (const StudyState& state : data_.states)
    for (const std::string& finder : paper_finders) {
      const double share = finder_share(state.name, data_.shown_step, finder);
      least_share = std::min(least_share, share);
      most_share = std::max(most_share, share);
    }
  rows.push_back(
      {"Over 90 % of the run time is in the finder.",
       fmt::format("{}–{} at step {}, over states and the paper's five finders (calls × time of a call, of the "
                   "drift's time)",
                   percent(least_share), percent(most_share), data_.shown_step),
       most_share > 0.9 ? "confirmed in part" : "refuted for this code"});

  ranking_claims(rows, "", paper_finders);
  ranking_claims(rows, " With newton-full as its code stood, and linear-full without its stored start:",
                 {"original", "newton-full-as-coded", "newton-cubic", "linear-full-no-start", "linear-cubic"});

  int panels = 0, newton_loses = 0, linear_loses = 0, cached_newton = 0, cached_linear = 0;
  each_panel([&](const std::string& state, double step) {
    ++panels;
    newton_loses += cpu(state, step, "newton-cubic") > cpu(state, step, "newton-full");
    linear_loses += cpu(state, step, "linear-cubic") > cpu(state, step, "linear-full");
    cached_newton += cpu(state, step, "newton-cubic-cached") < cpu(state, step, "newton-cubic");
    cached_linear += cpu(state, step, "linear-cubic-cached") < cpu(state, step, "linear-cubic");
  });
  rows.push_back(
      {"Cubic methods are slower than their counterparts with the full motion.",
       fmt::format("newton-cubic is slower than newton-full in {} of {} panels, linear-cubic than linear-full "
                   "in {}",
                   newton_loses, panels, linear_loses),
       newton_loses == panels && linear_loses == panels ? "confirmed"
       : newton_loses + linear_loses > panels           ? "confirmed for most"
                                                        : "refuted"});
  rows.push_back({"Cubics kept for each particle would do better (speculation).",
                  fmt::format("the cached form is faster in {} of {} panels for Newton, in {} for linear",
                              cached_newton, panels, cached_linear),
                  cached_newton + cached_linear == 2 * panels ? "confirmed" : "confirmed in part"});

  std::string receding;
  double least_receding = 1.0;
  for (const std::string& finder : paper_finders) {
    const double share = calls_ended(early(finder), {"receding", "overlapping"}) / of(early(finder), "calls");
    least_receding = std::min(least_receding, share);
    receding += fmt::format("{}{} {}", receding.empty() ? "" : ", ", finder, percent(share));
  }
  rows.push_back(
      {"Most calls end at once, because the particles recede.",
       fmt::format("calls that end before the loop, equal sizes, early, step {}: {}", data_.shown_step, receding),
       least_receding > 0.5 ? "confirmed" : "refuted"});

  const double original = share_from(early("original"), {"hit"}, 20);
  double others = 1.0;
  for (const std::string& finder : paper_finders)
    if (finder != "original")
      others = std::min(others, 1.0 - share_from(early(finder), {"hit"}, 6));
  rows.push_back(
      {"The original method needs some twenty iterations for a collision, the others five or fewer.",
       fmt::format("original: {} of its hits take 20 or more (mean {:.1f}); the others: at least {} take five "
                   "or fewer",
                   percent(original), mean_from(early("original"), "hit", "iterations"), percent(others)),
       original > 0.5 && others > 0.9 ? "confirmed" : "refuted"});

  const auto tail = [&](const char* finder) { return share_from(early(finder), {"missed", "gave up"}, 6); };
  rows.push_back(
      {"Linear methods have a low tail of many iterations where there is no collision.",
       fmt::format("of the calls that enter the loop and find nothing, more than five iterations: linear-full "
                   "{}, linear-cubic {}, newton-full {}",
                   percent(tail("linear-full")), percent(tail("linear-cubic")), percent(tail("newton-full"))),
       tail("linear-full") > 10.0 * tail("newton-full") ? "confirmed" : "refuted"});

  const auto evaluations = [&](const char* finder) {
    return of(early(finder), "evaluations") / std::max(1.0, of(early(finder), "iterations"));
  };
  rows.push_back(
      {"Newton's method spends its time scaling steps back, the linear one does not.",
       fmt::format("evaluations an iteration: newton-full {:.2f}, as coded {:.2f}, linear-full {:.2f}",
                   evaluations("newton-full"), evaluations("newton-full-as-coded"), evaluations("linear-full")),
       evaluations("newton-full") > 1.5 * evaluations("linear-full") ? "confirmed" : "refuted"});
  document_.table(rows);
}

void Report::truth() {
  document_.heading("Truth: what each finder missed");
  document_.paragraph(
      "Every call of an untimed run of each kind was also answered by the certified finder. **missed**: there is a "
      "contact, the finder found none. **false**: there is none, or it was called while the spheres were apart by more "
      "than 1e-6 of the radius sum R. **late**: called when they were inside each other by more than 1e-6 R. "
      "**misordered**: particles whose first contact of a step, by the finder's times, is not the first. **overlap**: "
      "the "
      "deepest at the end, in R. Sums over the four states.");
  for (const double step : data_.steps) {
    Rows rows = {{fmt::format("step {:.3g}", step), "calls", "true contacts", "missed", "false", "late", "misordered",
                  "deepest"}};
    for (const std::string& finder : all_finders()) {
      Row row = {finder};
      for (const char* key : {"calls", "true_hits", "missed", "false_hits", "late", "misordered"}) {
        double sum = 0.0;
        for (const StudyState& state : data_.states)
          sum += of(data_.audit(state.name, step, finder), key);
        row.push_back(fmt::format("{:.0f}", sum));
      }
      double deepest = 0.0;
      for (const StudyState& state : data_.states)
        deepest = std::max(deepest, of(data_.audit(state.name, step, finder), "deepest"));
      row.push_back(fmt::format("{:.1e}", deepest));
      rows.push_back(row);
    }
    document_.table(rows);
  }
  double pairs = 0.0, contacts = 0.0, only_scan = 0.0, only_certified = 0.0, other_time = 0.0;
  each_panel([&](const std::string& state, double step) {
    const Json& scan = data_.result(job_name("scan", state, step));
    pairs += of(scan, "pairs"), contacts += of(scan, "contacts"), only_scan += of(scan, "only_scan");
    only_certified += of(scan, "only_certified"), other_time += of(scan, "other_time");
  });
  document_.paragraph(fmt::format(
      "The truth was itself held against a dense scan of the paths (512 times a pair and step, bisection) on the pairs "
      "of "
      "the first step of each state and step: {:.0f} pairs, {:.0f} contacts by the certified finder; {:.0f} found by "
      "the "
      "scan alone, {:.0f} by the certified finder alone, {:.0f} with times that differ by more than 1e-6 of the step.",
      pairs, contacts, only_scan, only_certified, other_time));
}

void Report::times() {
  document_.heading("Time against time step (Figure 4)");
  figure("figure4", "Figure 4: processor time for a tenth of an orbit against the time step, one panel a state.");
  for (const StudyState& state : data_.states) {
    Row head = {state.name};
    for (const double step : data_.steps)
      head.push_back(fmt::format("step {:.3g}", step));
    Rows rows = {head};
    for (const std::string& finder : all_finders()) {
      Row row = {finder};
      for (const double step : data_.steps)
        row.push_back(number(cpu(state.name, step, finder)) + " s");
      rows.push_back(row);
    }
    document_.table(rows);
  }
}

void Report::calls() {
  document_.heading(fmt::format("The time of a call, step {}", data_.shown_step));
  document_.paragraph(
      "Every finder asked about the very same pairs: those that the grid hands out at the start of the first "
      "step. In brackets, how many times the certified finder's time that is.");
  Row head = {"ns a call"};
  for (const StudyState& state : data_.states)
    head.push_back(state.name);
  Rows rows = {head};
  for (const std::string& finder : all_finders()) {
    Row row = {finder};
    for (const StudyState& state : data_.states) {
      const double own = per_call(state.name, data_.shown_step, finder);
      row.push_back(fmt::format("{:.1f} ({:.1f})", own, own / per_call(state.name, data_.shown_step, "certified")));
    }
    rows.push_back(row);
  }
  document_.table(rows);
}

void Report::iterations() {
  document_.heading("Iterations and evaluations (Figures 5 and 6)");
  figure("figure5",
         "Figure 5: calls by number of iterations; calls that ended before the loop are left out. Equal sizes, "
         "early, step 1/1000 orbit. A root beyond the step counts as found, as in the paper.");
  figure("figure6", "Figure 6: calls by number of evaluations of the motion, for the finders on the full motion.");
  Rows rows = {{"finder", "calls", "receding or overlapping", "hit", "root outside the step", "missed", "gave up",
                "iterations a hit", "evaluations a hit", "evaluations a call"}};
  for (const std::string& finder : all_finders()) {
    const Json& audit = early(finder);
    const double calls = of(audit, "calls");
    Row row = {finder, fmt::format("{:.0f}", calls)};
    for (const std::vector<std::string>& exits :
         {Row{"receding", "overlapping"}, Row{"hit"}, Row{"outside"}, Row{"missed"}, Row{"gave up"}})
      row.push_back(percent(calls_ended(audit, exits) / calls));
    row.push_back(fmt::format("{:.1f}", mean_from(audit, "hit", "iterations")));
    row.push_back(fmt::format("{:.1f}", mean_from(audit, "hit", "evaluations")));
    row.push_back(fmt::format("{:.2f}", of(audit, "evaluations") / calls));
    rows.push_back(row);
  }
  document_.table(rows);
}

void Report::caching() {
  document_.heading("Does it pay to keep the cubics?");
  Rows rows = {{"state", "step", "newton-cubic: run, cached / fitted", "call, cached / fitted",
                "linear-cubic: run, cached / fitted", "call, cached / fitted",
                "linear-cubic-cached / linear-full, run"}};
  each_panel([&](const std::string& state, double step) {
    const auto ratio = [&](const char* a, const char* b, const char* field) {
      return fmt::format("{:.2f}", data_.timed(state, step, a, field) / data_.timed(state, step, b, field));
    };
    rows.push_back({state, fmt::format("{:.3g}", step), ratio("newton-cubic-cached", "newton-cubic", "cpu_s"),
                    ratio("newton-cubic-cached", "newton-cubic", "ns_per_call"),
                    ratio("linear-cubic-cached", "linear-cubic", "cpu_s"),
                    ratio("linear-cubic-cached", "linear-cubic", "ns_per_call"),
                    ratio("linear-cubic-cached", "linear-full", "cpu_s")});
  });
  document_.table(rows);
  Rows memory = {{"finder", "bytes kept for each particle"}};
  for (const std::string& finder : all_finders())
    if (const double bytes = of(early(finder), "bytes_per_particle"); bytes > 0.0)
      memory.push_back({finder, fmt::format("{:.0f}", bytes)});
  document_.table(memory);
}

void Report::best_steps() {
  document_.heading("Where is the best step, and does A/h + B h^d hold?");
  document_.paragraph(
      "Best of the measured steps, and the law fitted to them: its exponent, the step at which it is least, "
      "its largest relative error at the measured steps. With five steps and three free numbers an error "
      "of some per cent is the least to ask.");
  Rows rows = {{"state", "finder", "best measured step", "d", "best step of the law", "largest error"}};
  for (const StudyState& state : data_.states)
    for (const std::string& finder : shown_finders()) {
      std::vector<double> t;
      for (const double step : data_.steps)
        t.push_back(cpu(state.name, step, finder));
      const auto best = static_cast<std::size_t>(std::min_element(t.begin(), t.end()) - t.begin());
      const StepLaw law = fit_step_law(data_.steps, t);
      rows.push_back({state.name, finder, fmt::format("{:.3g}", data_.steps[best]), fmt::format("{:.2f}", law.d),
                      law.best_step > 0.0 ? fmt::format("{:.2g}", law.best_step) : "none", percent(law.largest_error)});
    }
  document_.table(rows);
}

void Report::local_times() {
  document_.heading("Particles at different local times");
  document_.paragraph(
      "The paper's unfinished question. On the grid's pairs of the early state of equal particles, a share of the "
      "particles "
      "was given a velocity change of 0.2 rΩ a component at a random time of the step, as earlier collisions would; a "
      "search then begins at the later of two such times. Here all elements stand at one epoch whatever happened, so "
      "nothing needs to be brought to a common time; what a finder loses is what it kept for the step's start.");
  const std::string& state = data_.states.front().name;
  for (const double step : {1e-3, 1e-2}) {
    Row head = {fmt::format("step {}: ns a call", step)};
    for (const double share : data_.shares)
      head.push_back(fmt::format("{:.0f} % moved", 100.0 * share));
    head.emplace_back("missed + false + late, by share");
    Rows rows = {head};
    for (const std::string& finder : all_finders()) {
      Row row = {finder};
      std::string wrong;
      for (const double share : data_.shares) {
        const Json& m = data_.result(fmt::format("local/{}/{:.6g}/{}", state, step, share));
        row.push_back(fmt::format("{:.1f}", of(m.at("ns_per_call"), finder.c_str())));
        wrong += fmt::format("{}{:.0f}", wrong.empty() ? "" : ", ",
                             of(m.at("missed"), finder.c_str()) + of(m.at("false_hits"), finder.c_str()) +
                                 of(m.at("late"), finder.c_str()));
      }
      row.push_back(wrong);
      rows.push_back(row);
    }
    document_.table(rows);
  }
  figure("local-times", "Time of a call against the share of particles that have already moved, step 1/1000 orbit.");
}

void Report::rejection() {
  document_.heading("A conservative rejection before any finder");
  document_.paragraph(
      "Straight lines from the middle of the step, with all that curvature can add, prove most misses. What it "
      "leaves, and the runs of step 1/1000 orbit with every candidate in the finder's hands and with the "
      "rejection first (processor time; rank).");
  Rows left = {{"state", "grid candidates, first step", "left", "share", "with a contact"}};
  for (const StudyState& state : data_.states) {
    const Json& r = data_.result(job_name("rejection", state.name, 1e-3));
    left.push_back({state.name, fmt::format("{:.0f}", of(r, "candidates")), fmt::format("{:.0f}", of(r, "left")),
                    percent(of(r, "left") / of(r, "candidates")), fmt::format("{:.0f}", of(r, "contacts"))});
  }
  document_.table(left);
  Row head = {"finder"};
  for (const StudyState& state : data_.states)
    head.push_back(state.name + ", before → after");
  Rows rows = {head};
  const auto rank = [](const Json& times, const std::string& finder) {
    int place = 1;
    for (const auto& [other, time] : times.items())
      place += time.get<double>() < of(times, finder.c_str());
    return place;
  };
  for (const std::string& finder : all_finders()) {
    Row row = {finder};
    for (const StudyState& state : data_.states) {
      const Json& r = data_.result(job_name("rejection", state.name, 1e-3));
      const Json &before = r.at("cpu_s_every_candidate"), &after = r.at("cpu_s_after_rejection");
      row.push_back(fmt::format("{:.3g} s ({}.) → {:.3g} s ({}.)", of(before, finder.c_str()), rank(before, finder),
                                of(after, finder.c_str()), rank(after, finder)));
    }
    rows.push_back(row);
  }
  document_.table(rows);
}

void Report::straight_lines() {
  document_.heading("Straight paths drift, curved ones do not (Figures 1 and 2)");
  document_.paragraph(
      "A ring whose streamlines bunch once an orbit (see `docs/theory/straight-lines.md`): the drift of the mean "
      "guiding centre and of the mean vertical motion, in particle radii. Collisions keep both exactly.");
  Rows rows = {{"path", "step", "orbits", "drift in x", "vertical drift", "collisions a particle"}};
  for (const auto& [name, result] : data_.results) {
    if (!name.starts_with("drift/"))
      continue;
    const Json& last = result.at("rows").back();
    rows.push_back({result.at("path").get<std::string>(), number(of(result, "step_orbits")), number(of(last, "orbits")),
                    fmt::format("{:.2e}", of(last, "mean_guiding_x_r")),
                    fmt::format("{:.2e}", of(last, "mean_vertical_r")), number(of(last, "collisions_per_particle"))});
  }
  document_.table(rows);
  figure("figure1", "Figure 1: drift of the means over time; all finders lie on the zero line.");
  figure("figure2", "Figure 2: distance of the surfaces in a hit, a graze and a miss.");
}

} // namespace

void write_finder_report(const FinderStudyData& data, bool with_figures) {
  Report(data).write(with_figures);
}

} // namespace keeler
