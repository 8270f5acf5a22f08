#include "scene/verdict.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <deque>

namespace verdict_test {

using namespace keeler;
using namespace keeler::study;

namespace {

// Made-up runs of some settings with three seeds; the reference is the first setting.
class MadeUp {
public:
  // Adds three seeds with the values mean − deviation, mean, mean + deviation.
  void add(const std::string& name, double cpu, double balance, double balance_deviation, double dispersion,
           double force_error = 1e-3) {
    choices_.choices.push_back({name, {}});
    for (const double side : {-1.0, 0.0, 1.0}) {
      batch::PlannedRun& planned = planned_.emplace_back();
      planned.point = choices_.choices.size() - 1;
      batch::RunRow& run = runs_.emplace_back();
      run.run = &planned;
      run.status = batch::RunStatus::finished;
      std::vector<std::optional<Estimate>>& values = run.numbers.emplace().values;
      values.resize(study_numbers().size());
      values[number_at("cpu_s_per_orbit")] = {cpu, 0.0};
      values[number_at("energy_balance")] = {balance + side * balance_deviation, 0.0};
      values[number_at("dispersion_x_m_s")] = {dispersion * (1.0 + 0.01 * side), 0.0};
      values[number_at("force_error")] = {force_error, 0.0};
    }
  }

  void fail_last() {
    runs_.back().status = batch::RunStatus::failed;
    runs_.back().numbers.reset();
  }

  StudyMeans means(std::optional<std::size_t> reference = 0) {
    choices_.reference = reference;
    return means_of(choices_, runs_);
  }

private:
  StudyChoices choices_;
  std::deque<batch::PlannedRun> planned_;
  std::vector<batch::RunRow> runs_;
};

} // namespace

TEST_CASE("means and differences of settings have Student's intervals") {
  MadeUp study;
  study.add("fine", 8.0, 1.0, 0.001, 5.0);
  study.add("coarse", 2.0, 1.01, 0.002, 5.0);
  const StudyMeans means = study.means();
  const std::size_t balance = number_at("energy_balance");
  CHECK(mean_bound(means.settings[0].scatter[balance]) == doctest::Approx(4.303 * 0.001 / std::sqrt(3.0)));
  const statistics::MeanDifference& d = means.settings[1].from_reference[balance];
  CHECK(d.difference == doctest::Approx(0.01));
  CHECK(d.bound == doctest::Approx(2.776 * std::sqrt(0.5 * (1e-6 + 4e-6) * 2.0 / 3.0)));
  CHECK_FALSE(means.settings[0].from_reference[balance].known());
  CHECK_FALSE(means.settings[1].from_reference[number_at("cpu_s_per_orbit")].known());
  const Json rows = means_as_json(means);
  CHECK(rows[1]["energy_balance_difference_percent"].get<double>() == doctest::Approx(1.0));
  CHECK(rows[0]["energy_balance_difference_percent"].is_null());
  CHECK(rows[0]["reference"] == true);
}

TEST_CASE("the cheapest setting that cannot be told from the reference is chosen") {
  MadeUp study;
  study.add("fine", 8.0, 1.0, 0.001, 5.0);
  study.add("middle", 4.0, 1.01, 0.001, 5.05);
  study.add("cheap", 2.0, 1.03, 0.001, 5.0);
  study.add("cheapest", 1.0, 1.0, 0.001, 6.0);
  const StudyMeans means = study.means();
  CHECK(cheapest_acceptable(means) == 1);
  CHECK(verdict_on(means, 1).acceptable());
  CHECK(verdict_on(means, 1).balance_shown());
  CHECK_FALSE(verdict_on(means, 2).acceptable());
  CHECK(verdict_on(means, 2).beyond.empty());
  CHECK(verdict_on(means, 3).beyond == std::vector<std::string>{"c_x (m/s)"});
  const std::string text = verdict_text(means);
  CHECK(text.find("`middle`: 4 s of processor time per orbit, 2 times the speed") != text.npos);
  CHECK(text.find("so it is within 2 %") != text.npos);
  CHECK(text.find("`cheap` is cheaper and differs in loss over stress by +3.0 %") != text.npos);
  CHECK(text.find("`cheapest` is cheaper and differs in c_x (m/s)") != text.npos);
}

TEST_CASE("agreement within the scatter is not reported as equality") {
  MadeUp study;
  study.add("fine", 8.0, 1.0, 0.02, 5.0);
  study.add("coarse", 2.0, 1.01, 0.02, 5.0);
  const StudyMeans means = study.means();
  CHECK(cheapest_acceptable(means) == 1);
  CHECK_FALSE(verdict_on(means, 1).balance_shown());
  CHECK(verdict_text(means).find("a difference of up to 5.5 % is not excluded") != std::string::npos);
  CHECK(sensitivity_text(means).find("loss over stress 4.5 %") != std::string::npos);
}

TEST_CASE("without a given reference the setting with the smallest force error is it; failed runs do not count") {
  MadeUp study;
  study.add("a", 1.0, 1.0, 0.01, 5.0, 3e-3);
  study.add("b", 2.0, 1.0, 0.01, 5.0, 1e-4);
  study.add("c", 3.0, 1.0, 0.01, 5.0, 2e-4);
  study.fail_last();
  const StudyMeans means = study.means(std::nullopt);
  CHECK(means.reference == 1);
  CHECK(means.settings[2].finished == 2);
}

TEST_CASE("without finished runs there is no verdict") {
  StudyChoices none;
  none.choices = {{"a", {}}, {"b", {}}};
  const StudyMeans means = means_of(none, {});
  CHECK(verdict_text(means).find("there is no verdict") != std::string::npos);
  CHECK(sensitivity_text(means).empty());
}

} // namespace verdict_test
