#include <keeler/files/files.hpp>

#include "content.hpp"

#include <keeler/core/error.hpp>
#include <keeler/files/descriptor.hpp>

#include <fmt/format.h>

#include <cerrno>
#include <cstring>

#include <fcntl.h>
#include <unistd.h>

namespace keeler {
namespace {

// Removes a file when the scope is left, unless it was kept.
struct Leftover {
  std::filesystem::path file;
  bool keep = false;
  ~Leftover() {
    std::error_code ignored;
    if (!keep)
      std::filesystem::remove(file, ignored);
  }
};

std::filesystem::path folder_of(const std::filesystem::path& file) {
  return file.has_parent_path() ? file.parent_path() : std::filesystem::path(".");
}

template<class Bytes> Bytes read(const std::filesystem::path& file) {
  std::optional<Bytes> content = content_of<Bytes>(file);
  if (!content)
    throw IoError(fmt::format("cannot read '{}': {}", file.string(), std::strerror(errno)));
  return *std::move(content);
}

} // namespace

void write_file(const std::filesystem::path& file, std::span<const std::byte> content) {
  const std::filesystem::path temporary = file.string() + ".tmp";
  {
    Descriptor out(temporary, O_WRONLY | O_CREAT | O_TRUNC);
    Leftover leftover{temporary};
    out.write_all(content);
    out.sync();
    out.close();
    std::error_code error;
    std::filesystem::rename(temporary, file, error);
    if (error)
      throw IoError(fmt::format("cannot write '{}': {}", file.string(), error.message()));
    leftover.keep = true;
  }
  Descriptor(folder_of(file), O_RDONLY | O_DIRECTORY).sync();
}

void write_text(const std::filesystem::path& file, std::string_view text) {
  write_file(file, std::as_bytes(std::span(text)));
}

void require_writable_folder(const std::filesystem::path& folder, const std::filesystem::path& output) {
  std::error_code unknown; // no folder that is known of
  if (!std::filesystem::is_directory(folder, unknown) || access(folder.c_str(), W_OK) != 0)
    throw IoError(fmt::format("cannot write '{}': '{}' is no folder that can be written to; make it, or name another",
                              output.string(), folder.string()));
}

std::vector<std::byte> read_file(const std::filesystem::path& file) {
  return read<std::vector<std::byte>>(file);
}

std::string read_text(const std::filesystem::path& file) {
  return read<std::string>(file);
}

} // namespace keeler
