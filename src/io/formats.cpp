#include "formats.hpp"

#include "provenance_attributes.hpp"

#include <keeler/core/error.hpp>

#include <fmt/format.h>

#include <cassert>

namespace keeler::io {
namespace {

// Returns an entry for messages.
std::string entry_of(const Provenance& provenance, const char* name) {
  const auto found = provenance.find(name);
  return found == provenance.end() ? "unknown" : found->second;
}

} // namespace

void require_version(const hdf5::Handle& object, const hdf5::Handle& writer, const FormatVersions& versions,
                     std::string_view otherwise) {
  assert(versions.oldest <= versions.newest);
  const auto version = hdf5::read_attribute<std::int64_t>(object, "format_version");
  if (version >= versions.oldest && version <= versions.newest)
    return;
  const Provenance provenance = read_provenance(writer);
  const std::string reads = versions.oldest == versions.newest
                                ? fmt::format("{}", versions.newest)
                                : fmt::format("{} to {}", versions.oldest, versions.newest);
  const std::string keeler =
      fmt::format("Keeler {} (commit {})", entry_of(provenance, "version"), entry_of(provenance, "commit"));
  throw IoError(version > versions.newest
                    ? fmt::format("it has format version {}, this program reads {}; use the newer {}, which wrote it",
                                  version, reads, keeler)
                    : fmt::format("it has format version {}, this program reads {}; use the older {}, which wrote it{}",
                                  version, reads, keeler, otherwise));
}

} // namespace keeler::io
