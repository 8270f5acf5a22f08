#include <keeler/files/files.hpp>

#include "content.hpp"

#include <keeler/core/error.hpp>
#include <keeler/files/input.hpp>
#include <keeler/files/new_file.hpp>

#include <fmt/format.h>

#include <unistd.h>

namespace keeler::files {
namespace {

template<class Bytes> Bytes read(const std::filesystem::path& file) {
  std::optional<Bytes> content = content_of<Bytes>(file);
  if (!content)
    throw IoError(fmt::format("cannot read '{}': {}", file.string(), why_unread()));
  return *std::move(content);
}

} // namespace

std::filesystem::path folder_of(const std::filesystem::path& file) {
  return file.has_parent_path() ? file.parent_path() : std::filesystem::path(".");
}

void write_file(const std::filesystem::path& file, std::span<const std::byte> content) {
  NewFile unfinished(file);
  unfinished.write(content);
  unfinished.keep();
}

void write_text(const std::filesystem::path& file, std::string_view text) {
  write_file(file, std::as_bytes(std::span(text)));
}

void require_writable_folder(const std::filesystem::path& folder, const std::filesystem::path& output) {
  std::error_code unknown; // then it is not a folder
  if (!std::filesystem::is_directory(folder, unknown) || access(folder.c_str(), W_OK) != 0)
    throw IoError(fmt::format("cannot write '{}': '{}' is not a writable folder; create it, or name another",
                              output.string(), folder.string()));
}

std::vector<std::byte> read_file(const std::filesystem::path& file) {
  return read<std::vector<std::byte>>(file);
}

std::string read_text(const std::filesystem::path& file) {
  return read<std::string>(file);
}

std::string read_lines(const std::filesystem::path& file) {
  std::string text = read_text(file);
  text.erase(0, text.size() - without_byte_order_mark(text).size());
  std::size_t kept = 0;
  for (std::size_t at = 0; at < text.size(); ++at)
    if (text[at] != '\r' || at + 1 == text.size() || text[at + 1] != '\n')
      text[kept++] = text[at];
  text.resize(kept);
  return text;
}

} // namespace keeler::files
