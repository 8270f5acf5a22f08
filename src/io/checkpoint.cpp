#include <keeler/io/checkpoint.hpp>

#include "field_rows.hpp"
#include "formats.hpp"
#include "provenance_attributes.hpp"
#include "sealed_file.hpp"

#include <keeler/core/error.hpp>
#include <keeler/io/hash.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <optional>

namespace keeler::io {
namespace {

// A field in a file.
struct StoredField {
  std::string name;
  hdf5::Layout layout;
  hdf5::Handle dataset;

  std::size_t rows() const { return layout.shape.empty() ? 1 : layout.shape[0]; }
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

// Inverse of type_name().
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

// Hashes the fields, in order of their names, and the scene; provenance is excluded.
class ContentChecksum {
public:
  /// Begins a field; add() all of its rows before the next one.
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

StoredField open_field(const hdf5::Handle& group, const std::string& name) {
  hdf5::Handle dataset = hdf5::open_dataset(group, name);
  hdf5::Layout layout = hdf5::layout_of_dataset(dataset);
  if (!field_type_named(layout.type))
    throw IoError(fmt::format("field '{}' has the unknown type '{}'", name, layout.type));
  return {name, std::move(layout), std::move(dataset)};
}

// Opens all fields, sorted by name.
std::vector<StoredField> open_fields(const hdf5::Handle& root) {
  const hdf5::Handle group = hdf5::open_group(root, "fields");
  std::vector<StoredField> fields;
  for (const std::string& name : hdf5::names_in(group))
    fields.push_back(open_field(group, name));
  return fields;
}

// Reads rows [first, first + count).
void read_field(const StoredField& field, std::size_t first, std::size_t count, void* into) {
  assert(first + count <= field.rows());
  const hid_t type = hdf5::native_type(*field_type_named(field.layout.type));
  if (field.layout.shape.empty())
    hdf5::read_dataset(field.dataset, type, into);
  else
    hdf5::read_rows(field.dataset, type, first, count, into);
}

// Hashes all rows of a field, piece by piece.
void add_rows(ContentChecksum& checksum, const StoredField& field) {
  const std::size_t rows = field.rows(), bytes = field.layout.count() * size_of(*field_type_named(field.layout.type));
  if (bytes == 0)
    return;
  const std::size_t row_bytes = bytes / rows;
  const std::size_t at_a_time = std::clamp<std::size_t>(FieldRows::max_piece / row_bytes, 1, rows);
  std::vector<std::byte> piece(at_a_time * row_bytes);
  for (std::size_t first = 0; first < rows; first += at_a_time) {
    const std::size_t count = std::min(at_a_time, rows - first);
    read_field(field, first, count, piece.data());
    checksum.add(std::span(piece).first(count * row_bytes));
  }
}

void require_checksum(const hdf5::Handle& root, const std::vector<StoredField>& fields, const std::string& scene) {
  ContentChecksum checksum;
  for (const StoredField& field : fields) {
    checksum.begin(field.name, field.layout);
    add_rows(checksum, field);
  }
  if (checksum.finish(scene) != hdf5::read_text_attribute(root, "checksum"))
    throw IoError("its fields do not match their checksum");
}

// Returns the stored field that corresponds to a field of the table. Throws IoError when there is none or its layout
// differs.
const StoredField& match(const std::vector<StoredField>& stored, const Field& field) {
  const auto found =
      std::find_if(stored.begin(), stored.end(), [&](const StoredField& other) { return other.name == field.name; });
  if (found == stored.end())
    throw IoError(fmt::format("it has no field '{}'", field.name));
  hdf5::Layout expected = layout_of(field, field.rows());
  if (!field.scalar && !found->layout.shape.empty())
    expected.shape[0] = found->layout.shape[0]; // the file determines the number of rows
  if (describe(expected) != describe(found->layout))
    throw IoError(
        fmt::format("field '{}' is {} there and {} here", field.name, describe(found->layout), describe(expected)));
  return *found;
}

// Throws IoError for a stored field that the table lacks: without it the run would not continue exactly.
void check_nothing_forgotten(const std::vector<StoredField>& stored, const FieldTable& table) {
  for (const StoredField& field : stored)
    if (table.find(field.name) == nullptr)
      throw IoError(fmt::format("it has a field '{}' that this run does not have", field.name));
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

// Writes a checkpoint. All members are collective; only the root rank has the file.
class NewCheckpoint {
public:
  NewCheckpoint(const std::filesystem::path& file, const CheckpointHeader& header, const Communicator& ranks)
      : header_(header), ranks_(ranks) {
    ranks_.on_root([&] { file_.emplace(file); });
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
    ranks_.on_root([&] { file_->finish(); });
  }

private:
  template<class Work> void write(const Work& work) {
    ranks_.on_root([&] { file_->write(work); });
  }

  const CheckpointHeader& header_;
  Communicator ranks_;
  std::optional<SealedFile> file_;
  ContentChecksum checksum_;
};

std::vector<const Field*> sorted_by_name(const FieldTable& table) {
  std::vector<const Field*> fields;
  for (const Field& field : table.fields())
    fields.push_back(&field);
  std::sort(fields.begin(), fields.end(), [](const Field* a, const Field* b) { return a->name < b->name; });
  assert(std::adjacent_find(fields.begin(), fields.end(),
                            [](const Field* a, const Field* b) { return a->name == b->name; }) == fields.end());
  return fields;
}

} // namespace

void write_checkpoint(const std::filesystem::path& file, const FieldTable& table, const CheckpointHeader& header,
                      const Communicator& ranks) {
  NewCheckpoint made(file, header, ranks);
  for (const Field* field : sorted_by_name(table))
    made.add(*field);
  made.finish();
}

struct Checkpoint::Parts {
  std::filesystem::path file;
  Communicator ranks;
  CheckpointHeader header;
  std::optional<hdf5::Handle> root;
  std::vector<StoredField> fields; // sorted by name

  // Opens the file; without the seal of an already verified file, verifies it.
  void open(const std::optional<std::string>& seal) {
    root.emplace(seal ? open_sealed(file, *seal) : open_sealed(file));
    try {
      check_format(*root);
      header.scene = hdf5::read_text_dataset(*root, "scene");
      header.provenance = read_provenance(hdf5::open_group(*root, "provenance"));
      fields = open_fields(*root);
      if (!seal)
        require_checksum(*root, fields, header.scene);
    } catch (const IoError& error) {
      throw IoError(fmt::format("cannot read checkpoint '{}': {}", file.string(), error.what()));
    }
  }

  void require_fit(const FieldTable& table) const {
    try {
      check_nothing_forgotten(fields, table);
      for (const Field& field : table.fields())
        match(fields, field);
    } catch (const IoError& error) {
      throw IoError(fmt::format("checkpoint '{}' does not fit: {}", file.string(), error.what()));
    }
  }

  // Reads all rows of a field, or this rank's part of a divided one.
  void fill(const Field& field) const {
    const StoredField& source = match(fields, field);
    const std::size_t all = source.rows(), parts = field.divided ? ranks.size() : 1,
                      part = field.divided ? ranks.rank() : 0;
    assert(part < parts);
    const std::size_t first = all * part / parts, end = all * (part + 1) / parts;
    field.resize(end - first);
    read_field(source, first, end - first, field.data());
  }
};

Checkpoint::Checkpoint(const std::filesystem::path& file, const Communicator& ranks)
    : parts_(std::make_unique<Parts>()) {
  parts_->file = file;
  parts_->ranks = ranks;
  std::string seal;
  ranks.on_root([&] {
    parts_->open(std::nullopt);
    seal = seal_in(file);
  });
  ranks.broadcast(seal);
  ranks.together([&] {
    if (!ranks.is_root())
      parts_->open(seal);
  });
}

Checkpoint::~Checkpoint() = default;

const CheckpointHeader& Checkpoint::header() const {
  return parts_->header;
}

void Checkpoint::read(const FieldTable& table) const {
  parts_->ranks.together([&] { parts_->require_fit(table); });
  parts_->ranks.together([&] {
    for (const Field& field : table.fields())
      parts_->fill(field);
  });
}

} // namespace keeler::io
