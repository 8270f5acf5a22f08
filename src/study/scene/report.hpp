// What a study of a scene writes: tables, the picture of error against cost, report.md and report.html.
#pragma once

#include "results.hpp"

#include <filesystem>
#include <map>
#include <string>
#include <vector>

namespace keeler {

/// Writes study.csv, a row a run, and settings.csv, a row a setting.
void write_study_tables(const StudyPlan& plan, const std::vector<SettingRun>& runs, const StudyMeans& means,
                        const std::filesystem::path& folder);

/// Draws figures/pareto. Returns false when there is no gnuplot; its data are then written alone.
bool draw_study_figure(const StudyPlan& plan, const StudyMeans& means, const std::filesystem::path& folder);

/// Writes report.md and report.html. `made`: who measures, as study_builder() says.
void write_study_report(const StudyPlan& plan, const std::vector<SettingRun>& runs, const StudyMeans& means,
                        const std::map<std::string, std::string>& made, const std::filesystem::path& folder,
                        bool with_figure);

} // namespace keeler
