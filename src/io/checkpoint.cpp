#include <keeler/io/checkpoint.hpp>

#include "field_rows.hpp"
#include "formats.hpp"
#include "provenance_attributes.hpp"
#include "sealed_file.hpp"

#include <keeler/core/error.hpp>
#include <keeler/io/hash.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <optional>

namespace keeler {
namespace {

// A field as it lies in a file.
struct StoredField {
  std::string name;
  hdf5::Layout layout;
  std::vector<std::byte> bytes;
};

struct StoredCheckpoint {
  CheckpointHeader header;
  std::vector<StoredField> fields; // by name
};

constexpr FieldType field_types[] = {FieldType::float64, FieldType::float32, FieldType::int64, FieldType::uint64,
                                     FieldType::uint32};

const char* type_name(FieldType type) {
  switch (type) {
  case FieldType::float64:
    return "float64";
  case FieldType::float32:
    return "float32";
  case FieldType::int64:
    return "int64";
  case FieldType::uint64:
    return "uint64";
  case FieldType::uint32:
    break;
  }
  return "uint32";
}

std::optional<FieldType> field_type_named(const std::string& name) {
  for (const FieldType type : field_types)
    if (name == type_name(type))
      return type;
  return std::nullopt;
}

hdf5::Layout layout_of(const Field& field, std::size_t rows) {
  hdf5::Layout layout{type_name(field.type), {}};
  if (!field.scalar)
    layout.shape.push_back(rows);
  if (field.components > 1)
    layout.shape.push_back(field.components);
  return layout;
}

std::string describe(const hdf5::Layout& layout) {
  return layout.shape.empty() ? layout.type : fmt::format("{} [{}]", layout.type, fmt::join(layout.shape, " x "));
}

// Over the fields in order of their names, and the scene; provenance is left out.
class ContentChecksum {
public:
  /// Then its rows, all of them before the next field.
  void begin(const std::string& name, const hdf5::Layout& layout) {
    hash_.add_text(name);
    hash_.add_text(describe(layout));
  }
  void add(std::span<const std::byte> rows) { hash_.add_bytes(rows); }
  std::string finish(const std::string& scene) {
    hash_.add_text(scene);
    return hash_.hex();
  }

private:
  Hash hash_;
};

void check_format(const hdf5::Handle& image) {
  if (!hdf5::has_attribute(image, "format") || hdf5::read_text_attribute(image, "format") != checkpoint_format)
    throw IoError("it is not a checkpoint");
  require_version(image, hdf5::open_group(image, "provenance"), {checkpoint_version, checkpoint_version},
                  ", or begin a run from its newest snapshot");
}

StoredField load_field(const hdf5::Handle& group, const std::string& name) {
  const hdf5::Handle dataset = hdf5::open_dataset(group, name);
  StoredField field{name, hdf5::layout_of_dataset(dataset), {}};
  const std::optional<FieldType> type = field_type_named(field.layout.type);
  if (!type)
    throw IoError(fmt::format("field '{}' has the unknown type '{}'", name, field.layout.type));
  field.bytes.resize(field.layout.count() * size_of(*type));
  hdf5::read_dataset(dataset, hdf5::native_type(*type), field.bytes.data());
  return field;
}

StoredCheckpoint load(const hdf5::Handle& image) {
  check_format(image);
  StoredCheckpoint stored;
  stored.header.scene = hdf5::read_text_dataset(image, "scene");
  stored.header.provenance = read_provenance(hdf5::open_group(image, "provenance"));
  const hdf5::Handle group = hdf5::open_group(image, "fields");
  ContentChecksum checksum;
  for (const std::string& name : hdf5::names_in(group)) {
    stored.fields.push_back(load_field(group, name));
    const StoredField& field = stored.fields.back();
    checksum.begin(field.name, field.layout);
    checksum.add(field.bytes);
  }
  if (checksum.finish(stored.header.scene) != hdf5::read_text_attribute(image, "checksum"))
    throw IoError("its fields do not match their checksum");
  return stored;
}

StoredCheckpoint load(const std::filesystem::path& file) {
  const hdf5::Handle image = open_sealed(file);
  try {
    return load(image);
  } catch (const IoError& error) {
    throw IoError(fmt::format("cannot read checkpoint '{}': {}", file.string(), error.what()));
  }
}

// The stored field that belongs to a field of the table.
const StoredField& match(const std::vector<StoredField>& stored, const Field& field) {
  const auto found =
      std::find_if(stored.begin(), stored.end(), [&](const StoredField& other) { return other.name == field.name; });
  if (found == stored.end())
    throw IoError(fmt::format("it has no field '{}'", field.name));
  hdf5::Layout expected = layout_of(field, field.rows());
  if (!field.scalar && !found->layout.shape.empty())
    expected.shape[0] = found->layout.shape[0]; // the number of rows is the file's to say
  if (describe(expected) != describe(found->layout))
    throw IoError(
        fmt::format("field '{}' is {} there and {} here", field.name, describe(found->layout), describe(expected)));
  return *found;
}

// A field that the table lacks would be forgotten, and the run would not continue as it was.
void check_nothing_forgotten(const std::vector<StoredField>& stored, const FieldTable& table) {
  for (const StoredField& field : stored)
    if (table.find(field.name) == nullptr)
      throw IoError(fmt::format("it has a field '{}' that this run does not know", field.name));
}

void write_header(const hdf5::Handle& root, const CheckpointHeader& header) {
  hdf5::write_attribute(root, "format", std::string_view(checkpoint_format));
  hdf5::write_attribute(root, "format_version", checkpoint_version);
  hdf5::write_text_dataset(root, "scene", header.scene);
  write_provenance(hdf5::create_group(root, "provenance"), header.provenance);
  hdf5::create_group(root, "fields");
}

hdf5::Handle create_field(const hdf5::Handle& root, const Field& field, const hdf5::Layout& layout) {
  const hdf5::Handle group = hdf5::open_group(root, "fields");
  hdf5::Handle dataset = hdf5::create_dataset(group, field.name, hdf5::native_type(field.type), layout.shape);
  hdf5::write_attribute(dataset, "unit", field.unit);
  hdf5::write_attribute(dataset, "about", field.about);
  return dataset;
}

// The first rank's file, for all.
class NewCheckpoint {
public:
  NewCheckpoint(const std::filesystem::path& file, const CheckpointHeader& header, const Ranks& ranks)
      : header_(header), ranks_(ranks) {
    ranks_.first_does([&] { file_.emplace(file); });
    write([&](const hdf5::Handle& root) { write_header(root, header); });
  }

  void add(const Field& field) {
    const FieldRows rows(field, ranks_);
    const hdf5::Layout layout = layout_of(field, rows.count());
    const hid_t type = hdf5::native_type(field.type);
    std::optional<hdf5::Handle> dataset;
    write([&](const hdf5::Handle& root) {
      dataset.emplace(create_field(root, field, layout));
      checksum_.begin(field.name, layout);
    });
    rows.visit([&](std::size_t first, std::size_t count, std::span<const std::byte> bytes) {
      write([&](const hdf5::Handle&) {
        checksum_.add(bytes);
        if (field.scalar)
          hdf5::write_scalar(*dataset, type, bytes.data());
        else
          hdf5::write_rows(*dataset, type, first, count, bytes.data());
      });
    });
  }

  void finish() {
    write([&](const hdf5::Handle& root) { hdf5::write_attribute(root, "checksum", checksum_.finish(header_.scene)); });
    ranks_.first_does([&] { file_->finish(); });
  }

private:
  template<class Work> void write(const Work& work) {
    ranks_.first_does([&] { file_->write(work); });
  }

  const CheckpointHeader& header_;
  Ranks ranks_;
  std::optional<SealedFile> file_;
  ContentChecksum checksum_;
};

std::vector<const Field*> by_name(const FieldTable& table) {
  std::vector<const Field*> fields;
  for (const Field& field : table.fields())
    fields.push_back(&field);
  std::sort(fields.begin(), fields.end(), [](const Field* a, const Field* b) { return a->name < b->name; });
  return fields;
}

} // namespace

void write_checkpoint(const std::filesystem::path& file, const FieldTable& table, const CheckpointHeader& header,
                      const Ranks& ranks) {
  NewCheckpoint made(file, header, ranks);
  for (const Field* field : by_name(table))
    made.add(*field);
  made.finish();
}

CheckpointHeader read_checkpoint(const std::filesystem::path& file, const FieldTable& table) {
  const StoredCheckpoint stored = load(file);
  try {
    check_nothing_forgotten(stored.fields, table);
    for (const Field& field : table.fields())
      match(stored.fields, field);
  } catch (const IoError& error) {
    throw IoError(fmt::format("checkpoint '{}' does not fit: {}", file.string(), error.what()));
  }
  for (const Field& field : table.fields()) {
    const StoredField& source = match(stored.fields, field);
    if (!field.scalar)
      field.resize(source.layout.shape[0]);
    std::copy(source.bytes.begin(), source.bytes.end(), static_cast<std::byte*>(field.data()));
  }
  return stored.header;
}

CheckpointHeader read_checkpoint_header(const std::filesystem::path& file) {
  return load(file).header;
}

} // namespace keeler
