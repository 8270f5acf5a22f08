// Output of a study of a scene: tables, the figure of error against cost, report.md and report.html.
#pragma once

#include "results.hpp"

#include <filesystem>
#include <map>
#include <string>
#include <vector>

namespace keeler::study {

/// Writes study.csv, one row per run, and settings.csv, one row per setting.
void write_study_tables(const StudyPlan& plan, const std::vector<batch::RunRow>& runs, const StudyMeans& means,
                        const std::filesystem::path& folder);

/// Draws figures/pareto. Returns false if no setting has the number that it shows.
bool draw_study_figure(const StudyPlan& plan, const StudyMeans& means, const std::filesystem::path& folder);

/// Writes report.md and report.html. `made` is study_provenance().
void write_study_report(const StudyPlan& plan, const std::vector<batch::RunRow>& runs, const StudyMeans& means,
                        const std::map<std::string, std::string>& made, const std::filesystem::path& folder,
                        bool with_figure);

} // namespace keeler::study
