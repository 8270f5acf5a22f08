#include <keeler/files/files.hpp>

#include "content.hpp"

#include <keeler/core/error.hpp>
#include <keeler/files/descriptor.hpp>
#include <keeler/files/naming_guard.hpp>

#include <fmt/format.h>

#include <cerrno>
#include <cstring>
#include <utility>

#include <fcntl.h>
#include <unistd.h>

namespace keeler {
namespace {

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

NewFile::NewFile(std::filesystem::path file) : file_(std::move(file)), temporary_(file_.string() + ".tmp") {}

NewFile::~NewFile() {
  std::error_code ignored;
  if (!kept_ && std::filesystem::is_regular_file(temporary_, ignored))
    std::filesystem::remove(temporary_, ignored);
}

void NewFile::keep() {
  Descriptor(temporary_, O_RDONLY).sync();
  NamingGuard::ask();
  std::error_code error;
  std::filesystem::rename(temporary_, file_, error);
  if (error)
    throw IoError(fmt::format("cannot write '{}': {}", file_.string(), error.message()));
  kept_ = true;
  Descriptor(folder_of(file_), O_RDONLY | O_DIRECTORY).sync();
}

void write_file(const std::filesystem::path& file, std::span<const std::byte> content) {
  NewFile unfinished(file);
  Descriptor out(unfinished.temporary(), O_WRONLY | O_CREAT | O_TRUNC);
  out.write_all(content);
  out.close();
  unfinished.keep();
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
