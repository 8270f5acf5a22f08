// What is in a folder of results: of a run, a sweep or a study. For `keeler info`.
#pragma once

#include <nlohmann/json.hpp>

#include <filesystem>

namespace keeler {

/// Under the names of `keeler info --json`. Throws IoError when the folder holds none of them.
nlohmann::ordered_json describe_folder(const std::filesystem::path& folder);

/// The same in words.
void print_folder(const nlohmann::ordered_json& json);

} // namespace keeler
