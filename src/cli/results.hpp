// Files that commands write where the user says: what may take the place of what.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

namespace keeler {

/// Refuses to make a file ("a state") where there is a folder, where there is one unless `force`, or where none can be
/// made. Throws UsageError, IoError.
void require_new_file(const std::string& path, bool force, const std::string& what);

/// Pictures, pages and tables are made again as often as one likes, but take the place of nothing else: refuses a
/// folder, and a file that does not have these bytes at this place. Throws UsageError, IoError.
void require_replaceable(const std::filesystem::path& file, const std::string& what, std::string_view bytes,
                         std::size_t place = 0);

/// Writes a table over nothing, or over one with the same columns. Throws UsageError, IoError.
void write_table(const std::filesystem::path& file, const std::string& table);

} // namespace keeler
