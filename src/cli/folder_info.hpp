// The content of a folder of results (run, sweep or study) for `keeler info`.
#pragma once

#include <nlohmann/json.hpp>

#include <filesystem>

namespace keeler::cli {

/// Returns the content under the names of `keeler info --json`. Throws IoError when the folder holds no results.
nlohmann::ordered_json describe_folder(const std::filesystem::path& folder);

/// Prints the result of describe_folder() as text.
void print_folder(const nlohmann::ordered_json& json);

} // namespace keeler::cli
