// Results of a study of a scene: the numbers of each run, and the means of each setting.
#pragma once

#include "runs.hpp"

#include <keeler/statistics/scatter.hpp>

#include <nlohmann/json.hpp>

#include <optional>
#include <string>
#include <vector>

namespace keeler {

using Json = nlohmann::ordered_json;

/// A number that is measured in each run: a column of the tables.
struct StudyNumber {
  std::string column;
  std::string meaning; ///< with its unit
  std::string title;   ///< in the report; empty: only in the tables
  bool compared;       ///< true for physics: its means are compared with the reference's
};

/// Returns the numbers of every study in the order of the columns: cost and health, transmission, sweep quantities.
const std::vector<StudyNumber>& study_numbers();

/// Returns these numbers with further quantities after them.
std::vector<StudyNumber> study_numbers(const RunQuantities& quantities);

/// Returns the index of a column in study_numbers(). Precondition: there is such a column.
std::size_t number_at(const std::string& column);

/// A run with one setting, and its measured numbers.
struct SettingRun {
  const PlannedRun* run = nullptr;
  bool finished = false;                     ///< and measured
  bool measurable = true;                    ///< false: it finished, but its files cannot be read
  std::string reason;                        ///< of the failure, or of why it could not be measured
  std::vector<std::optional<double>> values; ///< in the order of study_numbers(plan.quantities), or empty
};

/// Measures the finished runs. The results point into `runs`, which must outlive them.
std::vector<SettingRun> measure_runs(const StudyPlan& plan, const std::vector<PlannedRun>& runs,
                                     const RunFolders& folders);

/// A setting: its numbers over the seeds, in the order of StudyMeans::numbers, and their differences from the
/// reference.
struct SettingMeans {
  std::string name;
  std::size_t finished = 0;
  std::vector<Scatter> scatter;
  std::vector<MeanDifference> from_reference; ///< known() is false if not compared, and for the reference
};

struct StudyMeans {
  std::vector<StudyNumber> numbers;
  std::vector<SettingMeans> settings;
  std::size_t reference = 0;
};

/// Computes means and differences. Without choices.reference the setting with the smallest force error is the
/// reference. Precondition: there is at least one choice; the values of a run are empty or in the order of `numbers`.
StudyMeans means_of(const StudyChoices& choices, const std::vector<SettingRun>& runs,
                    const std::vector<StudyNumber>& numbers = study_numbers());

/// Return the rows as objects keyed by column; unknown values are null.
Json runs_as_json(const StudyPlan& plan, const std::vector<SettingRun>& runs);
Json means_as_json(const StudyMeans& means);

} // namespace keeler
