// Runs every file of a target's corpus, and inputs made of it by simple changes from a fixed seed, through the target.
// What was found once stays mended; no fuzzer is needed.
//   replay TARGET CORPUS EXAMPLES
// CORPUS has a folder for a target; the scenes of EXAMPLES are inputs of the target `scene` too.
#include "targets.hpp"

#include <keeler/core/threads.hpp>
#include <keeler/files/files.hpp>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <random>
#include <vector>

namespace {

namespace fs = std::filesystem;
using keeler::fuzz::Target;

std::vector<fs::path> files_below(const fs::path& folder, const std::string& ending) {
  std::vector<fs::path> files;
  if (!fs::is_directory(folder))
    return files;
  for (const fs::directory_entry& entry : fs::recursive_directory_iterator(folder))
    if (entry.is_regular_file() && entry.path().extension() == ending)
      files.push_back(entry.path());
  std::sort(files.begin(), files.end());
  return files;
}

// A byte set, a piece cut out, a piece doubled, or the end cut off; a few times.
std::string changed(std::string text, std::mt19937_64& draw) {
  for (std::size_t k = 1 + draw() % 3; k > 0 && !text.empty(); --k) {
    const std::size_t place = draw() % text.size(), length = 1 + draw() % std::min<std::size_t>(16, text.size());
    switch (draw() % 4) {
    case 0:
      text[place] = static_cast<char>(draw());
      break;
    case 1:
      text.erase(place, length);
      break;
    case 2:
      text.insert(place, text.substr(draw() % text.size(), length));
      break;
    default:
      if (draw() % 8 == 0)
        text.resize(place);
    }
  }
  return text;
}

void replay(const Target& target, const std::vector<fs::path>& files, const fs::path& folder) {
  std::vector<std::string> inputs;
  for (const fs::path& file : files) {
    inputs.push_back(keeler::files::read_text(file));
    std::printf("%s %s\n", target.name.data(), file.filename().c_str()); // the last line names what breaks
    std::fflush(stdout);
    keeler::fuzz::run(target.replayed, inputs.back(), folder);
  }
  std::mt19937_64 draw(21);
  for (unsigned count = 0; count < target.changed; ++count) {
    const std::string input = changed(inputs[draw() % inputs.size()], draw);
    keeler::fuzz::put(folder / "input", input);
    keeler::fuzz::run(target.replayed, input, folder);
  }
  std::printf("%s: %zu files, %u changed ones\n", target.name.data(), files.size(), target.changed);
}

} // namespace

int main(int argc, char** argv) {
  const Target* const target = argc == 4 ? keeler::fuzz::find_target(argv[1]) : nullptr;
  if (!target) {
    std::fputs("usage: replay TARGET CORPUS EXAMPLES, with a target of targets.hpp\n", stderr);
    return 2;
  }
  std::vector<fs::path> files = files_below(fs::path(argv[2]) / target->name, "");
  if (target->name == "scene")
    for (const fs::path& file : files_below(argv[3], ".toml"))
      files.push_back(file);
  if (files.empty()) {
    std::fputs("replay: the corpus has no input of this target\n", stderr);
    return 2;
  }
  keeler::set_threads(1);
  const fs::path folder = keeler::fuzz::make_folder();
  replay(*target, files, folder);
  fs::remove_all(folder);
  return 0;
}
