#include "measurements.hpp"
#include "numbers.hpp"
#include "study_folder.hpp"

#include <keeler/core/json_of_files.hpp>
#include <keeler/files/files.hpp>
#include <keeler/report/csv.hpp>
#include <keeler/report/document.hpp>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

namespace keeler::study {
namespace {

Json row_of(const FinderStudyData& data, const StudyState& state, double step, const std::string& finder, int repeat) {
  const Json& run = data.result(job_name("run", state.name, step, finder, repeat));
  const Json& audit = data.audit(state.name, step, finder);
  Json row = {
      {"state", state.name}, {"step_orbits", step}, {"finder", finder}, {"repeat", repeat}, {"cpu_s", run.at("cpu_s")}};
  for (const char* key : {"calls", "hits", "missed", "false_hits", "late", "misordered", "evaluations"})
    row[key] = audit.at(key);
  row["ns_per_call"] = run.at("ns_per_call");
  return row;
}

class Report {
public:
  Report(const FinderStudyData& data, bool with_figures)
      : data_(data), document_("The finders' study: the paper's experiment"), with_figures_(with_figures) {}

  void write() {
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
    files::write_text(data_.folder / "report.md", document_.markdown());
    files::write_text(data_.folder / "report.html", document_.html());
  }

private:
  void figure(const std::string& name, const std::string& caption) {
    if (with_figures_ || name == "figure3")
      document_.figure(data_.folder / "figures", name, caption);
  }
  Row head_of_states(const std::string& first, const std::string& after = "") const {
    Row head = {first};
    for (const StudyState& state : data_.states)
      head.push_back(state.name + after);
    return head;
  }

  // Returns a table with a row per finder and a column for each of `columns`.
  template<class Columns, class Cell> static Rows by_finder(const Row& head, const Columns& columns, const Cell& cell) {
    Rows rows = {head};
    for (const std::string& finder : all_finders()) {
      rows.push_back({finder});
      for (const auto& column : columns)
        rows.back().push_back(cell(finder, column));
    }
    return rows;
  }

  void introduction() {
    document_.paragraph(fmt::format(
        "M. C. Lewis, \"Collision Finding for Particles on Non-linear Paths\" (draft), compares five ways to find the "
        "time at which two ring particles touch: {}. This is its experiment, with {} finders: {} states × {} time "
        "steps × {} repeats, each {} orbit, one thread, processor time, medians. All runs of a state start from the "
        "same particles.",
        fmt::join(paper_finders, ", "), all_finders().size(), data_.states.size(), data_.steps.size(), data_.repeats,
        study_orbits));
    document_.paragraph(
        "In the timed runs every candidate pair of the grid is passed to the finder, as in the paper, and self-gravity "
        "is off: it made the clumped states, and its cost is given with them. Sines and cosines are polynomials in the "
        "time since mid-step; the paper's code evaluates full phases with the C library, so trigonometry is cheaper "
        "here.");
    document_.paragraph(made_by(data_.made) +
                        fmt::format(" Half the range of the repeats is {} of their median (median over "
                                    "all timed runs): smaller differences are not significant.",
                                    percent(data_.scatter())));
    if (data_.states.front().patch.size() < 5000)
      document_.paragraph(
          "**This is a small study**: it shows that the measurements work, and is too small for verdicts.");
    Rows rows = {{"state", "how it was made"}};
    for (const StudyState& state : data_.states)
      rows.push_back({state.name, state.made});
    document_.table(rows);
    figure("figure3", "Figure 3: the clumped state of equal particles.");
  }

  void claims() {
    document_.heading("The paper's claims");
    document_.table(paper_claims(data_));
    double full = HUGE_VAL, cubic = HUGE_VAL, missed = 0.0, others_missed = 0.0;
    for (const StudyState& state : data_.states) {
      const double certified = data_.per_call(state.name, "certified");
      full = std::min(full, data_.per_call(state.name, "linear-full") / certified);
      cubic = std::min(cubic, data_.per_call(state.name, "linear-cubic") / certified);
    }
    data_.each_panel([&](const std::string& state, double step) {
      missed += of(data_.audit(state, step, "certified"), "missed");
      others_missed += of(data_.audit(state, step, "linear-full"), "missed");
    });
    document_.paragraph(fmt::format(
        "**The certified finder** in comparison: on identical pairs, at step {}, a call of linear-full takes at least "
        "{:.1f} times and a call of linear-cubic at least {:.1f} times as long, in every state. It missed {:.0f} "
        "contacts in all runs, linear-full {:.0f}.",
        data_.shown_step, full, cubic, missed, others_missed));
  }

  void truth() {
    document_.heading("Errors of each finder");
    document_.paragraph(
        "Every call of an untimed run of each kind was also answered by the certified finder. **missed**: there is a "
        "contact, the finder found none. **false**: there is no contact, or the finder reported it while the spheres "
        "were apart by more than 1e-6 of the radius sum R. **late**: reported after the spheres had overlapped by more "
        "than 1e-6 R, even if they had parted again. **misordered**: particles with a wrong first contact in a step, "
        "by the finder's times. **deepest**: the largest overlap before a contact was reported. **overlap**: the "
        "largest at the end of the run; both in R. Sums over the four states, or the worst of them. The misses of a "
        "run change its later calls, so the numbers of calls differ slightly.");
    for (const double step : data_.steps) {
      const Row keys = {"calls", "true_hits",  "missed",  "false_hits",
                        "late",  "misordered", "deepest", "largest_overlap"};
      document_.table(by_finder({fmt::format("step {:.3g}", step), "calls", "true contacts", "missed", "false", "late",
                                 "misordered", "deepest", "overlap"},
                                keys, [&](const std::string& finder, const std::string& key) {
                                  double sum = 0.0, worst = 0.0;
                                  for (const StudyState& state : data_.states) {
                                    const double value = of(data_.audit(state.name, step, finder), key);
                                    sum += value;
                                    worst = std::max(worst, value);
                                  }
                                  if (key != "deepest" && key != "largest_overlap")
                                    return fmt::format("{:.0f}", sum);
                                  return worst > 0.0 ? fmt::format("{:.0e}", worst) : "0";
                                }));
    }
    double pairs = 0.0, contacts = 0.0, only_scan = 0.0, only_certified = 0.0, other_time = 0.0;
    data_.each_panel([&](const std::string& state, double step) {
      const Json& scan = data_.result(job_name("scan", state, step));
      pairs += of(scan, "pairs"), contacts += of(scan, "contacts"), only_scan += of(scan, "only_scan");
      only_certified += of(scan, "only_certified"), other_time += of(scan, "other_time");
    });
    document_.paragraph(fmt::format(
        "The certified finder was itself compared with a dense scan of the paths (512 times per pair and step, "
        "bisection) on the pairs of the first step of each state and step: {:.0f} pairs, {:.0f} contacts by the "
        "certified finder; {:.0f} found by the scan alone, {:.0f} by the certified finder alone, {:.0f} with times "
        "that differ by more than 1e-6 of the step.",
        pairs, contacts, only_scan, only_certified, other_time));
  }

  void times() {
    document_.heading("Time against time step (Figure 4)");
    figure("figure4",
           "Figure 4: processor time for a tenth of an orbit against the time step, one panel per state: the "
           "paper's five and the certified finder.");
    for (const StudyState& state : data_.states) {
      Row head = {state.name};
      for (const double step : data_.steps)
        head.push_back(fmt::format("step {:.3g}", step));
      document_.table(by_finder(head, data_.steps, [&](const std::string& finder, double step) {
        return number(data_.cpu(state.name, step, finder)) + " s";
      }));
    }
  }

  void calls() {
    document_.heading(fmt::format("The time of a call, step {}", data_.shown_step));
    document_.paragraph(
        "All finders are timed on identical pairs: the grid's candidates at the start of the first step. In brackets, "
        "the ratio to the certified finder's time. Its calls include its rejection by straight lines, which ends "
        "nearly all of them before the search; the last row is its search alone. The work of a finder per particle at "
        "the start of a step is not in these times; the table of the memory below has it.");
    Rows rows =
        by_finder(head_of_states("ns per call"), data_.states, [&](const std::string& finder, const StudyState& state) {
          const double time = data_.per_call(state.name, finder);
          return fmt::format("{:.1f} ({:.1f})", time, time / data_.per_call(state.name, "certified"));
        });
    Row alone = {"certified, its search alone"};
    for (const StudyState& state : data_.states)
      alone.push_back(
          fmt::format("{:.1f}", of(data_.shown("details", state.name), "certified_search_alone_ns_per_call")));
    rows.push_back(alone);
    document_.table(rows);
  }

  void iterations() {
    document_.heading("Iterations and evaluations (Figures 5 and 6)");
    figure("figure5",
           "Figure 5: calls by number of iterations; calls that ended before the loop are left out. Equal sizes, "
           "early, step 1/1000 orbit. A root beyond the step counts as found, as in the paper. Bars are stacked; "
           "the last one holds 51 and more.");
    figure("figure6",
           "Figure 6: calls by number of evaluations of the motion, for the finders on the full motion; the last "
           "bar holds 51 and more.");
    document_.paragraph("\"Gave up\" is rarely a miss: in most of these calls there is no contact.");
    Rows rows = {{"finder", "calls", "receding or overlapping", "hit", "root outside the step", "missed", "gave up",
                  "iterations per hit", "evaluations per hit", "evaluations per call"}};
    for (const std::string& finder : all_finders()) {
      const Json& audit = data_.early(finder);
      const double calls = of(audit, "calls");
      Row row = {finder, fmt::format("{:.0f}", calls)};
      for (const Row& exits :
           {Row{"receding", "overlapping"}, Row{"hit"}, Row{"outside"}, Row{"missed"}, Row{"gave up"}})
        row.push_back(percent(calls_ended(audit, exits) / calls));
      row.push_back(fmt::format("{:.1f}", mean_over(audit, "hit", "iterations")));
      row.push_back(fmt::format("{:.1f}", mean_over(audit, "hit", "evaluations")));
      row.push_back(fmt::format("{:.2f}", of(audit, "evaluations") / calls));
      rows.push_back(row);
    }
    document_.table(rows);
  }

  void caching() {
    document_.heading("Does it pay to store the cubics?");
    Rows rows = {{"state", "step", "newton-cubic: run, cached / fitted", "call, cached / fitted",
                  "linear-cubic: run, cached / fitted", "call, cached / fitted",
                  "linear-cubic-cached / linear-full, run"}};
    data_.each_panel([&](const std::string& state, double step) {
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
    Rows memory = {{"finder", "bytes stored per particle", "rebuilt every step, ns per particle"}};
    const Json& begin = data_.shown("details", data_.states.front().name).at("begin_ns_per_particle");
    for (const auto& [finder, time] : begin.items())
      memory.push_back({finder, fmt::format("{:.0f}", of(data_.early(finder), "bytes_per_particle")),
                        fmt::format("{:.1f}", time.get<double>())});
    document_.table(memory);
  }

  void best_steps() {
    document_.heading("Where is the best step, and does A/h + B h^d hold?");
    if (data_.steps.size() < 4) {
      document_.paragraph("The law has three free parameters: a test needs more steps than this study has.");
      return;
    }
    document_.paragraph(fmt::format(
        "Steps in orbits. The law is fitted to the {} measured steps with d between 0.25 and 4; the largest "
        "error is relative to the measured time.",
        data_.steps.size()));
    Rows rows = {{"state", "finder", "best measured step", "d", "best step of the law", "largest error"}};
    for (const StudyState& state : data_.states)
      for (const std::string& finder : shown_finders()) {
        const std::size_t best = data_.best_step(state.name, finder);
        const StepLaw law = data_.law_of(state.name, finder);
        const bool rises = law.b > 0.0;
        rows.push_back({state.name, finder,
                        fmt::format("{}{:.3g}", best + 1 == data_.steps.size() ? "≥ " : "", data_.steps[best]),
                        !rises          ? "none: B = 0"
                        : law.d < 0.255 ? "≤ 0.25"
                                        : fmt::format("{:.2f}", law.d),
                        rises ? fmt::format("{:.2g}", law.best_step) : "none", percent(law.largest_error)});
      }
    document_.table(rows);
  }

  void local_times() {
    document_.heading("Particles at different local times");
    document_.paragraph(
        "The paper's unfinished question. On the grid's pairs of the early state of equal particles, a fraction of the "
        "particles received a velocity change of 0.2 rΩ per component at a random time of the step, as by an earlier "
        "collision; a search then begins at the later of the pair's two times, and pairs that overlap at that time are "
        "left out. In Keeler all elements refer to one epoch at any time, so no particle must be brought to a common "
        "time; a finder loses only the data that it stored for the start of the step. Wrong answers: missed / false / "
        "late.");
    for (const double step : {1e-3, 1e-2}) {
      Row head = {fmt::format("step {}: ns per call; wrong", step)}, contacts = {"true contacts"};
      for (const double fraction : data_.moved_fractions) {
        head.push_back(fmt::format("{:.0f} % moved", 100.0 * fraction));
        contacts.push_back(fmt::format("{:.0f}", of(data_.local(step, fraction), "true_hits")));
      }
      Rows rows = by_finder(head, data_.moved_fractions, [&](const std::string& finder, double fraction) {
        const auto value = [&](const char* key) { return of(data_.local(step, fraction).at(key), finder); };
        return fmt::format("{:.1f}; {:.0f}/{:.0f}/{:.0f}", value("ns_per_call"), value("missed"), value("false_hits"),
                           value("late"));
      });
      rows.insert(rows.begin() + 1, contacts);
      document_.table(rows);
    }
    figure("local-times",
           "Time per call against the fraction of particles with an earlier velocity change, step 1/1000 orbit.");
  }

  void rejection() {
    document_.heading("A conservative rejection before any finder");
    document_.paragraph(
        "Straight lines from the middle of the step, with a bound on the curvature, prove most misses. The tables show "
        "the pairs that remain, and the runs of step 1/1000 orbit with every candidate passed to the finder and with "
        "the "
        "rejection first: processor time, and in brackets the rank, where differences below 2 % count as none.");
    Rows left = {{"state", "grid candidates, first step", "left", "fraction", "with a contact"}};
    for (const StudyState& state : data_.states) {
      const Json& r = data_.shown("rejection", state.name);
      left.push_back({state.name, fmt::format("{:.0f}", of(r, "candidates")), fmt::format("{:.0f}", of(r, "left")),
                      percent(of(r, "left") / of(r, "candidates")), fmt::format("{:.0f}", of(r, "contacts"))});
    }
    document_.table(left);
    const auto rank = [](const Json& times, const std::string& finder) {
      int position = 1;
      for (const auto& [other, time] : times.items())
        position += 1.02 * time.get<double>() < of(times, finder);
      return position;
    };
    document_.table(by_finder(head_of_states("finder", ", before → after"), data_.states,
                              [&](const std::string& finder, const StudyState& state) {
                                const Json& r = data_.shown("rejection", state.name);
                                const Json &before = r.at("cpu_s_every_candidate"),
                                           &after = r.at("cpu_s_after_rejection");
                                return fmt::format("{:.3g} s ({}.) → {:.3g} s ({}.)", of(before, finder),
                                                   rank(before, finder), of(after, finder), rank(after, finder));
                              }));
  }

  void straight_lines() {
    document_.heading("Straight paths drift, curved ones do not (Figures 1 and 2)");
    document_.paragraph("A ring of 1000 spheres (τ = 0.3) with streamlines that bunch once per orbit, q = 0.6; "
                        "Keeler's `docs/theory/straight-lines.md` describes it. The table has the drift of the mean "
                        "guiding centre and of the mean vertical motion, in particle radii; exact collisions conserve "
                        "both.");
    Rows rows = {{"path", "step", "orbits", "drift in x", "vertical drift", "collisions per particle"}};
    for (const auto& [name, result] : data_.results) {
      if (!name.starts_with("drift/"))
        continue;
      const Json& last = result.at("rows").back();
      rows.push_back({result.at("path").get<std::string>(), number(of(result, "step_orbits")),
                      number(of(last, "orbits")), fmt::format("{:.2e}", of(last, "mean_guiding_x_r")),
                      fmt::format("{:.2e}", of(last, "mean_vertical_r")), number(of(last, "collisions_per_particle"))});
    }
    document_.table(rows);
    figure("figure1", "Figure 1: drift of the means over time; all finders lie on the zero line.");
    figure("figure2", "Figure 2: distance of the surfaces in a hit, a graze and a miss.");
  }

  const FinderStudyData& data_;
  report::Document document_;
  bool with_figures_;
};

} // namespace

void write_finder_tables(const FinderStudyData& data) {
  Json rows = Json::array();
  for (int repeat = 0; repeat < data.repeats; ++repeat)
    for (const StudyState& state : data.states)
      for (const double step : data.steps)
        for (const std::string& finder : all_finders())
          rows.push_back(row_of(data, state, step, finder, repeat));
  files::write_text(data.folder / "finders.csv", report::csv_of(rows));

  Json other = Json::object(); // all other measurements, by job name
  for (const auto& [name, result] : data.results)
    if (!name.starts_with("run/"))
      other[name] = result;
  files::write_text(data.folder / "finders.json",
                    json_text(Json{{"made", data.made}, {"rows", rows}, {"measurements", other}}, 1) + "\n");
}

void write_finder_report(const FinderStudyData& data, bool with_figures) {
  Report(data, with_figures).write();
}

} // namespace keeler::study
