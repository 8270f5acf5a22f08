// Version and build of this program, for the provenance of files and for `keeler --version`.
#pragma once

#include <string>

namespace keeler {

/// Returns the version, "major.minor.patch".
std::string program_version();

/// Returns the git commit of the sources, with the suffix "-dirty" if tracked files had changed; "unknown" outside a
/// repository.
std::string source_commit();

/// Returns the compiler and its version.
std::string build_compiler();

/// Returns the compiler flags that all of Keeler uses.
std::string build_flags();

} // namespace keeler
