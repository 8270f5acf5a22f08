// Files that a user names: their text, and the rows of numbers in it. What is wrong with them is the user's to mend, so
// faults are UsageErrors that begin with the place where the file was named.
#pragma once

#include <filesystem>
#include <functional>
#include <span>
#include <string>
#include <string_view>

namespace keeler {

/// The text without the byte order mark of UTF-8 that some editors and spreadsheets put before it.
std::string_view without_byte_order_mark(std::string_view text);

/// Throws UsageError "WHATis a text in UTF-16 …; save it as UTF-8" where it begins as such texts do.
void refuse_utf16(std::string_view text, const std::string& what);

/// The whole file without a byte order mark, named at `place` ("scene.toml:7:9", or the file itself). Throws UsageError
/// "PLACE: FILE cannot be read (why); …", also where the file has more than 1 GiB or does not end, and for UTF-16.
std::string read_input(const std::filesystem::path& file, const std::string& place);

/// Hands over each row of numbers in a text, with the number of its line, from 1. Blanks, commas or semicolons part the
/// numbers, '#' starts a comment, and a line with nothing else is no row. A word that is not a number is handed over as
/// NaN.
void for_each_row(const std::string& text, const std::function<void(int line, std::span<const double> numbers)>& visit);

} // namespace keeler
