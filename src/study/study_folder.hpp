// The folder of a study: with which options it was begun, and by which program.
#pragma once

#include "job_list.hpp"

#include <filesystem>
#include <functional>
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

/// Draws the figures of a study, and then writes its report, which has the numbers whatever becomes of the figures: one
/// that cannot be drawn is told afterwards. `draw` returns whether there are figures, `report` takes it. Throws
/// IoError.
void draw_and_report(const std::function<bool()>& draw, const std::function<void(bool)>& report);

} // namespace keeler
