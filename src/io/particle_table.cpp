#include <keeler/io/particle_table.hpp>

#include "child_process.hpp"
#include "table_files.hpp"

#include <keeler/core/error.hpp>
#include <keeler/files/files.hpp>
#include <keeler/files/input.hpp>
#include <keeler/files/writers.hpp>
#include <keeler/io/vtp.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cassert>

namespace keeler::io {

namespace {

constexpr std::array<TableFormat, 6> formats = {
    {{"csv", ".csv", "one row per particle, for spreadsheets, numpy and pandas", &write_csv_table},
     {"hdf5", ".h5", "one array per column, for h5py and MATLAB", &write_hdf5_table},
     {"npz", ".npz", "arrays for numpy.load", &write_npz_table},
     {"xyz", ".xyz", "extended XYZ, for OVITO and ASE", &write_xyz_table},
     {"vtp", ".vtp", "one point per particle, for ParaView", &write_vtp},
     {"gadget", ".hdf5", "HDF5 of GADGET's kind with units, for yt", &write_gadget_table}}};

std::vector<Vec3> in_si(std::vector<Vec3> rates, double orbital_frequency) {
  for (Vec3& rate : rates)
    rate *= orbital_frequency;
  return rates;
}

ParticleTable read_hdf5(std::span<const std::byte> bytes, const std::filesystem::path& file) {
  const std::string what = fmt::format("read '{}' as HDF5", file.string());
  if (files::is_being_written(file))
    throw IoError(fmt::format("cannot {}: {}", what, files::being_written));
  return read_after_trial(what, limits_for(bytes.size()), [&] {
    try {
      const hdf5::Handle root = hdf5::open_image(bytes);
      return has_gadget_groups(root) ? read_gadget_table(root, file.string()) : read_hdf5_table(root, file.string());
    } catch (const IoError& error) {
      throw IoError(fmt::format("cannot {}: {}", what, error.what()));
    }
  });
}

} // namespace

std::string ParticleTable::location_of(std::size_t particle) const {
  assert(lines.empty() || particle < lines.size());
  return lines.empty() ? fmt::format("{}, row {}", file, particle) : fmt::format("{}:{}", file, lines[particle]);
}

ParticleTable table_of(const Patch& patch) {
  assert(patch.orbital_frequency > 0.0);
  return {{},
          patch.positions,
          in_si(patch.velocities, patch.orbital_frequency),
          patch.radii,
          patch.masses,
          {},
          in_si(patch.spins, patch.orbital_frequency),
          patch.ids,
          {patch.box.size_x, patch.box.size_y, patch.offset, patch.orbital_frequency, patch.time_orbits}};
}

ParticleTable read_particle_table(const std::filesystem::path& file) {
  const std::vector<std::byte> bytes = files::read_file(file);
  constexpr std::string_view hdf5_signature = "\x89HDF\r\n\x1a\n";
  const std::string_view content(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  if (content.starts_with(hdf5_signature))
    return read_hdf5(bytes, file);
  if (is_npz(content))
    return read_npz_table(content, file.string());
  if (is_xyz(content))
    return read_xyz_table(content, file.string());
  if (files::without_byte_order_mark(content).starts_with("<?xml"))
    throw UsageError(fmt::format("{}: it is XML (VTK's?), which Keeler does not read; give the table as CSV, HDF5, npz "
                                 "or extended XYZ",
                                 file.string()));
  return read_csv_table(content, file.string());
}

std::span<const TableFormat> table_formats() {
  return formats;
}

const TableFormat& table_format(const std::string& name) {
  const auto* const format =
      std::find_if(formats.begin(), formats.end(), [&](const TableFormat& known) { return name == known.name; });
  assert(format != formats.end());
  return *format;
}

} // namespace keeler::io
