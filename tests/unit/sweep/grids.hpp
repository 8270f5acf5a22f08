// A grid and its scene, written to a folder for a test.
#pragma once

#include "plan.hpp"
#include "unit/files/disk.hpp"

#include <keeler/core/error.hpp>

#include <string>

namespace keeler::test {

class GridFile {
public:
  explicit GridFile(const std::string& text) {
    write_quickly(folder_ / "scene.toml", R"(
[planet]
orbital_frequency = 1.9565e-4
[box]
size = [30.0, 30.0]
[particles]
optical_depth = 0.3
density = 500.0
sizes = { law = "equal", radius = 1.0 }
[time]
step = 5e-3
end = 1.0
)");
    write_quickly(path(), text);
  }

  std::filesystem::path path() const { return folder_ / "grid.toml"; }
  sweep::Grid grid() const { return sweep::read_grid(path()); }

  /// Returns the message of its first fault, without the folder; empty if there is none.
  std::string fault() const {
    try {
      const sweep::Grid read = grid();
      plan_runs(read);
    } catch (const UsageError& error) {
      std::string text = error.what();
      const std::string prefix = folder_.path().string() + "/";
      for (std::size_t at; (at = text.find(prefix)) != std::string::npos;)
        text.erase(at, prefix.size());
      return text;
    }
    return {};
  }

private:
  TemporaryFolder folder_;
};

} // namespace keeler::test
