// Results of a study of a scene: the numbers of each run, and the means of each setting.
#pragma once

#include "runs.hpp"

#include <keeler/batch/rows.hpp>

#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace keeler::study {

struct FinishedRun; ///< the data read from a run

/// A number that is measured in each run: a column of the tables.
struct StudyNumber {
  std::string column;
  std::string title; ///< in the report; empty: only in the tables
  bool compared;     ///< true for physics: its means are compared with the reference's
  std::function<std::optional<double>(const FinishedRun&)> read; ///< empty: the next one of RunQuantities
};

/// Returns the numbers of every study in the order of the columns: cost and health, transmission, sweep quantities.
const std::vector<StudyNumber>& study_numbers();

/// Returns these numbers with the plan's further quantities after them, then the cost of a kick where solvers are
/// compared.
std::vector<StudyNumber> study_numbers(const StudyPlan& plan);

/// Returns the index of a column in study_numbers(). Precondition: there is such a column.
std::size_t number_at(const std::string& column);

/// Measures the finished runs: values without errors, in the order of study_numbers(plan). Unfinished runs count as
/// failed. The rows refer to `runs`.
std::vector<batch::RunRow> measure_runs(const StudyPlan& plan, const std::vector<batch::PlannedRun>& runs,
                                        const batch::RunFolders& folders);

/// A setting: its numbers over the seeds, in the order of StudyMeans::numbers, and their differences from the
/// reference.
struct SettingMeans : batch::PointRow {
  std::string name;
  std::vector<statistics::MeanDifference> from_reference; ///< known() is false if not compared, and for the reference
};

struct StudyMeans {
  std::vector<StudyNumber> numbers;
  std::vector<SettingMeans> settings;
  std::size_t reference = 0;
};

/// Computes means and differences. Without choices.reference the setting with the smallest force error is the
/// reference. Precondition: there is at least one choice; the values of a run are in the order of `numbers`.
StudyMeans means_of(const StudyChoices& choices, const std::vector<batch::RunRow>& runs,
                    const std::vector<StudyNumber>& numbers = study_numbers());

/// Return the rows as objects keyed by column; unknown values are null.
batch::Json runs_as_json(const StudyPlan& plan, const std::vector<batch::RunRow>& runs);
batch::Json means_as_json(const StudyMeans& means);

} // namespace keeler::study
