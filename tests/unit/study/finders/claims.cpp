#include "finders/measurements.hpp"
#include "finders/numbers.hpp"

#include <doctest/doctest.h>
#include <fmt/format.h>

namespace claims_test {

using namespace keeler;
using namespace keeler::study;

namespace {

// Made-up measurements of a study in which every claim of the paper holds, unless a test changes them.
struct MadeUp {
  FinderStudyData data;

  MadeUp() {
    for (const char* name : {"equal-early", "equal-clumped"}) {
      StudyState state;
      state.name = name;
      data.states.push_back(state);
    }
    data.steps = {1e-4, 1.0 / 3000.0, 1e-3, 1.0 / 300.0, 1e-2};
    data.repeats = 3;
    for (const StudyState& state : data.states)
      for (const std::string& finder : all_finders()) {
        for (const double step : data.steps)
          set_cpu(state.name, step, finder, cost(finder) * (1e-3 / step + step / 1e-3));
        data.results[job_name("share", state.name, 1e-3, finder)] = {{"cpu_s", 1.0}, {"cpu_s_without_finder", 0.05}};
        data.results[job_name("audit", state.name, 1e-3, finder)] = audit(finder == "original" ? 23 : 3, 8, 0.1);
      }
    data.results[job_name("audit", "equal-early", 1e-3, "newton-full")] = audit(3, 2, 3.0);
    for (const double step : {1e-3, 3e-3, 1e-2}) {
      set_drift("straight", step, 100.0 * step);
      set_drift("straight-unperturbed", step, 0.01 * step);
    }
    for (const std::string& finder : all_finders())
      set_drift(finder, 1e-2, 1e-15);
  }

  static double cost(const std::string& finder) {
    if (finder == "original" || finder == "newton-cubic")
      return 3.0;
    if (finder == "newton-full" || finder == "newton-full-as-coded" || finder == "linear-cubic")
      return 2.0;
    return finder == "linear-full" || finder == "linear-full-no-start" ? 1.0 : 1.2;
  }

  // Ten hits, a hundred misses, nine hundred receding calls.
  static Json audit(std::size_t hit_iterations, std::size_t miss_iterations, double halvings) {
    const auto bins = [](std::size_t at, int calls) {
      std::vector<int> counts(at + 1, 0);
      counts[at] = calls;
      return counts;
    };
    return {{"calls", 1010},
            {"iterations", 1000},
            {"halvings", 1000.0 * halvings},
            {"exits",
             {{"hit", {{"calls", 10}, {"iterations", bins(hit_iterations, 10)}}},
              {"missed", {{"calls", 100}, {"iterations", bins(miss_iterations, 100)}}},
              {"receding", {{"calls", 900}, {"iterations", bins(0, 900)}}}}}};
  }

  void set_cpu(const std::string& state, double step, const std::string& finder, double seconds) {
    for (int repeat = 0; repeat < data.repeats; ++repeat)
      data.results[job_name("run", state, step, finder, repeat)] = {{"cpu_s", seconds * (1.0 + 0.01 * (repeat - 1))},
                                                                    {"ns_per_call", 10.0}};
  }

  void set_drift(const std::string& path, double step, double drift) {
    data.results[fmt::format("drift/{}/{:.6g}", path, step)] = {
        {"rows", {{{"orbits", 100.0}, {"mean_guiding_x_r", drift}}}}};
  }

  // Returns the verdicts on the claims that contain these words.
  std::vector<std::string> on(const std::string& words) const {
    std::vector<std::string> verdicts;
    for (const Row& row : paper_claims(data))
      if (row[0].find(words) != std::string::npos)
        verdicts.push_back(row[2]);
    REQUIRE_MESSAGE(!verdicts.empty(), words);
    return verdicts;
  }
};

} // namespace

TEST_CASE("measurements that bear the paper out confirm each of its claims") {
  const MadeUp study;
  for (const Row& row : paper_claims(study.data))
    if (row[2] != "verdict") {
      CAPTURE(row[0] + ": " + row[1]);
      CHECK(row[2] == "confirmed");
    }
  CHECK(study.data.scatter() == doctest::Approx(0.01));
}

TEST_CASE("each claim can be refuted") {
  MadeUp study;
  SUBCASE("time in the finder") {
    for (const StudyState& state : study.data.states)
      for (const std::string& finder : paper_finders)
        study.data.results[job_name("share", state.name, 1e-3, finder)] = {{"cpu_s", 1.0},
                                                                           {"cpu_s_without_finder", 0.5}};
    CHECK(study.on("90 %") == std::vector<std::string>{"refuted for this code"});
  }
  SUBCASE("ranking") {
    for (const StudyState& state : study.data.states)
      for (const double step : study.data.steps) {
        study.set_cpu(state.name, step, "linear-full", 9.0 / step);
        study.set_cpu(state.name, step, "newton-cubic", 1e-4 / step);
      }
    CHECK(study.on("fastest")[0] == "refuted");
    CHECK(study.on("last place")[0] == "refuted");
    CHECK(study.on("Newton on cubics") == std::vector<std::string>{"refuted"});
    CHECK(study.on("It is the fits") == std::vector<std::string>{"refuted"});
  }
  SUBCASE("one state alone") {
    for (const double step : study.data.steps)
      study.set_cpu("equal-early", step, "newton-full", 0.5e-3 / step);
    CHECK(study.on("fastest")[0] == "refuted in most cases"); // half of them
    CHECK(study.on("fastest")[1] == "confirmed");
  }
  SUBCASE("iterations") {
    for (const std::string& finder : paper_finders)
      study.data.results[job_name("audit", "equal-early", 1e-3, finder)] = MadeUp::audit(9, 2, 0.1);
    for (const char* words : {"twenty iterations", "low tail", "scaling steps back"})
      CHECK(study.on(words) == std::vector<std::string>{"refuted"});
  }
  SUBCASE("steps") {
    for (const StudyState& state : study.data.states)
      for (const std::string& finder : paper_finders)
        for (const double step : study.data.steps)
          study.set_cpu(state.name, step, finder, step < 5e-4 ? 1.0 : 5.0 / step);
    for (const char* words : {"best step", "minimum", "A/h"})
      CHECK(study.on(words) == std::vector<std::string>{"refuted"});
  }
  SUBCASE("straight paths") {
    study.set_drift("certified", 1e-2, 1e-3);
    CHECK(study.on("Straight paths") == std::vector<std::string>{"refuted"});
  }
}

} // namespace claims_test
