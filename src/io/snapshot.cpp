#include <keeler/io/snapshot.hpp>

#include "formats.hpp"
#include "provenance_attributes.hpp"
#include "sealed_file.hpp"

#include <keeler/core/error.hpp>
#include <keeler/core/units.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <concepts>

namespace keeler {

template<class Parcel, class T>
requires std::same_as<std::remove_const_t<T>, Snapshot>
void pass(Parcel& parcel, T& snapshot) {
  auto& patch = snapshot.patch;
  parcel(patch.positions, patch.velocities, patch.radii, patch.masses, patch.ids, patch.spins);
  parcel(patch.box.size_x, patch.box.size_y, patch.box.shear, patch.box.first_offset, patch.offset);
  parcel(patch.frequencies.kappa, patch.frequencies.nu, patch.orbital_frequency, patch.time_orbits);
  parcel(snapshot.meta.scene, snapshot.meta.provenance, snapshot.meta.clumping);
}

namespace {

static_assert(sizeof(Vec3) == 3 * sizeof(double), "arrays of vectors are written as (N, 3) doubles");

// What GADGET calls its particles of type 1 (all arrays of six have one entry a type).
constexpr char particles_group[] = "PartType1";

void write_header(const hdf5::Handle& image, const Patch& patch) {
  const auto count = static_cast<std::uint32_t>(patch.size());
  const std::vector<std::uint32_t> counts{0, count, 0, 0, 0, 0};
  const hdf5::Handle header = hdf5::create_group(image, "Header");
  hdf5::write_attribute(header, "NumPart_ThisFile", counts);
  hdf5::write_attribute(header, "NumPart_Total", counts);
  hdf5::write_attribute(header, "NumPart_Total_HighWord", std::vector<std::uint32_t>(6, 0));
  hdf5::write_attribute(header, "MassTable", std::vector<double>(6, 0.0)); // masses are listed one by one
  hdf5::write_attribute(header, "NumFilesPerSnapshot", std::int32_t{1});
  hdf5::write_attribute(header, "Time", patch.time_orbits * two_pi / patch.orbital_frequency);
  hdf5::write_attribute(header, "BoxSize", std::max(patch.box.size_x, patch.box.size_y)); // yt takes a scalar only
  hdf5::write_attribute(header, "UnitLength_in_cm", 100.0);
  hdf5::write_attribute(header, "UnitMass_in_g", 1000.0);
  hdf5::write_attribute(header, "UnitVelocity_in_cm_per_s", 100.0);
}

void write_array(const hdf5::Handle& group, const std::string& name, FieldType type, const hdf5::Shape& shape,
                 const void* data, std::string_view unit, std::string_view about) {
  const hdf5::Handle dataset =
      hdf5::write_dataset(group, name, hdf5::native_type(type), shape, data, hdf5::Packing::compressed);
  hdf5::write_attribute(dataset, "unit", unit);
  hdf5::write_attribute(dataset, "about", about);
}

void write_particles(const hdf5::Handle& image, const Patch& patch) {
  std::vector<Vec3> velocities = patch.velocities;
  for (Vec3& velocity : velocities)
    velocity *= patch.orbital_frequency;

  const hdf5::Handle group = hdf5::create_group(image, particles_group);
  const hsize_t count = patch.size();
  write_array(group, "Coordinates", FieldType::float64, {count, 3}, patch.positions.data(), "m",
              "x radial outward, y along the orbit, z up; the centre of the cell is 0");
  write_array(group, "Velocities", FieldType::float64, {count, 3}, velocities.data(), "m/s",
              "in the rotating frame, the shear included");
  write_array(group, "Masses", FieldType::float64, {count}, patch.masses.data(), "kg", "mass");
  write_array(group, "ParticleIDs", FieldType::uint64, {count}, patch.ids.data(), "1", "identity, kept for ever");
  write_array(group, "Radius", FieldType::float64, {count}, patch.radii.data(), "m", "radius of the sphere");
  if (patch.spins.empty())
    return;
  std::vector<Vec3> spins = patch.spins;
  for (Vec3& spin : spins)
    spin *= patch.orbital_frequency;
  write_array(group, "Spins", FieldType::float64, {count, 3}, spins.data(), "rad/s",
              "angular velocity against the stars, along x, y and z");
}

// One vertex cell a particle, as ParaView's VTKHDF reader wants it; points and their data are the arrays of
// /PartType1 under a second name.
void write_vtk_view(const hdf5::Handle& image, std::size_t particle_count) {
  const auto count = static_cast<std::int64_t>(particle_count);
  constexpr std::uint8_t vertex = 1; // VTK_VERTEX
  std::vector<std::int64_t> numbers(particle_count + 1);
  for (std::size_t k = 0; k < numbers.size(); ++k)
    numbers[k] = static_cast<std::int64_t>(k);

  const hdf5::Handle group = hdf5::create_group(image, "VTKHDF");
  hdf5::write_attribute(group, "Version", std::vector<std::int64_t>{1, 0});
  hdf5::write_attribute(group, "Type", std::string_view("UnstructuredGrid"));
  for (const char* name : {"NumberOfPoints", "NumberOfCells", "NumberOfConnectivityIds"})
    hdf5::write_dataset(group, name, std::vector<std::int64_t>{count});
  hdf5::write_dataset(group, "Offsets", numbers, hdf5::Packing::compressed);
  numbers.pop_back();
  hdf5::write_dataset(group, "Connectivity", numbers, hdf5::Packing::compressed);
  hdf5::write_dataset(group, "Types", std::vector<std::uint8_t>(particle_count, vertex), hdf5::Packing::compressed);

  const hdf5::Handle particles = hdf5::open_group(image, particles_group);
  hdf5::link_again(particles, "Coordinates", group, "Points");
  const hdf5::Handle point_data = hdf5::create_group(group, "PointData");
  for (const char* name : {"Velocities", "Masses", "ParticleIDs", "Radius", "Spins"})
    if (hdf5::exists(particles, name))
      hdf5::link_again(particles, name, point_data, name);
}

// The smallest box that holds the cell and every particle: eccentric ones stand outside the cell.
void write_bounds(const hdf5::Handle& group, const Patch& patch) {
  Vec3 low(-0.5 * patch.box.size_x, -0.5 * patch.box.size_y, 0.0), high = -low;
  for (std::size_t k = 0; k < patch.size(); ++k) {
    low = low.cwiseMin(patch.positions[k] - Vec3::Constant(patch.radii[k]));
    high = high.cwiseMax(patch.positions[k] + Vec3::Constant(patch.radii[k]));
  }
  hdf5::write_attribute(group, "bounds_low", std::vector<double>(low.data(), low.data() + 3));
  hdf5::write_attribute(group, "bounds_high", std::vector<double>(high.data(), high.data() + 3));
}

void write_ring_box(const hdf5::Handle& image, const Patch& patch) {
  const hdf5::Handle group = hdf5::create_group(image, "RingBox");
  hdf5::write_attribute(group, "L_x", patch.box.size_x);
  hdf5::write_attribute(group, "L_y", patch.box.size_y);
  hdf5::write_attribute(group, "Omega", patch.orbital_frequency);
  hdf5::write_attribute(group, "kappa_over_Omega", patch.frequencies.kappa);
  hdf5::write_attribute(group, "nu_over_Omega", patch.frequencies.nu);
  hdf5::write_attribute(group, "shear_over_Omega", patch.box.shear);
  hdf5::write_attribute(group, "shear_offset", patch.offset);
  hdf5::write_attribute(group, "shear_offset_at_start", patch.box.first_offset);
  hdf5::write_attribute(group, "time_orbits", patch.time_orbits);
  hdf5::write_attribute(group, "time_s", patch.time_orbits * two_pi / patch.orbital_frequency);
  write_bounds(group, patch);
  hdf5::write_attribute(group, "units",
                        std::string_view("lengths m; Omega rad/s; time_orbits orbits; time_s s; ratios 1"));
}

void read_ring_box(const hdf5::Handle& image, Patch& patch) {
  const hdf5::Handle group = hdf5::open_group(image, "RingBox");
  const auto number = [&](const char* name) { return hdf5::read_attribute<double>(group, name); };
  patch.box.size_x = number("L_x");
  patch.box.size_y = number("L_y");
  patch.orbital_frequency = number("Omega");
  patch.frequencies.kappa = number("kappa_over_Omega");
  patch.frequencies.nu = number("nu_over_Omega");
  patch.box.shear = number("shear_over_Omega");
  patch.offset = number("shear_offset");
  patch.box.first_offset = number("shear_offset_at_start");
  patch.time_orbits = number("time_orbits");
}

void check_format(const hdf5::Handle& code) {
  if (hdf5::read_text_attribute(code, "format") != snapshot_format)
    throw IoError("it is not a Keeler snapshot");
  require_version(code, code, {snapshot_version, snapshot_version}, "");
}

void write_clumping(const hdf5::Handle& image, const SnapshotMeta& meta) {
  if (meta.clumping.empty())
    return;
  const hdf5::Handle group = hdf5::create_group(image, clumping_group);
  for (const auto& [name, numbers] : meta.clumping)
    if (numbers.size() == 1)
      hdf5::write_attribute(group, name, numbers.front());
    else
      hdf5::write_attribute(group, name, numbers);
}

void read_clumping(const hdf5::Handle& image, SnapshotMeta& meta) {
  if (!hdf5::exists(image, clumping_group))
    return;
  const hdf5::Handle group = hdf5::open_group(image, clumping_group);
  for (const std::string& name : hdf5::attribute_names(group))
    if (hdf5::layout_of_attribute(group, name).type == "float64") // not what another tool has noted there
      meta.clumping[name] = hdf5::read_attribute_values<double>(group, name);
}

// An array of rows whose shape must be `shape`.
template<class T, class Row>
std::vector<Row> read_array(const hdf5::Handle& group, const std::string& name, const hdf5::Shape& shape) {
  const hdf5::Handle dataset = hdf5::open_dataset(group, name);
  const hdf5::Shape found = hdf5::layout_of_dataset(dataset).shape;
  if (found != shape)
    throw IoError(fmt::format("{} has the shape [{}], not [{}]", name, fmt::join(found, ", "), fmt::join(shape, ", ")));
  std::vector<Row> rows(shape[0]);
  hdf5::read_dataset(dataset, hdf5::native_type<T>(), rows.data());
  return rows;
}

void read_particles(const hdf5::Handle& image, Patch& patch) {
  const hdf5::Handle group = hdf5::open_group(image, particles_group);
  const hsize_t count = hdf5::layout_of_dataset(hdf5::open_dataset(group, "ParticleIDs")).count();
  patch.positions = read_array<double, Vec3>(group, "Coordinates", {count, 3});
  patch.velocities = read_array<double, Vec3>(group, "Velocities", {count, 3});
  patch.masses = read_array<double, double>(group, "Masses", {count});
  patch.ids = read_array<std::uint64_t, std::uint64_t>(group, "ParticleIDs", {count});
  patch.radii = read_array<double, double>(group, "Radius", {count});
  if (hdf5::exists(group, "Spins"))
    patch.spins = read_array<double, Vec3>(group, "Spins", {count, 3});
  for (std::vector<Vec3>* const rates : {&patch.velocities, &patch.spins})
    for (Vec3& rate : *rates)
      rate /= patch.orbital_frequency;
}

Snapshot snapshot_in(const hdf5::Handle& image) {
  if (!hdf5::exists(image, "Code"))
    throw IoError("it is not a Keeler snapshot");
  const hdf5::Handle code = hdf5::open_group(image, "Code");
  check_format(code);
  Snapshot snapshot;
  read_ring_box(image, snapshot.patch);
  read_particles(image, snapshot.patch);
  snapshot.meta.scene = hdf5::read_text_attribute(hdf5::open_group(image, "Parameters"), "scene");
  snapshot.meta.provenance = read_provenance(code);
  snapshot.meta.provenance.erase("format");
  read_clumping(image, snapshot.meta);
  return snapshot;
}

// Also of what a child process sent.
void require_consistent(const Patch& patch) {
  for (const std::size_t size : {patch.velocities.size(), patch.masses.size(), patch.ids.size(), patch.radii.size(),
                                 patch.spins.empty() ? patch.size() : patch.spins.size()})
    if (size != patch.size())
      throw IoError("its arrays have different lengths");
  const auto not_increasing = [](std::uint64_t a, std::uint64_t b) { return a >= b; };
  if (std::adjacent_find(patch.ids.begin(), patch.ids.end(), not_increasing) != patch.ids.end())
    throw IoError("its ParticleIDs do not increase; sort the particles by them, each once");
  if (!(patch.orbital_frequency > 0.0))
    throw IoError("its Omega is not a positive number");
}

} // namespace

void write_snapshot(const std::filesystem::path& file, const Patch& patch, const SnapshotMeta& meta) {
  assert(patch.orbital_frequency > 0.0);
  SealedFile out(file);
  out.write([&](const hdf5::Handle& image) {
    write_header(image, patch);
    write_particles(image, patch);
    write_vtk_view(image, patch.size());
    write_ring_box(image, patch);
    hdf5::write_attribute(hdf5::create_group(image, "Parameters"), "scene", meta.scene);
    const hdf5::Handle code = hdf5::create_group(image, "Code");
    write_provenance(code, meta.provenance);
    hdf5::write_attribute(code, "format", std::string_view(snapshot_format));
    hdf5::write_attribute(code, "format_version", snapshot_version);
    write_clumping(image, meta);
  });
  out.finish();
}

Snapshot read_snapshot(const std::filesystem::path& file) {
  const auto naming = [&](const auto& make) {
    try {
      return make();
    } catch (const IoError& error) {
      throw IoError(fmt::format("cannot read snapshot '{}': {}", file.string(), error.what()));
    }
  };
  Snapshot snapshot = read_content<Snapshot>(
      file, [&](const hdf5::Handle& image) { return naming([&] { return snapshot_in(image); }); });
  naming([&] { require_consistent(snapshot.patch); });
  return snapshot;
}

} // namespace keeler
