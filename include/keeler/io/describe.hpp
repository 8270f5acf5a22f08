// What is in a file, without knowing more of it than its format: for `keeler info`.
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

namespace keeler {

enum class FileKind { checkpoint, snapshot, contacts };

struct FieldDescription {
  std::string name;
  std::string type;                 ///< "float64", "uint64", ...
  std::vector<std::uint64_t> shape; ///< empty for a scalar
  std::string unit;
  std::string about;
  std::string value; ///< of a scalar, else empty
};

struct FileDescription {
  FileKind kind = FileKind::snapshot;
  std::int64_t format_version = 0;
  std::vector<FieldDescription> fields;          ///< by name
  std::map<std::string, std::string> attributes; ///< "group/name" → value; the numbers of an array stand in [ ]
  std::string scene;                             ///< the resolved scene, as TOML
};

/// Describes a snapshot, a checkpoint or a file of contacts. Throws IoError for damage and for any other kind of file.
FileDescription describe_file(const std::filesystem::path& file);

/// Whether a seal vouches for the bytes of a file. Throws IoError where it does not match, or the file cannot be read.
bool is_sealed(const std::filesystem::path& file);

} // namespace keeler
