// What this build of Keeler is: provenance for files, and what `keeler --version` prints.
#pragma once

#include <string>

namespace keeler {

/// Program version, "major.minor.patch".
std::string program_version();

/// Git commit that the sources stood at when they were built, with "-dirty" after it when tracked files had changed;
/// "unknown" outside a repository.
std::string source_commit();

/// Compiler and its version.
std::string build_compiler();

/// Compiler flags shared by all of Keeler.
std::string build_flags();

} // namespace keeler
