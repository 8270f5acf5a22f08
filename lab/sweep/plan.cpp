#include "plan.hpp"

#include <keeler/batch/quantities.hpp>
#include <keeler/config/overrides.hpp>
#include <keeler/core/error.hpp>
#include <keeler/core/format.hpp>
#include <keeler/core/interrupt.hpp>
#include <keeler/core/stopwatch.hpp>
#include <keeler/io/hash.hpp>
#include <keeler/scene/load_parts.hpp>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cassert>
#include <filesystem>
#include <iterator>

namespace keeler::sweep {
namespace {

std::string last_part(const std::string& key) {
  return key.substr(key.rfind('.') + 1);
}

// Returns the last parts of the keys, or the whole key where its last part is not unique.
std::vector<std::string> short_names(const std::vector<std::string>& keys) {
  std::vector<std::string> names;
  for (const std::string& key : keys) {
    const auto same = [&](const std::string& other) { return last_part(other) == last_part(key); };
    names.push_back(std::count_if(keys.begin(), keys.end(), same) == 1 ? last_part(key) : key);
  }
  return names;
}

// Returns "217x108" for "[217, 108]".
std::string with_lists_by_x(std::string label) {
  if (label.starts_with("[") && label.ends_with("]"))
    label = label.substr(1, label.size() - 2);
  for (std::size_t at; (at = label.find(", ")) != std::string::npos;)
    label.replace(at, 2, "x");
  return label;
}

// Returns a value as part of a folder's name: a plain number, word or list of numbers unchanged. Anything else becomes
// its plain characters and a fingerprint, so that names are unique.
std::string in_name(const std::string& label) {
  constexpr std::size_t max_length = 24;
  const auto plain = [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '.' || c == '+' ||
           c == '-';
  };
  const std::string text = with_lists_by_x(label);
  if (text.size() <= max_length && std::all_of(text.begin(), text.end(), plain))
    return text;
  std::string name;
  std::copy_if(label.begin(), label.end(), std::back_inserter(name), plain);
  io::Hash hash;
  hash.add_text(label);
  return name.substr(0, max_length) + "~" + hash.hex().substr(0, 8);
}

std::vector<GridPoint> points_of(const std::vector<GridAxis>& axes) {
  std::vector<GridPoint> points(1);
  for (const GridAxis& axis : axes) {
    std::vector<GridPoint> crossed;
    for (const GridPoint& point : points)
      for (std::size_t k = 0; k < axis.points.size(); ++k) {
        GridPoint next = point;
        next.on_axis.push_back(k);
        for (const GridValue& value : axis.points[k])
          next.settings.push_back(&value);
        crossed.push_back(std::move(next));
      }
    points = std::move(crossed);
  }
  return points;
}

std::string name_of(const GridPoint& point, const std::vector<std::string>& names) {
  assert(names.size() == point.settings.size());
  std::string name;
  for (std::size_t k = 0; k < names.size(); ++k)
    name += fmt::format("{}-{}_", names[k], in_name(point.settings[k]->label));
  return name;
}

// Validates the scene of a run. A fault of the grid names its line; a fault of the scene file names the run.
Scene checked_scene(const Grid& grid, const GridPoint& point, const GridValue* seed, const std::string& run) {
  std::vector<config::Override> overrides;
  for (const GridValue& value : grid.set)
    overrides.push_back(value.override);
  for (const GridValue* const value : point.settings)
    overrides.push_back(value->override);
  if (seed)
    overrides.push_back(seed->override);
  try {
    return scene::load_varied_scene(grid.scene.string(), overrides);
  } catch (const UsageError& error) {
    const std::string fault = error.what();
    if (fault.starts_with(grid.file.string() + ":"))
      throw;
    throw UsageError(fmt::format("{} (in the run {} of {})", fault, run, grid.file.string()));
  }
}

void check_start(const Grid& grid, const batch::PlannedRun& run) {
  if (run.scene.start_from && !std::filesystem::exists(*run.scene.start_from))
    throw UsageError(fmt::format("{}:1:1: start.from of the run {} names '{}', which does not exist; correct it",
                                 grid.file.string(), run.name, *run.scene.start_from));
}

void check_since(const Grid& grid, const batch::PlannedRun& run) {
  const double end = static_cast<double>(run.scene.time.end_step) * run.scene.time.step;
  if (grid.since && *grid.since >= end)
    throw UsageError(fmt::format("{}: since = {} is not before the end of the run {} (time.end = {:.6g}), so nothing "
                                 "would be measured; choose an earlier orbit",
                                 grid.since_position, *grid.since, run.name, end));
}

// Counts the runs before any is made: crossed axes can give very many.
double number_of_runs(const Grid& grid) {
  constexpr double max_runs = 1e5;
  double runs = static_cast<double>(std::max<std::size_t>(1, grid.seeds.size()));
  for (const GridAxis& axis : grid.axes)
    runs *= static_cast<double>(axis.points.size());
  if (runs > max_runs)
    throw UsageError(
        fmt::format("{}:1:1: the grid makes {} runs (a sweep takes {} at most); give it fewer seeds or values, "
                    "or make several grids",
                    grid.file.string(), format_number(runs), format_number(max_runs)));
  return runs;
}

constexpr std::size_t runs_per_report = 1000;

Progress checked(std::size_t runs, double all, double elapsed_s) {
  assert(runs > 0);
  const double fraction = static_cast<double>(runs) / all;
  return {fraction, elapsed_s, elapsed_s * (1.0 / fraction - 1.0), fmt::format("checking {}", pluralize(runs, "run"))};
}

} // namespace

Plan plan_runs(const Grid& grid, const std::function<void(const Progress&)>& progress) {
  const double count = number_of_runs(grid);
  double elapsed = 0.0;
  Stopwatch watch(elapsed);
  Plan plan;
  for (const GridAxis& axis : grid.axes)
    plan.keys.insert(plan.keys.end(), axis.keys.begin(), axis.keys.end());
  const std::vector<std::string> names = short_names(plan.keys);
  plan.points = points_of(grid.axes);
  std::vector<const GridValue*> seeds;
  for (const GridValue& seed : grid.seeds)
    seeds.push_back(&seed);
  if (seeds.empty())
    seeds.push_back(nullptr);
  for (std::size_t p = 0; p < plan.points.size(); ++p)
    for (const GridValue* const seed : seeds) {
      throw_if_interrupted();
      batch::PlannedRun run;
      const std::string point = name_of(plan.points[p], names);
      run.scene = checked_scene(grid, plan.points[p], seed, point + (seed ? "seed-" + seed->label : "seed"));
      run.point = p;
      run.seed = run.scene.particles.seed;
      run.name = fmt::format("{}seed-{}", point, run.seed);
      check_start(grid, run);
      check_since(grid, run);
      plan.runs.push_back(std::move(run));
      if (progress && plan.runs.size() % runs_per_report == 0)
        progress(checked(plan.runs.size(), count, watch.elapsed()));
    }
  assert(static_cast<double>(plan.runs.size()) == count);
  return plan;
}

} // namespace keeler::sweep
