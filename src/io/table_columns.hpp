// The columns of tables of particles: x y z vx vy vz r m sx sy sz, with or without units as suffixes.
#pragma once

#include <keeler/io/particle_table.hpp>

#include <array>
#include <string>
#include <vector>

namespace keeler::io {

struct TableColumn {
  const char* name;
  const char* unit; ///< optional suffix of the name

  std::string with_unit() const;
  /// Returns the unit as a text: "m/s" for vx.
  std::string unit_text() const;
};

inline constexpr std::size_t column_count = 11, first_velocity = 3, radius_column = 6, mass_column = 7, first_spin = 8;
inline constexpr const char* id_column = "id";

const std::array<TableColumn, column_count>& table_columns();

/// Returns the column of a name, with or without its unit; null for an id and any other name.
const TableColumn* column_named(const std::string& name);

/// Indexed as table_columns(); empty when the table lacks the column.
using KnownColumns = std::array<std::vector<double>, column_count>;

/// Assigns columns by name. Throws UsageError for unknown, duplicate or missing ones; `location` is that of the names.
KnownColumns assign_columns(const std::vector<std::string>& names, std::vector<std::vector<double>> values,
                            const std::string& location);

/// Makes a table. Throws UsageError when it has no row.
ParticleTable table_of(const std::string& file, KnownColumns columns, std::vector<std::size_t> lines);

/// Throws UsageError "FILE: FAULT".
[[noreturn]] void refuse_table(const std::string& file, const std::string& fault);

/// Throws UsageError when the table has no row.
void require_rows(std::size_t rows, const std::string& file);

/// Returns the indices of the columns that a table has.
std::vector<std::size_t> columns_in(const ParticleTable& table);
/// Returns the number of a particle in a column. Precondition: the table has it.
double value_in(const ParticleTable& table, std::size_t column, std::size_t particle);

/// Returns the id of particle k.
inline std::uint64_t id_of(const ParticleTable& table, std::size_t particle) {
  return table.ids.empty() ? particle : table.ids[particle];
}

} // namespace keeler::io
