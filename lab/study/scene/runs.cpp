#include "runs.hpp"

#include <keeler/core/error.hpp>
#include <keeler/scene/load.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <filesystem>

namespace keeler::study {
namespace {

namespace fs = std::filesystem;

constexpr double min_forgetting = 1.0, forgetting = 0.25; // orbits; fraction of the requested orbits
constexpr double min_orbits = 1.5;
constexpr std::size_t min_count = 100; // particles; the means of smaller states are too noisy to compare

// Output intervals of the runs, in orbits.
const std::vector<std::string> output = {"output.series_every=0.02", "output.stress_every=0.1",
                                         "output.snapshot_every=0.25"};

Scene varied(const StudyPlan& plan, const std::vector<std::string>& overrides,
             const std::optional<std::string>& from = {}) {
  return parse_scene(plan.scene.resolved, plan.scene_name, overrides, from);
}

std::string growth_name(const StudyPlan& plan, std::size_t k) {
  return fmt::format("grow_seed-{}", plan.scene.particles.seed + k);
}

// Returns the last snapshot of a finished run.
std::string last_snapshot(const fs::path& folder) {
  std::vector<std::string> files;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder))
    if (entry.path().filename().string().starts_with("snap_") && entry.path().extension() == ".hdf")
      files.push_back(fs::absolute(entry.path()).lexically_normal().string());
  if (files.empty())
    throw IoError(fmt::format("'{}' has no snapshot any more; remove the folder, and the same command makes it again",
                              folder.string()));
  return *std::max_element(files.begin(), files.end());
}

batch::PlannedRun setting_run(const StudyPlan& plan, std::size_t choice, std::size_t k,
                              const std::optional<std::string>& from) {
  assert(choice < plan.choices.choices.size() && k < plan.seeds);
  const std::uint64_t seed = plan.scene.particles.seed + k;
  std::vector<std::string> overrides = plan.choices.choices[choice].overrides;
  overrides.insert(overrides.end(), output.begin(), output.end());
  overrides.push_back(fmt::format("time.end={}", plan.end()));
  if (!from)
    overrides.push_back(fmt::format("particles.seed={}", seed));
  const std::string& name = plan.choices.choices[choice].name;
  return {fmt::format("{}_seed-{}", name, seed), choice, seed, varied(plan, overrides, from)};
}

// Parses every choice before anything runs, with the scene's initial state, and drops choices with too few particles.
void check_choices(StudyPlan& plan, const std::function<void(const std::string&)>& notice) {
  std::vector<StudyChoice> kept;
  for (std::size_t k = 0; k < plan.choices.choices.size(); ++k) {
    const StudyChoice& choice = plan.choices.choices[k];
    const std::size_t count = setting_run(plan, k, 0, std::nullopt).scene.particles.count;
    if (count >= min_count || has_common_start(plan.kind))
      kept.push_back(choice);
    else
      notice(fmt::format("note: {} is left out, since it would have only {} particles", choice.name, count));
  }
  if (kept.size() < 2)
    throw UsageError(fmt::format("{}:1:1: too few particles for a comparison (a setting needs {}); enlarge the box",
                                 plan.scene_name, min_count));
  if (plan.choices.reference)
    plan.choices.reference = plan.kind == SceneStudyKind::box ? kept.size() - 1 : 0;
  plan.choices.choices = std::move(kept);
}

StudyChoices choices_of(const SceneStudySettings& settings, const Scene& scene) {
  try {
    return study_choices(settings.kind, scene, settings.quick);
  } catch (const UsageError& error) {
    throw UsageError(fmt::format("{}:1:1: {}", settings.scene, error.what()));
  }
}

} // namespace

double StudyPlan::since() const {
  return std::max(min_forgetting, forgetting * orbits) + (has_common_start(kind) ? 0.0 : grow_orbits);
}

StudyPlan plan_study(const SceneStudySettings& settings) {
  StudyPlan plan;
  plan.kind = settings.kind;
  plan.scene_name = settings.scene;
  plan.scene = load_scene(settings.scene, settings.overrides);
  if (plan.scene.start_from)
    throw UsageError(fmt::format("{}:1:1: the scene starts from a snapshot (start.from), so all seeds would give one "
                                 "run; replace [start] by [box] and [particles]",
                                 settings.scene));
  plan.choices = choices_of(settings, plan.scene);
  plan.quick = settings.quick;
  plan.quantities = batch::RunQuantities(settings.quantities);
  plan.seeds = settings.seeds.value_or(settings.quick ? 2 : 3);
  plan.grow_orbits = settings.grow_orbits.value_or(settings.quick ? 1.0 : plan.scene.gravity ? 6.0 : 10.0);
  plan.orbits = settings.orbits.value_or(settings.quick ? 2.0 : 6.0);
  if (plan.seeds < 2)
    throw UsageError("a study with one seed cannot measure the scatter; --seeds takes 2 or more");
  if (plan.orbits < min_orbits)
    throw UsageError(
        fmt::format("--orbits {:g} is too short (the first orbit of a run is not measured); give {:g} or more",
                    plan.orbits, min_orbits));
  check_choices(plan, settings.notice);
  return plan;
}

std::vector<batch::PlannedRun> growth_runs(const StudyPlan& plan) {
  std::vector<batch::PlannedRun> runs;
  for (std::size_t k = 0; has_common_start(plan.kind) && k < plan.seeds; ++k) {
    const std::uint64_t seed = plan.scene.particles.seed + k;
    runs.push_back({growth_name(plan, k), 0, seed,
                    varied(plan, {fmt::format("particles.seed={}", seed), fmt::format("time.end={}", plan.grow_orbits),
                                  "output.snapshot_every=0"})});
  }
  return runs;
}

std::vector<batch::PlannedRun> setting_runs(const StudyPlan& plan, const batch::RunFolders& folders) {
  std::vector<batch::PlannedRun> runs;
  for (std::size_t k = 0; k < plan.seeds; ++k) {
    std::optional<std::string> from;
    if (has_common_start(plan.kind))
      from = last_snapshot(folders.run(growth_name(plan, k)));
    for (std::size_t choice = 0; choice < plan.choices.choices.size(); ++choice)
      runs.push_back(setting_run(plan, choice, k, from));
  }
  return runs;
}

} // namespace keeler::study
