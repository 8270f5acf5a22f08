#include <keeler/io/particle_table.hpp>

#include "child_process.hpp"
#include "hdf5.hpp"
#include "stated_units.hpp"

#include <keeler/core/error.hpp>
#include <keeler/core/interrupt.hpp>
#include <keeler/files/columns.hpp>
#include <keeler/files/files.hpp>
#include <keeler/files/new_file.hpp>
#include <keeler/files/writers.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cassert>
#include <iterator>

namespace keeler::io {

namespace {

struct Column {
  const char* name;
  const char* unit; ///< optional suffix of the name

  std::string with_unit() const { return fmt::format("{}_{}", name, unit); }
};

constexpr std::array<Column, 11> known_columns = {{{"x", "m"},
                                                   {"y", "m"},
                                                   {"z", "m"},
                                                   {"vx", "m_s"},
                                                   {"vy", "m_s"},
                                                   {"vz", "m_s"},
                                                   {"r", "m"},
                                                   {"m", "kg"},
                                                   {"sx", "rad_s"},
                                                   {"sy", "rad_s"},
                                                   {"sz", "rad_s"}}};
constexpr std::size_t first_velocity = 3, radius_column = 6, mass = 7, first_spin = 8;
constexpr const char* id_column = "id";

// Returns the unit of a column, "m/s" for vx; empty for an id.
std::string unit_of(const std::string& name) {
  const auto is_named = [&](const Column& column) { return name == column.name || name == column.with_unit(); };
  const auto column = std::find_if(known_columns.begin(), known_columns.end(), is_named);
  if (column == known_columns.end())
    return {};
  std::string unit = column->unit;
  std::replace(unit.begin(), unit.end(), '_', '/');
  return unit;
}

// Indexed as known_columns; empty when the table lacks the column.
using KnownColumns = std::array<std::vector<double>, known_columns.size()>;

// Assigns columns by name. Throws UsageError for unknown, duplicate or missing ones; `location` is that of the names.
KnownColumns assign_columns(const std::vector<std::string>& names, std::vector<std::vector<double>> values,
                            const std::string& location) {
  assert(names.size() == values.size());
  const auto fail = [&](const std::string& message) {
    throw UsageError(fmt::format("{}: {} (the columns are x y z vx vy vz r, m, and sx sy sz)", location, message));
  };
  std::array<bool, known_columns.size()> has{};
  KnownColumns columns;
  for (std::size_t k = 0; k < names.size(); ++k) {
    if (names[k] == id_column)
      continue;
    const auto is_named = [&](const Column& column) {
      return names[k] == column.name || names[k] == column.with_unit();
    };
    const auto column = static_cast<std::size_t>(std::find_if(known_columns.begin(), known_columns.end(), is_named) -
                                                 known_columns.begin());
    if (column == known_columns.size())
      fail(fmt::format("unknown column '{}'; rename or remove it", names[k]));
    if (has[column])
      fail(fmt::format("two columns '{}'; remove one of them", names[k]));
    has[column] = true;
    columns[column] = std::move(values[k]);
  }
  const auto any = [&](std::size_t first) { return has[first] || has[first + 1] || has[first + 2]; };
  const auto needed = [&](std::size_t column) { // the position, the radius, and complete vectors
    return column < first_velocity || column == radius_column || (column < radius_column && any(first_velocity)) ||
           (column >= first_spin && any(first_spin));
  };
  for (std::size_t column = 0; column < known_columns.size(); ++column)
    if (!has[column] && needed(column))
      fail(fmt::format("the column '{}' is missing; add it", known_columns[column].name));
  return columns;
}

std::vector<Vec3> as_vectors(const KnownColumns& columns, std::size_t first) {
  assert(columns[first + 1].size() == columns[first].size() && columns[first + 2].size() == columns[first].size());
  std::vector<Vec3> vectors(columns[first].size());
  for (std::size_t k = 0; k < vectors.size(); ++k)
    vectors[k] = Vec3(columns[first][k], columns[first + 1][k], columns[first + 2][k]);
  return vectors;
}

ParticleTable table_of(const std::string& file, KnownColumns columns, std::vector<std::size_t> lines) {
  if (columns[radius_column].empty())
    throw UsageError(fmt::format("{}: the table is empty (a start needs a particle); add a row for each", file));
  return {file,
          as_vectors(columns, 0),
          as_vectors(columns, first_velocity),
          std::move(columns[radius_column]),
          std::move(columns[mass]),
          std::move(lines),
          as_vectors(columns, first_spin)};
}

ParticleTable read_text_table(std::span<const std::byte> bytes, const std::string& file) {
  const std::string_view text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  files::Columns columns = files::parse_columns(text, file);
  if (columns.names.empty())
    throw UsageError(fmt::format("{}: the table is empty (not even columns are named); begin with a line "
                                 "\"x,y,z,vx,vy,vz,r,m\"",
                                 file));
  const std::string header = fmt::format("{}:{}", file, columns.header_line);
  return table_of(file, assign_columns(columns.names, std::move(columns.values), header), std::move(columns.lines));
}

void require_no_snapshot(const std::vector<std::string>& names, const std::string& file) {
  const auto has = [&](const char* name) { return std::find(names.begin(), names.end(), name) != names.end(); };
  const auto has_particles = [](const std::string& name) { return name.starts_with("PartType"); };
  if (std::none_of(names.begin(), names.end(), has_particles))
    return;
  if (has("Code") && has("RingBox"))
    throw UsageError(fmt::format("{}: it is a snapshot, not a table; start from it by start.from or --from", file));
  throw UsageError(
      fmt::format("{}: it is a snapshot of another program, not a table (it has no /RingBox that describes the patch); "
                  "write x, y, z, vx, vy, vz, r and m of its particles in SI units as arrays in the root "
                  "of an HDF5 file, or as CSV",
                  file));
}

ParticleTable read_hdf5_table(std::span<const std::byte> bytes, const std::string& file) {
  const hdf5::Handle image = hdf5::open_image(bytes);
  const std::vector<std::string> names = hdf5::names_in(image);
  require_no_snapshot(names, file);
  assign_columns(names, std::vector<std::vector<double>>(names.size()), file); // checks names before reading arrays
  require_stated_units_of_groups(image, "the table");
  std::vector<std::vector<double>> values;
  for (const std::string& name : names) {
    const hdf5::Handle dataset = hdf5::open_dataset(image, name);
    const hdf5::Layout layout = hdf5::layout_of_dataset(dataset);
    if (!layout.is_numeric() || layout.shape.size() != 1)
      throw UsageError(fmt::format("{}: {} is not a one-dimensional array of numbers; write it as one", file, name));
    const std::string unit = unit_of(name);
    if (!unit.empty())
      require_stated_unit(dataset, name, unit);
    if (!values.empty() && values.front().size() != layout.count())
      throw UsageError(fmt::format("{}: {} has {} values, {} has {} (one per particle); make them equally long", file,
                                   name, layout.count(), names.front(), values.front().size()));
    values.emplace_back(layout.count());
    hdf5::read_dataset(dataset, hdf5::native_type<double>(), values.back().data());
    if (!unit.empty())
      require_none_missing(dataset, name, values.back());
  }
  return table_of(file, assign_columns(names, std::move(values), file), {});
}

void append_vector(fmt::memory_buffer& row, const Vec3& v) {
  fmt::format_to(std::back_inserter(row), ",{},{},{}", v.x(), v.y(), v.z());
}

} // namespace

std::string ParticleTable::location_of(std::size_t particle) const {
  assert(lines.empty() || particle < lines.size());
  return lines.empty() ? fmt::format("{}, row {}", file, particle) : fmt::format("{}:{}", file, lines[particle]);
}

ParticleTable read_particle_table(const std::filesystem::path& file) {
  const std::vector<std::byte> bytes = files::read_file(file);
  constexpr std::string_view signature = "\x89HDF\r\n\x1a\n";
  const std::string_view text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  if (!text.starts_with(signature))
    return read_text_table(bytes, file.string());
  const std::string what = fmt::format("read '{}' as HDF5", file.string());
  if (files::is_being_written(file))
    throw IoError(fmt::format("cannot {}: {}", what, files::being_written));
  return read_after_trial(what, limits_for(bytes.size()), [&] {
    try {
      return read_hdf5_table(bytes, file.string());
    } catch (const IoError& error) {
      throw IoError(fmt::format("cannot {}: {}", what, error.what()));
    }
  });
}

void write_particle_table(const std::filesystem::path& file, const Patch& patch) {
  constexpr std::size_t piece = std::size_t{1} << 22; // bytes
  assert(patch.orbital_frequency > 0.0);
  files::NewFile out(file);
  fmt::memory_buffer text;
  const auto write_text_so_far = [&] {
    throw_if_interrupted();
    out.write(std::as_bytes(std::span(text.data(), text.size())));
    text.clear();
  };
  fmt::format_to(std::back_inserter(text), "{}", id_column);
  for (std::size_t column = 0; column < (patch.spins.empty() ? first_spin : known_columns.size()); ++column)
    fmt::format_to(std::back_inserter(text), ",{}", known_columns[column].with_unit());
  for (std::size_t k = 0; k < patch.size(); ++k) {
    fmt::format_to(std::back_inserter(text), "\n{}", patch.ids[k]);
    append_vector(text, patch.positions[k]);
    append_vector(text, patch.velocities[k] * patch.orbital_frequency);
    fmt::format_to(std::back_inserter(text), ",{},{}", patch.radii[k], patch.masses[k]);
    if (!patch.spins.empty())
      append_vector(text, patch.spins[k] * patch.orbital_frequency);
    if (text.size() >= piece)
      write_text_so_far();
  }
  text.push_back('\n');
  write_text_so_far();
  out.keep();
}

} // namespace keeler::io
