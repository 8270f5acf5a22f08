// Tables of particles as HDF5: an array per column in the root.
#include "sealed_file.hpp"
#include "stated_units.hpp"
#include "table_columns.hpp"
#include "table_files.hpp"

#include <keeler/core/error.hpp>
#include <keeler/core/interrupt.hpp>

#include <fmt/format.h>

#include <algorithm>

namespace keeler::io {

namespace {

// Root attributes: what the table says of the patch.
constexpr const char *root_box = "box_m", *root_offset = "shear_offset_m", *root_frequency = "Omega_rad_s",
                     *root_time = "time_orbits";

double root_number(const hdf5::Handle& root, const char* name) {
  return hdf5::has_attribute(root, name) ? hdf5::read_attribute<double>(root, name) : 0.0;
}

TableFrame read_frame(const hdf5::Handle& root, const std::string& file) {
  TableFrame frame{0.0, 0.0, root_number(root, root_offset), root_number(root, root_frequency),
                   root_number(root, root_time)};
  if (hdf5::has_attribute(root, root_box)) {
    const auto box = hdf5::read_attribute_values<double>(root, root_box);
    if (box.size() != 2)
      throw UsageError(fmt::format("{}: the attribute {} has {} numbers; give the two sides of the box, L_x and L_y",
                                   file, root_box, box.size()));
    frame.size_x = box[0];
    frame.size_y = box[1];
  }
  return frame;
}

} // namespace

ParticleTable read_hdf5_table(const hdf5::Handle& root, const std::string& file) {
  const std::vector<std::string> names = hdf5::names_in(root);
  assign_columns(names, std::vector<std::vector<double>>(names.size()), file); // checks names before reading arrays
  require_stated_units_of_groups(root, "the table");
  std::vector<std::vector<double>> values;
  for (const std::string& name : names) {
    const hdf5::Handle dataset = hdf5::open_dataset(root, name);
    const hdf5::Layout layout = hdf5::layout_of_dataset(dataset);
    if (!layout.is_numeric() || layout.shape.size() != 1)
      throw UsageError(fmt::format("{}: {} is not a one-dimensional array of numbers; write it as one", file, name));
    const TableColumn* const column = column_named(name);
    if (column != nullptr)
      require_stated_unit(dataset, name, column->unit_text());
    if (!values.empty() && values.front().size() != layout.count())
      throw UsageError(fmt::format("{}: {} has {} values, {} has {} (one per particle); make them equally long", file,
                                   name, layout.count(), names.front(), values.front().size()));
    values.emplace_back(layout.count());
    hdf5::read_dataset(dataset, hdf5::native_type<double>(), values.back().data());
    if (column != nullptr)
      require_none_missing(dataset, name, values.back());
  }
  ParticleTable table = table_of(file, assign_columns(names, std::move(values), file), {});
  table.frame = read_frame(root, file);
  return table;
}

void write_hdf5_table(const std::filesystem::path& file, const ParticleTable& table) {
  SealedFile out(file);
  out.write([&](const hdf5::Handle& root) {
    std::vector<std::uint64_t> ids(table.size());
    for (std::size_t k = 0; k < ids.size(); ++k)
      ids[k] = id_of(table, k);
    hdf5::write_dataset(root, id_column, ids);
    std::vector<double> values(table.size());
    for (const std::size_t column : columns_in(table)) {
      throw_if_interrupted();
      for (std::size_t k = 0; k < values.size(); ++k)
        values[k] = value_in(table, column, k);
      const TableColumn& about = table_columns()[column];
      const hdf5::Handle dataset = hdf5::write_dataset(root, about.with_unit(), values);
      hdf5::write_attribute(dataset, "unit", about.unit_text());
    }
    if (table.frame.has_box()) {
      hdf5::write_attribute(root, root_box, std::vector<double>{table.frame.size_x, table.frame.size_y});
      hdf5::write_attribute(root, root_offset, table.frame.shear_offset);
      hdf5::write_attribute(root, root_time, table.frame.time_orbits);
    }
    if (table.frame.orbital_frequency > 0.0)
      hdf5::write_attribute(root, root_frequency, table.frame.orbital_frequency);
  });
  out.finish();
}

} // namespace keeler::io
