#include "choices.hpp"

#include <keeler/core/error.hpp>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <map>

namespace keeler::study {
namespace {

using Solver = GravitySettings::Solver;

constexpr double thousandth = 1e-3;      // of an orbit
constexpr int max_kick_every = 1000;     // upper limit of gravity.kick_every
constexpr std::size_t max_direct = 5000; // particles: with more, the sum over all pairs takes hours
constexpr double automatic_kick = 8e-3;  // orbits, typical of an automatic step in wakes

std::vector<std::string> step_overrides(const Scene& scene, const Kicks& kicks) {
  std::vector<std::string> overrides = {fmt::format("time.step={}", kicks.step)};
  if (scene.gravity)
    overrides.push_back(fmt::format("gravity.kick_every={}", kicks.every));
  return overrides;
}

StudyChoice automatic_step(const Scene& scene, const std::string& name) {
  StudyChoice choice{name, {"time.step=\"auto\""}};
  if (scene.gravity)
    choice.overrides.emplace_back("gravity.kick_every=1");
  return choice;
}

// Inserts the scene's value into the sorted values of the study, unless they contain it.
void add_scene_value(std::vector<double>& values, double of_scene) {
  assert(std::is_sorted(values.begin(), values.end()) && of_scene > 0.0);
  const auto same = [&](double value) { return std::fabs(value - of_scene) < 1e-6 * of_scene; };
  if (std::none_of(values.begin(), values.end(), same))
    values.insert(std::upper_bound(values.begin(), values.end(), of_scene), of_scene);
}

StudyChoices step_choices(const Scene& scene, bool quick) {
  const double interval = !scene.gravity         ? 0.0
                          : scene.time.automatic ? automatic_kick
                                                 : scene.time.step * scene.gravity->kick_every;
  StudyChoices all{{}, 0};
  std::vector<double> steps = quick ? std::vector{1e-3, 4e-3} : std::vector{0.25e-3, 0.5e-3, 1e-3, 2e-3, 4e-3, 8e-3};
  if (!scene.time.automatic)
    add_scene_value(steps, scene.time.step);
  for (const double step : steps)
    all.choices.push_back({fmt::format("step-{:g}", step), step_overrides(scene, kicks_of(step, interval))});
  all.choices.push_back(automatic_step(scene, "step-auto"));
  return all;
}

StudyChoices kick_choices(const Scene& scene, bool quick) {
  if (!scene.gravity)
    throw UsageError(
        "the scene has no self-gravity, so it has no kick interval; add [gravity] to it, or study its step "
        "with \"keeler study step\"");
  const double max_step = scene.time.automatic ? thousandth : scene.time.step;
  StudyChoices all{{}, 0};
  std::vector<double> intervals = quick ? std::vector{1e-3, 8e-3} : std::vector{1e-3, 2e-3, 4e-3, 8e-3, 16e-3};
  if (!scene.time.automatic)
    add_scene_value(intervals, scene.time.step * scene.gravity->kick_every);
  for (const double interval : intervals)
    all.choices.push_back({fmt::format("kick-{:g}", interval), step_overrides(scene, steps_in(interval, max_step))});
  all.choices.push_back(automatic_step(scene, "kick-auto"));
  return all;
}

StudyChoices mesh_choices(const Scene& scene, bool quick) {
  if (!scene.gravity)
    throw UsageError("the scene has no self-gravity, so it has no solver to study; add [gravity] to it");
  if (!scene.gravity->by_pairs())
    throw UsageError("the scene's gravity is axisymmetric, which no other solver computes; study its step or kicks");
  StudyChoices all;
  if (scene.gravity->images.far) // the mesh is periodic: a finite number of image rings is a different force
    for (const double error : quick ? std::vector{1e-3, 1e-2} : std::vector{3e-4, 1e-3, 2e-3, 5e-3, 1e-2})
      all.choices.push_back(
          {fmt::format("fft-{:g}", error), {"gravity.solver=\"fft\"", fmt::format("gravity.force_error={}", error)}});
  for (const double angle : quick ? std::vector{0.6} : std::vector{0.3, 0.45, 0.6, 0.75, 0.9})
    all.choices.push_back(
        {fmt::format("tree-{:g}", angle), {"gravity.solver=\"tree\"", fmt::format("gravity.opening_angle={}", angle)}});
  if (!quick && scene.gravity->images.far)
    all.choices.push_back({"mesh", {"gravity.solver=\"mesh\""}});
  if (!quick && scene.particles.count <= max_direct)
    all.choices.push_back({"direct", {"gravity.solver=\"direct\""}});
  return all;
}

StudyChoices box_choices(const Scene& scene, bool quick) {
  StudyChoices all;
  for (const double factor : quick ? std::vector{0.7, 1.0, 1.4} : std::vector{0.5, 0.7, 1.0, 1.4, 2.0}) {
    const auto count = std::llround(static_cast<double>(scene.particles.count) * factor * factor);
    if (count > 0)
      all.choices.push_back({fmt::format("box-{:g}", factor),
                             {fmt::format("box.size=[{}, {}]", factor * scene.size_x, factor * scene.size_y),
                              fmt::format("particles.count={}", count)}});
  }
  all.reference = all.choices.size() - 1;
  return all;
}

// Returns the choice with other sizes in a box of unchanged size and surface density, without gravity optical depth.
StudyChoice with_sizes(const Scene& scene, const std::string& name, const std::string& sizes) {
  return {name,
          {sizes,
           scene.gravity ? fmt::format("particles.surface_density={}", scene.surface_density())
                         : fmt::format("particles.optical_depth={}", scene.optical_depth()),
           fmt::format("box.size=[{}, {}]", scene.size_x, scene.size_y)}};
}

// Returns the override for a table of the radii ≥ `cut` and their numbers.
std::string table_from(const std::map<double, std::size_t>& counts, double cut) {
  std::vector<std::string> rows;
  for (const auto& [radius, count] : counts)
    if (radius >= cut)
      rows.push_back(fmt::format("[{}, {}]", radius, count));
  return fmt::format("particles.sizes={{ law = \"table\", table = [{}] }}", fmt::join(rows, ", "));
}

std::string from_name(double radius) {
  return fmt::format("from-{:.3g}", radius);
}

// Returns the choice without the particles smaller than `cut`: by the key `min` of a law with a density, by a table of
// the remaining radii for listed sizes.
StudyChoice cut_from(const Scene& scene, double cut) {
  const particles::SizeLaw& law = scene.particles.sizes;
  if (law.listed == 0)
    return with_sizes(scene, from_name(cut), fmt::format("particles.sizes.min={}", cut));
  std::map<double, std::size_t> counts;
  for (const double radius : draw_radii(law, scene.particles.count, scene.particles.seed))
    ++counts[radius];
  auto first = counts.lower_bound(cut);
  assert(!counts.empty());
  if (first == counts.end()) // the largest sizes are so rare that none was drawn
    --first;
  return with_sizes(scene, from_name(first->first), table_from(counts, first->first));
}

StudyChoices size_choices(const Scene& scene, bool quick) {
  const particles::SizeLaw& law = scene.particles.sizes;
  if (law.smallest == law.largest)
    throw UsageError(fmt::format("all particles of the scene have one size, {:g} m, so no sizes can be cut; give "
                                 "it a distribution, for example --set 'particles.sizes={{ law = \"power\", exponent = "
                                 "3, min = {:g}, max = {:g} }}'",
                                 law.smallest, 0.5 * law.smallest, 2.0 * law.smallest));
  StudyChoices all{{{"whole", {}}}, 0};
  for (const double part : quick ? std::vector{0.4} : std::vector{0.2, 0.4, 0.6})
    if (StudyChoice cut = cut_from(scene, law.smallest * std::pow(law.largest / law.smallest, part));
        cut.name != all.choices.back().name) // two cuts of a short list can leave equal sizes
      all.choices.push_back(std::move(cut));
  const double radius = law.mean_power(3) / law.mean_power(2); // keeps surface density and optical depth
  all.choices.push_back(
      with_sizes(scene, "equal", fmt::format("particles.sizes={{ law = \"equal\", radius = {} }}", radius)));
  return all;
}

// In the order of SceneStudyKind.
constexpr struct {
  const char* name;
  StudyChoices (*choices)(const Scene& scene, bool quick);
} kinds[] = {{"step", step_choices},
             {"kicks", kick_choices},
             {"mesh", mesh_choices},
             {"box", box_choices},
             {"sizes", size_choices}};

} // namespace

std::string name_of(SceneStudyKind kind) {
  return kinds[static_cast<std::size_t>(kind)].name;
}

bool has_common_start(SceneStudyKind kind) {
  return kind != SceneStudyKind::box && kind != SceneStudyKind::sizes;
}

Kicks steps_in(double interval, double max_step) {
  assert(interval > 0.0 && max_step > 0.0);
  const int every = std::clamp(static_cast<int>(std::ceil(interval / max_step * (1.0 - 1e-12))), 1, max_kick_every);
  return {interval / every, every};
}

Kicks kicks_of(double step, double interval) {
  assert(step > 0.0);
  return {step, static_cast<int>(std::clamp(std::round(interval / step), 1.0, double{max_kick_every}))};
}

StudyChoices study_choices(SceneStudyKind kind, const Scene& scene, bool quick) {
  return kinds[static_cast<std::size_t>(kind)].choices(scene, quick);
}

} // namespace keeler::study
