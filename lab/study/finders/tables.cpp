#include "measurements.hpp"
#include "report.hpp"
#include "study_folder.hpp"

#include <keeler/core/json_of_files.hpp>
#include <keeler/files/files.hpp>
#include <keeler/report/csv.hpp>

#include <fmt/format.h>

namespace keeler {
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

} // namespace

void write_finder_tables(const FinderStudyData& data) {
  Json rows = Json::array();
  for (int repeat = 0; repeat < data.repeats; ++repeat)
    for (const StudyState& state : data.states)
      for (const double step : data.steps)
        for (const std::string& finder : all_finders())
          rows.push_back(row_of(data, state, step, finder, repeat));
  write_text(data.folder / "finders.csv", csv_of(rows));

  Json other = Json::object(); // all other measurements, by job name
  for (const auto& [name, result] : data.results)
    if (!name.starts_with("run/"))
      other[name] = result;
  write_text(data.folder / "finders.json",
             json_text(Json{{"made", data.made}, {"rows", rows}, {"measurements", other}}, 1) + "\n");
}

} // namespace keeler
