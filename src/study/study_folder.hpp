// The folder of a study: with which options it was begun, and by which program.
#pragma once

#include "job_list.hpp"

#include <filesystem>
#include <map>
#include <string>
#include <vector>

namespace keeler {

/// Who measures: command, host, processor, compiler, flags, commit.
std::map<std::string, std::string> study_builder(const std::vector<std::string>& arguments);

/// Makes the folder with its study.json, or checks that it holds a study of the same options. Returns what is written
/// of it, its builder included. Throws UsageError when it holds another study or other things, IoError.
Json open_study_folder(const std::filesystem::path& folder, const Json& options,
                       const std::map<std::string, std::string>& builder);

} // namespace keeler
