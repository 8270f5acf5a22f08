#include <keeler/files/kept_streams.hpp>

#include "content.hpp"

#include <keeler/core/error.hpp>

#include <fmt/format.h>

#include <cassert>
#include <cerrno>
#include <map>
#include <vector>

#include <fcntl.h>
#include <sys/mman.h>

namespace keeler {
namespace {

thread_local int keepers = 0;
thread_local std::map<std::string, std::shared_ptr<Descriptor>> kept;

[[noreturn]] void fail_to_read(const std::filesystem::path& file) {
  throw IoError(fmt::format("cannot read '{}': {}", file.string(), why_unread()));
}

// Reads a stream to its end, into an anonymous file in memory.
std::shared_ptr<Descriptor> read_to_end(const std::filesystem::path& file) {
  Source source(file);
  const auto copy = std::make_shared<Descriptor>(memfd_create("keeler", MFD_CLOEXEC), file);
  std::vector<std::byte> piece(std::size_t{1} << 16);
  for (std::size_t have = 0;;) {
    const ssize_t got = source.read(piece);
    if (got < 0)
      fail_to_read(file);
    if (got == 0)
      return copy;
    have += static_cast<std::size_t>(got);
    if (!source.may_have(have)) {
      errno = EFBIG;
      fail_to_read(file);
    }
    copy->write_all(std::span(piece).first(static_cast<std::size_t>(got)));
  }
}

} // namespace

KeptStreams::KeptStreams() {
  ++keepers;
}

KeptStreams::~KeptStreams() {
  assert(keepers > 0);
  if (--keepers == 0)
    kept.clear();
}

std::shared_ptr<Descriptor> open_anywhere(const std::filesystem::path& file) {
  if (const auto found = kept.find(file.string()); found != kept.end())
    return found->second;
  if (!reads_once(file))
    return std::make_shared<Descriptor>(file, O_RDONLY);
  std::shared_ptr<Descriptor> content = read_to_end(file);
  if (keepers > 0)
    kept.emplace(file.string(), content);
  return content;
}

} // namespace keeler
