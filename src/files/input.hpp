// Input files that a user names. Their faults are UsageErrors that begin with the location where the file was named,
// because the user can correct them.
#pragma once

#include <filesystem>
#include <functional>
#include <span>
#include <string>
#include <string_view>

namespace keeler::files {

/// Removes the UTF-8 byte order mark that some editors and spreadsheets write.
std::string_view without_byte_order_mark(std::string_view text);

/// Throws UsageError "WHATis a text in UTF-16 …; save it as UTF-8" if the text begins with a UTF-16 byte order mark.
void refuse_utf16(std::string_view text, const std::string& what);

/// Returns the whole file without a byte order mark. It was named at `location` ("scene.toml:7:9", or the file itself).
/// Throws UsageError "LOCATION: FILE cannot be read (why); …", also above 1 GiB or without an end, and for UTF-16.
std::string read_input(const std::filesystem::path& file, const std::string& location);

/// Calls visit(line, numbers) for each row of numbers in a text; lines count from 1. Numbers are separated by blanks,
/// commas or semicolons, '#' starts a comment, and empty lines are skipped. A word that is not a number becomes NaN.
void for_each_row(const std::string& text, const std::function<void(int line, std::span<const double> numbers)>& visit);

} // namespace keeler::files
