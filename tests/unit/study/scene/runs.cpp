#include "scene/runs.hpp"

#include "unit/files/disk.hpp"

#include <doctest/doctest.h>

namespace runs_test {

using namespace keeler;
using namespace keeler::study;
using namespace keeler::test;

namespace {

// A scene file in a temporary folder.
class SceneFile {
public:
  SceneFile() {
    write_quickly(folder_ / "scene.toml", R"(
[planet]
orbital_frequency = 1.9565e-4
[box]
size = [30.0, 30.0]
[particles]
count = 120
seed = 5
density = 500.0
sizes = { law = "equal", radius = 1.0 }
[gravity]
solver = "tree"
[time]
step = 1e-3
end = 1.0
)");
  }

  StudyPlan plan(SceneStudyKind kind, bool quick = false) {
    SceneStudySettings settings;
    settings.kind = kind;
    settings.scene = (folder_ / "scene.toml").string();
    settings.quick = quick;
    settings.notice = [this](const std::string& text) { notices.push_back(text); };
    return plan_study(settings);
  }

  std::vector<std::string> notices;

private:
  TemporaryFolder folder_;
};

} // namespace

TEST_CASE("each seed evolves one common state, and the first orbits of a run are left out of the means") {
  SceneFile file;
  const StudyPlan plan = file.plan(SceneStudyKind::kicks);
  const std::vector<batch::PlannedRun> growth = growth_runs(plan);
  REQUIRE(growth.size() == 3);
  CHECK(growth[2].name == "grow_seed-7");
  CHECK(growth[2].scene.particles.seed == 7);
  CHECK(growth[2].scene.time.end_step == 6000);
  CHECK(plan.since() == 1.5);
  CHECK(plan.end() == 6.0);
  CHECK(file.plan(SceneStudyKind::kicks, true).since() == 1.0);
}

TEST_CASE("boxes have no common state, and boxes with too few particles are left out") {
  SceneFile file;
  const StudyPlan plan = file.plan(SceneStudyKind::box);
  CHECK(growth_runs(plan).empty());
  CHECK(plan.since() == 7.5);
  CHECK(plan.end() == 12.0);
  REQUIRE(plan.choices.choices.size() == 3); // 120, 235 and 480 particles
  CHECK(plan.choices.choices[plan.choices.reference.value()].name == "box-2");
  CHECK(file.notices.size() == 2);
  const std::vector<batch::PlannedRun> runs = setting_runs(plan, batch::RunFolders("none"));
  REQUIRE(runs.size() == 9);
  CHECK(runs[4].name == "box-1.4_seed-6");
  CHECK(runs[4].point == 1);
  CHECK(runs[4].scene.particles.seed == 6);
  CHECK(runs[4].scene.time.end_step == 12000);
}

} // namespace runs_test
