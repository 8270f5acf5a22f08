// Whole files, read, and written as new_file.hpp says: a name always means a complete file.
#pragma once

#include <cstddef>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace keeler {

/// The folder that a file is in, or is to be in: "." of a name alone.
std::filesystem::path folder_of(const std::filesystem::path& file);

/// Writes a file; after a failure what was there before is there, and nothing else. Throws IoError.
/// A process that sets a file-size limit must ignore SIGXFSZ, else that signal ends it before the error is seen.
void write_file(const std::filesystem::path& file, std::span<const std::byte> content);

/// The same for text.
void write_text(const std::filesystem::path& file, std::string_view text);

/// Before work whose result goes to `output`: throws IoError unless this is a folder that can be written to.
void require_writable_folder(const std::filesystem::path& folder, const std::filesystem::path& output);

/// All bytes of a file. Throws IoError, also where there is not memory enough for them; Interrupted while it waits for
/// a pipe or a device.
std::vector<std::byte> read_file(const std::filesystem::path& file);
std::string read_text(const std::filesystem::path& file);

/// The same of a text of lines, as it was before a tool of Windows put a byte order mark and carriage returns into it.
std::string read_lines(const std::filesystem::path& file);

} // namespace keeler
