// The content of a file described from its format alone: for `keeler info`.
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace keeler::io {

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
  std::vector<FieldDescription> fields;          ///< sorted by name
  std::map<std::string, std::string> attributes; ///< "group/name" → value; arrays in [ ]
  std::string scene;                             ///< the resolved scene, as TOML
};

/// Describes a snapshot, a checkpoint or a contact file. Throws IoError for damage and for any other kind of file.
FileDescription describe_file(const std::filesystem::path& file);

/// Returns the kind of a file; none if it is another one (HDF5 of another program, a text, ...). Throws IoError when it
/// is damaged or cannot be read.
std::optional<FileKind> kind_of(const std::filesystem::path& file);

/// True if the file has a seal. Throws IoError when the seal does not match, or the file cannot be read.
bool is_sealed(const std::filesystem::path& file);

} // namespace keeler::io
