// Target: the folder of a run of which files were changed, looked at and resumed.
#include "draw.hpp"
#include "targets.hpp"

#include <keeler/core/error.hpp>
#include <keeler/files/files.hpp>
#include <keeler/runs/run.hpp>
#include <keeler/runs/run_view.hpp>
#include <keeler/runs/stored_patches.hpp>
#include <keeler/scene/load.hpp>

#include <array>
#include <map>

namespace keeler::fuzz {
namespace {

namespace fs = std::filesystem;

constexpr std::array file_names = {"scene.toml",
                                   "series.csv",
                                   "log.jsonl",
                                   "summary.json",
                                   "moonlets.csv",
                                   "collisions_000000.h5",
                                   "impact_speeds.csv",
                                   "snap_000000.hdf",
                                   "checkpoint_000000.h5",
                                   "checkpoint_000001.h5",
                                   "checkpoint_000001.h5.keeler-0123456789abcdef.tmp",
                                   "snap_000001.hdf"};

std::map<std::string, std::string> files_in(const fs::path& folder) {
  std::map<std::string, std::string> files;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder))
    if (entry.is_regular_file())
      files[entry.path().filename()] = files::read_text(entry.path());
  return files;
}

// A run that was stopped: two of its four steps are done.
std::map<std::string, std::string> stopped_run(const fs::path& folder) {
  const std::string moonlet = "moonlet = [{ radius = 2.0, density = 900.0 }]\noutput.collisions = {}\n";
  const Scene scene = parse_scene(small_scene() + moonlet, "scene.toml");
  runs::RunOptions options;
  options.folder = folder;
  options.force = true;
  runs::RunRequests requests;
  start_run(scene, options, requests);
  return files_in(folder);
}

// The file is removed, cut, replaced, or changed in one place.
void change(const fs::path& file, Draw& draw) {
  std::string text;
  if (fs::is_regular_file(file))
    text = files::read_text(file);
  const std::size_t kind = draw.below(5), place = draw.place();
  if (kind == 0) {
    fs::remove(file);
    return;
  }
  if (kind == 1)
    text.resize(std::min(place, text.size()));
  else if (kind == 2)
    text = draw.bytes();
  else if (kind == 3)
    text.append(draw.bytes());
  else {
    const std::size_t length = draw.byte();
    text.replace(place % (text.size() + 1), length, draw.bytes());
  }
  put(file, text);
}

} // namespace

void resume_folder(std::string_view input, const fs::path& folder) {
  const fs::path run = folder / "run";
  static const std::map<std::string, std::string> pristine = stopped_run(run);
  fs::remove_all(run);
  fs::create_directory(run);
  for (const auto& [name, text] : pristine)
    put(run / name, text);
  Draw draw(input);
  const bool further = draw.byte() % 2 == 0;
  while (!draw.empty())
    change(run / file_names[draw.below(file_names.size())], draw);
  for (const auto look : {+[](const fs::path& path) { runs::view_run(path); },
                          +[](const fs::path& path) { runs::load_newest_patch(path); }})
    try {
      look(run);
    } catch (const Error&) { // what cannot be looked at may still be resumed
    }
  runs::RunOptions options;
  options.folder = run;
  if (further)
    options.until_orbits = 0.008;
  runs::RunRequests requests;
  resume_run(options, requests);
}

} // namespace keeler::fuzz
