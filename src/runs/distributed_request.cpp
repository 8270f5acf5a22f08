#include "distributed_request.hpp"

#include <keeler/comm/same_request.hpp>
#include <keeler/files/files.hpp>
#include <keeler/io/hash.hpp>
#include <keeler/io/snapshot.hpp>
#include <keeler/scene/keys_in_force.hpp>

#include <fmt/format.h>

namespace keeler::runs {
namespace {

// Returns the canonical path: ranks may be started in different folders.
std::string location(const std::filesystem::path& folder) {
  std::error_code unknown; // the current folder was removed, or cannot be read
  const std::filesystem::path whole = std::filesystem::absolute(folder, unknown);
  const std::filesystem::path found = std::filesystem::weakly_canonical(whole, unknown);
  return (unknown ? whole.lexically_normal() : found).string();
}

std::string in_words(const std::optional<double>& number) {
  return number ? fmt::format("{}", *number) : "not given";
}

std::vector<comm::RequestEntry> asked_of(const RunOptions& options) {
  const auto flag = [](bool given) { return given ? "given" : "not given"; };
  return {{"the folder", location(options.folder)},
          {"--force", flag(options.force)},
          {"--check", flag(options.check)},
          {"--until", in_words(options.until_orbits)},
          {"--wall-time", in_words(options.wall_time_s)}};
}

// Returns a fingerprint of a file. A start snapshot can be large and is identified by its seal; one without a seal is
// read by the root alone. Other files are tables, and are hashed.
std::string fingerprint(const Scene& scene, const std::string& file) {
  if (file == scene.start_from)
    return io::snapshot_seal(file);
  io::Hash hash;
  hash.add_bytes(files::read_file(file));
  return hash.hex();
}

} // namespace

void require_same_run(const Scene& scene, const RunOptions& options) {
  if (!options.ranks.distributed())
    return;
  std::vector<comm::RequestEntry> request = asked_of(options);
  options.ranks.together([&] {
    for (const scene::KeyInForce& key : keys_in_force(scene)) {
      request.push_back({key.path, key.value});
      if (key.file)
        request.push_back({fmt::format("the content of '{}'", *key.file), fingerprint(scene, *key.file)});
    }
  });
  require_same_request(request, options.ranks);
}

void require_same_run(const RunOptions& options) {
  require_same_request(asked_of(options), options.ranks);
}

} // namespace keeler::runs
