// Reads and writes whole files. Writing is atomic (new_file.hpp): a name always refers to a complete file.
#pragma once

#include <cstddef>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace keeler::files {

/// Returns the folder of a file; "." for a bare name.
std::filesystem::path folder_of(const std::filesystem::path& file);

/// Writes a file; after a failure the former file is unchanged and no other is left. Throws IoError.
/// Precondition: a process with a file-size limit ignores SIGXFSZ, which would end it before the error is reported.
void write_file(const std::filesystem::path& file, std::span<const std::byte> content);

/// Writes a text as write_file() does.
void write_text(const std::filesystem::path& file, std::string_view text);

/// Throws IoError, naming `output`, unless `folder` is a writable folder. Call it before long work for `output`.
void require_writable_folder(const std::filesystem::path& folder, const std::filesystem::path& output);

/// True for a pipe or a device, which can be read only once.
bool reads_once(const std::filesystem::path& file);

/// Returns all bytes of a file. Throws IoError, also when they do not fit into memory; Interrupted while it waits for a
/// pipe or a device.
std::vector<std::byte> read_file(const std::filesystem::path& file);
std::string read_text(const std::filesystem::path& file);

/// Reads a text without the byte order mark and carriage returns that Windows tools add.
std::string read_lines(const std::filesystem::path& file);

} // namespace keeler::files
