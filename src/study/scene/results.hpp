// What came of the runs of a study of a scene: numbers a run, and their means a setting.
#pragma once

#include "runs.hpp"

#include <keeler/statistics/scatter.hpp>

#include <nlohmann/json.hpp>

#include <optional>
#include <string>
#include <vector>

namespace keeler {

using Json = nlohmann::ordered_json;

/// A number of a run: a column of the tables.
struct StudyNumber {
  std::string column;
  std::string meaning; ///< with its unit
  std::string title;   ///< in the report; empty: it stands in the tables alone
  bool compared;       ///< physics: its means are held against the reference's
};

/// In the order of the columns. Cost and health first, then transmission and what sweeps measure.
const std::vector<StudyNumber>& study_numbers();

/// With others behind them.
std::vector<StudyNumber> study_numbers(const RunQuantities& quantities);

/// The place of a column.
std::size_t number_at(const std::string& column);

/// A run with a setting, and what is known of it.
struct SettingRun {
  const PlannedRun* run = nullptr;
  bool finished = false;                     ///< and measured
  bool measurable = true;                    ///< false: it came to its end, but its files cannot be read
  std::string reason;                        ///< why it failed, or could not be measured
  std::vector<std::optional<double>> values; ///< in the order of study_numbers(plan.quantities); empty: none is known
};

/// Measures the finished runs. They belong to the list.
std::vector<SettingRun> measure_runs(const StudyPlan& plan, const std::vector<PlannedRun>& runs,
                                     const RunFolders& folders);

/// A setting: its numbers over the seeds, in the order of StudyMeans::numbers, and held against the reference.
struct SettingMeans {
  std::string name;
  std::size_t finished = 0;
  std::vector<Scatter> scatter;
  std::vector<MeanDifference> from_reference; ///< not known where it is not compared, and of the reference itself
};

struct StudyMeans {
  std::vector<StudyNumber> numbers;
  std::vector<SettingMeans> settings;
  std::size_t reference = 0;
};

/// The reference is the given setting; none: the one with the smallest force error.
StudyMeans means_of(const StudyChoices& choices, const std::vector<SettingRun>& runs,
                    const std::vector<StudyNumber>& numbers = study_numbers());

/// As objects, a column a name; what is not known is null.
Json runs_as_json(const StudyPlan& plan, const std::vector<SettingRun>& runs);
Json means_as_json(const StudyMeans& means);

} // namespace keeler
