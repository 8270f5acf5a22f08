// The folder of a study: its study.json records the options and the program that started it.
#pragma once

#include "job_list.hpp"

#include <filesystem>
#include <functional>
#include <map>
#include <string>
#include <vector>

namespace keeler::study {

/// Returns the provenance of the measurements: command, host, processor, compiler, flags, commit.
std::map<std::string, std::string> study_provenance(const std::vector<std::string>& arguments);

/// Returns the sentence of a report on the provenance.
std::string made_by(const std::map<std::string, std::string>& provenance);

/// Makes the folder with its study.json, or checks that the existing one has these options. Returns the content of
/// study.json, provenance included. Throws UsageError when the folder holds another study or other files, and IoError.
Json open_study_folder(const std::filesystem::path& folder, const Json& options,
                       const std::map<std::string, std::string>& provenance);

/// Draws the figures of a study and then writes its report, even when drawing fails: that IoError is thrown after the
/// report is written. `draw` returns true if there are figures; `report` receives this value.
void draw_and_report(const std::function<bool()>& draw, const std::function<void(bool)>& report);

} // namespace keeler::study
