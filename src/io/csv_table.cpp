// Tables of particles as CSV.
#include "table_columns.hpp"
#include "table_files.hpp"
#include "text_rows.hpp"

#include <keeler/core/error.hpp>
#include <keeler/files/columns.hpp>

#include <fmt/compile.h>
#include <fmt/format.h>

#include <iterator>

namespace keeler::io {

ParticleTable read_csv_table(std::string_view text, const std::string& file) {
  files::Columns columns = files::parse_columns(text, file);
  if (columns.names.empty())
    throw UsageError(fmt::format("{}: the table is empty (not even columns are named); begin with a line "
                                 "\"x,y,z,vx,vy,vz,r,m\"",
                                 file));
  const std::string header = fmt::format("{}:{}", file, columns.header_line);
  return table_of(file, assign_columns(columns.names, std::move(columns.values), header), std::move(columns.lines));
}

void write_csv_table(const std::filesystem::path& file, const ParticleTable& table) {
  const std::vector<std::size_t> columns = columns_in(table);
  std::string header = id_column;
  for (const std::size_t column : columns)
    header += "," + table_columns()[column].with_unit();
  write_rows(file, header + "\n", table.size(), [&](fmt::memory_buffer& row, std::size_t k) {
    fmt::format_to(std::back_inserter(row), FMT_COMPILE("{}"), id_of(table, k));
    for (const std::size_t column : columns)
      fmt::format_to(std::back_inserter(row), FMT_COMPILE(",{}"), value_in(table, column, k));
    row.push_back('\n');
  });
}

} // namespace keeler::io
