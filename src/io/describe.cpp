#include <keeler/io/describe.hpp>

#include "formats.hpp"
#include "sealed_file.hpp"

#include <keeler/core/error.hpp>
#include <keeler/files/descriptor.hpp>

#include <fmt/format.h>

#include <cassert>
#include <span>
#include <string_view>

#include <fcntl.h>

namespace keeler::io {

namespace {

// Returns one value, or all in [ ]. Precondition: a scalar has one value.
std::string joined(const std::vector<std::string>& values, bool scalar) {
  assert(!scalar || values.size() == 1);
  return scalar ? values.front() : fmt::format("[{}]", fmt::join(values, ", "));
}

// Returns the numbers that `read` fills in as text, floating point in digits that read back bit for bit.
template<class Read> std::string numbers_as_text(const hdf5::Layout& layout, const Read& read) {
  std::vector<std::string> texts;
  const auto append_all = [&](auto values) {
    read(hdf5::native_type<typename decltype(values)::value_type>(), values.data());
    for (const auto value : values)
      texts.push_back(fmt::format("{}", value));
  };
  if (layout.type.starts_with("float"))
    append_all(std::vector<double>(layout.count()));
  else if (layout.type.starts_with("uint"))
    append_all(std::vector<std::uint64_t>(layout.count()));
  else if (layout.type.starts_with("int"))
    append_all(std::vector<std::int64_t>(layout.count()));
  else
    return "(" + layout.type + ")";
  return joined(texts, layout.shape.empty());
}

std::string attribute_as_text(const hdf5::Handle& object, const std::string& name) {
  const hdf5::Layout layout = hdf5::layout_of_attribute(object, name);
  if (layout.type == "text")
    return hdf5::read_text_attribute(object, name);
  return numbers_as_text(
      layout, [&](hid_t type, void* into) { hdf5::read_attribute(object, name, type, layout.count(), into); });
}

void add_attributes(FileDescription& description, const hdf5::Handle& object, const std::string& group) {
  for (const std::string& name : hdf5::attribute_names(object))
    description.attributes[group + "/" + name] = attribute_as_text(object, name);
}

FieldDescription describe_field(const hdf5::Handle& group, const std::string& name) {
  const hdf5::Handle dataset = hdf5::open_dataset(group, name);
  const hdf5::Layout layout = hdf5::layout_of_dataset(dataset);
  FieldDescription field;
  field.name = name;
  field.type = layout.type;
  field.shape.assign(layout.shape.begin(), layout.shape.end());
  for (const auto& [attribute, text] : {std::pair("unit", &field.unit), std::pair("about", &field.about)})
    if (hdf5::has_attribute(dataset, attribute))
      *text = hdf5::read_text_attribute(dataset, attribute);
  if (layout.shape.empty())
    field.value = numbers_as_text(layout, [&](hid_t type, void* into) { hdf5::read_dataset(dataset, type, into); });
  return field;
}

void add_fields(FileDescription& description, const hdf5::Handle& image, const std::string& group_name) {
  const hdf5::Handle group = hdf5::open_group(image, group_name);
  for (const std::string& name : hdf5::names_in(group))
    if (hdf5::is_dataset(group, name)) // another tool may have added a group
      description.fields.push_back(describe_field(group, name));
}

bool has_format(const hdf5::Handle& object, const char* format) {
  return hdf5::has_attribute(object, "format") && hdf5::read_text_attribute(object, "format") == format;
}

FileDescription describe_checkpoint(const hdf5::Handle& image) {
  FileDescription description;
  description.kind = FileKind::checkpoint;
  description.format_version = hdf5::read_attribute<std::int64_t>(image, "format_version");
  add_fields(description, image, "fields");
  add_attributes(description, image, "");
  add_attributes(description, hdf5::open_group(image, "provenance"), "provenance");
  description.scene = hdf5::read_text_dataset(image, "scene");
  return description;
}

// Describes a snapshot or contact file: format in /Code, scene in /Parameters, arrays in `table`.
FileDescription describe_table(const hdf5::Handle& image, FileKind kind, const char* table,
                               std::initializer_list<const char*> groups) {
  FileDescription description;
  description.kind = kind;
  description.format_version = hdf5::read_attribute<std::int64_t>(hdf5::open_group(image, "Code"), "format_version");
  add_fields(description, image, table);
  for (const char* group : groups)
    if (hdf5::exists(image, group))
      add_attributes(description, hdf5::open_group(image, group), group);
  description.scene = hdf5::read_text_attribute(hdf5::open_group(image, "Parameters"), "scene");
  return description;
}

std::optional<FileKind> kind_in(const hdf5::Handle& image) {
  if (has_format(image, checkpoint_format))
    return FileKind::checkpoint;
  if (!hdf5::exists(image, "Code"))
    return std::nullopt;
  const hdf5::Handle code = hdf5::open_group(image, "Code");
  if (has_format(code, snapshot_format))
    return FileKind::snapshot;
  return has_format(code, contacts_format) ? std::optional(FileKind::contacts) : std::nullopt;
}

FileDescription description_in(const hdf5::Handle& image, const std::filesystem::path& file) {
  try {
    if (has_format(image, checkpoint_format))
      return describe_checkpoint(image);
    if (hdf5::exists(image, "Code")) {
      const hdf5::Handle code = hdf5::open_group(image, "Code");
      if (has_format(code, snapshot_format))
        return describe_table(image, FileKind::snapshot, particles_group,
                              {"Header", "RingBox", "Code", clumping_group});
      if (has_format(code, contacts_format))
        return describe_table(image, FileKind::contacts, "Contacts", {"Contacts", "Code"});
    }
  } catch (const IoError& error) {
    throw IoError(fmt::format("cannot read '{}': {}", file.string(), error.what()));
  }
  throw IoError(fmt::format("'{}' is no snapshot, checkpoint or file of contacts of Keeler", file.string()));
}

} // namespace

FileDescription describe_file(const std::filesystem::path& file) {
  const auto read = [&](const hdf5::Handle& image) { return description_in(image, file); };
  return read_content(file, read);
}

std::optional<FileKind> kind_of(const std::filesystem::path& file) {
  constexpr std::string_view signature = "\x89HDF\r\n\x1a\n";
  if (!has_seal(file)) {
    std::string start(signature.size(), '\0');
    files::Descriptor(file, O_RDONLY).read_at(0, std::as_writable_bytes(std::span(start)));
    if (start != signature)
      return std::nullopt;
  }
  const auto read = [&](const hdf5::Handle& image) {
    try {
      return kind_in(image);
    } catch (const IoError& error) {
      throw IoError(fmt::format("cannot read '{}': {}", file.string(), error.what()));
    }
  };
  return read_content(file, read);
}

bool is_sealed(const std::filesystem::path& file) {
  return load_content(file).sealed;
}

} // namespace keeler::io
