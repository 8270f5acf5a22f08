#include "targets.hpp"

#include <keeler/core/error.hpp>
#include <keeler/core/format.hpp>

#include <cstdlib>
#include <fstream>

#include <unistd.h>

namespace keeler::fuzz {

void run(Run target, std::string_view input, const std::filesystem::path& folder) {
  try {
    target(input, folder);
  } catch (const Error& error) {
    if (printable_line(error.what()).empty())
      std::abort(); // an error says what is wrong
  }
}

void put(const std::filesystem::path& file, std::string_view content) {
  std::ofstream(file, std::ios::binary).write(content.data(), static_cast<std::streamsize>(content.size()));
}

std::string small_scene() {
  return R"(planet.preset = "saturn-a-ring"
box.size = [30.0, 30.0]
particles = { count = 8, density = 450.0, sizes = { law = "equal", radius = 1.0 } }
collisions = { restitution = { law = "constant", value = 0.5 } }
time = { step = 2e-3, end = 0.004 }
output.series_every = 0.002
)";
}

std::filesystem::path make_folder() {
  std::filesystem::path above = "/dev/shm"; // where a file that is forced to disk costs nothing
  if (const char* const named = std::getenv("KEELER_FUZZ_FOLDER"))
    above = named;
  else if (access(above.c_str(), W_OK) != 0)
    above = std::filesystem::temp_directory_path();
  std::string name = above / "keeler-fuzz-XXXXXX";
  if (mkdtemp(name.data()) == nullptr)
    std::abort();
  return name;
}

} // namespace keeler::fuzz
