#include "table_columns.hpp"

#include <keeler/core/error.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cassert>

namespace keeler::io {

namespace {

constexpr std::array<TableColumn, column_count> known_columns = {{{"x", "m"},
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

std::vector<Vec3> as_vectors(const KnownColumns& columns, std::size_t first) {
  assert(columns[first + 1].size() == columns[first].size() && columns[first + 2].size() == columns[first].size());
  std::vector<Vec3> vectors(columns[first].size());
  for (std::size_t k = 0; k < vectors.size(); ++k)
    vectors[k] = Vec3(columns[first][k], columns[first + 1][k], columns[first + 2][k]);
  return vectors;
}

} // namespace

std::string TableColumn::with_unit() const {
  return fmt::format("{}_{}", name, unit);
}

std::string TableColumn::unit_text() const {
  std::string text = unit;
  std::replace(text.begin(), text.end(), '_', '/');
  return text;
}

const std::array<TableColumn, column_count>& table_columns() {
  return known_columns;
}

const TableColumn* column_named(const std::string& name) {
  const auto* const column = std::find_if(known_columns.begin(), known_columns.end(), [&](const TableColumn& known) {
    return name == known.name || name == known.with_unit();
  });
  return column == known_columns.end() ? nullptr : column;
}

KnownColumns assign_columns(const std::vector<std::string>& names, std::vector<std::vector<double>> values,
                            const std::string& location) {
  assert(names.size() == values.size());
  const auto fail = [&](const std::string& message) {
    throw UsageError(fmt::format("{}: {} (the columns are x y z vx vy vz r, m, and sx sy sz)", location, message));
  };
  std::array<bool, column_count> has{};
  KnownColumns columns;
  for (std::size_t k = 0; k < names.size(); ++k) {
    if (names[k] == id_column)
      continue;
    const TableColumn* const known = column_named(names[k]);
    if (known == nullptr)
      fail(fmt::format("unknown column '{}'; rename or remove it", names[k]));
    const auto column = static_cast<std::size_t>(known - known_columns.data());
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
  for (std::size_t column = 0; column < column_count; ++column)
    if (!has[column] && needed(column))
      fail(fmt::format("the column '{}' is missing; add it", known_columns[column].name));
  return columns;
}

void refuse_table(const std::string& file, const std::string& fault) {
  throw UsageError(fmt::format("{}: {}", file, fault));
}

void require_rows(std::size_t rows, const std::string& file) {
  if (rows == 0)
    refuse_table(file, "the table is empty (a start needs a particle); add a row for each");
}

ParticleTable table_of(const std::string& file, KnownColumns columns, std::vector<std::size_t> lines) {
  require_rows(columns[radius_column].size(), file);
  return {file,
          as_vectors(columns, 0),
          as_vectors(columns, first_velocity),
          std::move(columns[radius_column]),
          std::move(columns[mass_column]),
          std::move(lines),
          as_vectors(columns, first_spin)};
}

std::vector<std::size_t> columns_in(const ParticleTable& table) {
  std::vector<std::size_t> columns;
  for (std::size_t column = 0; column < column_count; ++column) {
    const bool is_velocity = column >= first_velocity && column < radius_column;
    if ((is_velocity && table.velocities.empty()) || (column == mass_column && table.masses.empty()) ||
        (column >= first_spin && table.spins.empty()))
      continue;
    columns.push_back(column);
  }
  return columns;
}

double value_in(const ParticleTable& table, std::size_t column, std::size_t particle) {
  const auto axis = [](std::size_t of) { return static_cast<Eigen::Index>(of); };
  if (column < first_velocity)
    return table.positions[particle][axis(column)];
  if (column < radius_column)
    return table.velocities[particle][axis(column - first_velocity)];
  if (column == radius_column)
    return table.radii[particle];
  if (column == mass_column)
    return table.masses[particle];
  return table.spins[particle][axis(column - first_spin)];
}

} // namespace keeler::io
