// Targets that read text: scenes, assignments, lists of radii, tables of particles, series.
#include "targets.hpp"

#include <keeler/advice/derived.hpp>
#include <keeler/advice/warnings.hpp>
#include <keeler/core/error.hpp>
#include <keeler/initial_conditions/from_table.hpp>
#include <keeler/io/particle_table.hpp>
#include <keeler/io/series.hpp>
#include <keeler/runs/transport.hpp>
#include <keeler/scene/load.hpp>
#include <keeler/scene/scene.hpp>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <limits>
#include <vector>

namespace keeler::fuzz {
namespace {

// What follows from a scene, and the promise that its resolved text is a scene that says the same.
void look_at(const Scene& scene, const std::string& name) {
  advice::derive(scene);
  advice::warnings(scene);
  try {
    scene::parse_stored_scene(scene.resolved, name);
    if (parse_scene(scene.resolved, name).resolved != scene.resolved)
      std::abort();
  } catch (const Error& error) {
    std::fprintf(stderr, "%s\n", error.what());
    std::abort();
  }
}

std::vector<std::string> lines_of(std::string_view text, std::size_t most) {
  std::vector<std::string> lines;
  while (!text.empty() && lines.size() < most) {
    const std::size_t end = std::min(text.find('\n'), text.size());
    lines.emplace_back(text.substr(0, end));
    text.remove_prefix(std::min(end + 1, text.size()));
  }
  return lines;
}

} // namespace

void read_scene(std::string_view input, const std::filesystem::path& folder) {
  const std::string text(input), name = folder / "scene.toml";
  try {
    scene::parse_table_scene(text, name);
  } catch (const Error&) { // what it lacks as the scene of a table it may have as another
  }
  look_at(parse_scene(text, name), name);
}

void read_assignments(std::string_view input, const std::filesystem::path& folder) {
  const std::string name = folder / "scene.toml";
  look_at(parse_scene(small_scene(), name, lines_of(input, 8)), name);
}

void read_radii(std::string_view input, const std::filesystem::path& folder) {
  put(folder / "radii.txt", input);
  const std::string name = folder / "scene.toml";
  std::string scene = small_scene();
  const std::string equal = R"({ law = "equal", radius = 1.0 })";
  scene.replace(scene.find(equal), equal.size(), R"({ law = "file", path = "radii.txt" })");
  look_at(parse_scene(scene, name), name);
}

void read_table(std::string_view input, const std::filesystem::path& folder) {
  const std::filesystem::path file = folder / "table.csv", again = folder / "again.csv";
  put(file, input);
  const Patch patch = initial_conditions::patch_from_table(io::read_particle_table(file),
                                                           scene::parse_table_scene(small_scene(), folder / "s.toml"));
  io::table_format("csv").write(again, io::table_of(patch));
  if (io::read_particle_table(again).radii != patch.radii)
    std::abort();
}

void read_series_file(std::string_view input, const std::filesystem::path& folder) {
  const std::filesystem::path file = folder / "series.csv";
  put(file, input);
  const io::SeriesTable series = io::read_series(file);
  if (runs::enough_rows(series))
    runs::transport(series, {.mass = 1e3, .orbital_frequency = 1e-4}, {});
  io::Series::resume(file, {series.names.begin() + 1, series.names.end()}, 3)
      .append(4, std::vector<double>(series.names.size() - 1, std::numeric_limits<double>::max())); // later than all
  io::read_series(file);
}

} // namespace keeler::fuzz
