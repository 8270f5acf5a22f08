// Reads snapshots.
#include <keeler/io/snapshot.hpp>

#include "formats.hpp"
#include "provenance_attributes.hpp"
#include "sealed_file.hpp"
#include "snapshot_header.hpp"
#include "stated_units.hpp"

#include <keeler/core/error.hpp>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <optional>

namespace keeler::io {

namespace {

constexpr char not_sorted[] = "its ParticleIDs do not increase; sort the particles by them, each once";

// Checks the entries of /RingBox that are not read into the patch. The numbers of a patch are checked elsewhere.
void require_finite_times_and_bounds(const hdf5::Handle& group) {
  for (const char* name : {"time_s", "bounds_low", "bounds_high"})
    if (hdf5::has_attribute(group, name))
      for (const double value : hdf5::read_attribute_values<double>(group, name))
        if (!std::isfinite(value))
          throw IoError(fmt::format("its /RingBox has {} {:g}; correct or remove it", name, value));
}

void read_ring_box(const hdf5::Handle& image, Patch& patch) {
  const hdf5::Handle group = hdf5::open_group(image, "RingBox");
  require_finite_times_and_bounds(group);
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

void require_format(const hdf5::Handle& code) {
  if (hdf5::read_text_attribute(code, "format") != snapshot_format)
    throw IoError("it is not a Keeler snapshot");
  require_version(code, code, {snapshot_version, snapshot_version}, "");
}

// Throws IoError when groups are missing: files of GADGET have arrays of particles but no description of a ring.
void require_groups(const hdf5::Handle& image) {
  if (hdf5::has_attribute(image, "format") && hdf5::read_text_attribute(image, "format") == checkpoint_format)
    throw IoError(
        "it is not a Keeler snapshot but a checkpoint, of which \"keeler info\" and \"keeler convert\" tell; name "
        "a snapshot, snap_NNNNNN.hdf, or the folder of its run");
  const std::vector<std::string> names = hdf5::names_in(image);
  std::vector<std::string> missing;
  for (const char* group : {"Code", "RingBox", "Parameters", particles_group})
    if (std::find(names.begin(), names.end(), group) == names.end())
      missing.push_back(fmt::format("/{}", group));
  if (missing.empty())
    return;
  const auto has_particles = [](const std::string& name) { return name.starts_with("PartType"); };
  if (std::none_of(names.begin(), names.end(), has_particles))
    throw IoError("it is not a Keeler snapshot");
  throw IoError(fmt::format("it is not a Keeler snapshot but one of another program: it lacks {}. To start from its "
                            "particles, write their x, y, z, vx, vy, vz, r and m in SI units as a table (CSV, or HDF5 "
                            "with an array of each in the root) for keeler generate SCENE --from-table",
                            fmt::join(missing, ", ")));
}

void read_clumping(const hdf5::Handle& image, SnapshotMeta& meta) {
  if (!hdf5::exists(image, clumping_group))
    return;
  const hdf5::Handle group = hdf5::open_group(image, clumping_group);
  for (const std::string& name : hdf5::attribute_names(group))
    if (hdf5::layout_of_attribute(group, name).type == "float64") // another tool may have added others
      meta.clumping[name] = hdf5::read_attribute_values<double>(group, name);
}

// Part `index` of `parts` nearly equal parts of all rows.
struct Part {
  std::size_t index = 0, parts = 1;

  std::size_t begin(std::size_t rows) const { return rows * index / parts; }
  std::size_t end(std::size_t rows) const { return rows * (index + 1) / parts; }
};

// Reads a part of the rows of an array. Throws IoError unless its shape is `shape`.
template<class T, class Row>
std::vector<Row> read_array(const hdf5::Handle& group, const std::string& name, const std::string& unit,
                            const hdf5::Shape& shape, const Part& part) {
  const hdf5::Handle dataset = hdf5::open_dataset(group, name);
  require_stated_unit(dataset, name, unit);
  const hdf5::Shape found = hdf5::layout_of_dataset(dataset).shape;
  if (found != shape)
    throw IoError(fmt::format("{} has the shape [{}], not [{}]", name, fmt::join(found, ", "), fmt::join(shape, ", ")));
  const std::size_t first = part.begin(shape[0]);
  std::vector<Row> rows(part.end(shape[0]) - first);
  if (!rows.empty())
    hdf5::read_rows(dataset, hdf5::native_type<T>(), first, rows.size(), rows.data());
  if constexpr (std::is_same_v<T, double>)
    require_none_missing(dataset, name,
                         {reinterpret_cast<const double*>(rows.data()), rows.size() * sizeof(Row) / sizeof(double)});
  return rows;
}

void read_particles(const hdf5::Handle& image, const Part& part, Patch& patch) {
  const hdf5::Handle group = hdf5::open_group(image, particles_group);
  for (const char* name : {"Coordinates", "Velocities", "Masses", "ParticleIDs", "Radius"})
    if (!hdf5::exists(group, name))
      throw IoError(fmt::format("it lacks /{}/{} (docs/formats.md describes it); add it", particles_group, name));
  const hdf5::Handle ids = hdf5::open_dataset(group, "ParticleIDs");
  const hsize_t count = hdf5::layout_of_dataset(ids).count();
  require_stated_units_of_groups(image, "the file");
  require_header_fits(image, patch, count);
  require_whole_ids(ids, "ParticleIDs");
  patch.positions = read_array<double, Vec3>(group, "Coordinates", "m", {count, 3}, part);
  patch.velocities = read_array<double, Vec3>(group, "Velocities", "m/s", {count, 3}, part);
  patch.masses = read_array<double, double>(group, "Masses", "kg", {count}, part);
  patch.ids = read_array<std::uint64_t, std::uint64_t>(group, "ParticleIDs", "1", {count}, part);
  patch.radii = read_array<double, double>(group, "Radius", "m", {count}, part);
  if (hdf5::exists(group, "Spins"))
    patch.spins = read_array<double, Vec3>(group, "Spins", "rad/s", {count, 3}, part);
  for (std::vector<Vec3>* const rates : {&patch.velocities, &patch.spins})
    for (Vec3& rate : *rates)
      rate /= patch.orbital_frequency;
}

Snapshot snapshot_in(const hdf5::Handle& image, const Part& part = {}) {
  std::optional<hdf5::Handle> code;
  if (hdf5::exists(image, "Code"))
    require_format(code.emplace(hdf5::open_group(image, "Code")));
  require_groups(image);
  Snapshot snapshot;
  read_ring_box(image, snapshot.patch);
  read_particles(image, part, snapshot.patch);
  snapshot.meta.scene = hdf5::read_text_attribute(hdf5::open_group(image, "Parameters"), "scene");
  snapshot.meta.provenance = read_provenance(*code);
  snapshot.meta.provenance.erase("format");
  read_clumping(image, snapshot.meta);
  return snapshot;
}

void require_consistent(const Patch& patch) {
  const auto not_increasing = [](std::uint64_t a, std::uint64_t b) { return a >= b; };
  if (std::adjacent_find(patch.ids.begin(), patch.ids.end(), not_increasing) != patch.ids.end())
    throw IoError(not_sorted);
  if (!(patch.orbital_frequency > 0.0))
    throw IoError("its Omega is not a positive number");
}

// Returns make(), and adds the name of the file to its IoErrors.
template<class Make> auto naming(const std::filesystem::path& file, const Make& make) {
  try {
    return make();
  } catch (const IoError& error) {
    throw IoError(fmt::format("cannot read snapshot '{}': {}", file.string(), error.what()));
  }
}

Snapshot read_whole(const std::filesystem::path& file) {
  Snapshot snapshot =
      read_content(file, [&](const hdf5::Handle& image) { return naming(file, [&] { return snapshot_in(image); }); });
  naming(file, [&] { require_consistent(snapshot.patch); });
  return snapshot;
}

// True if the ids increase from each rank's part to the next. Collective.
bool increase_over_ranks(const std::vector<std::uint64_t>& ids, const Communicator& ranks) {
  std::vector<std::uint64_t> sizes(ranks.size()), firsts(ranks.size()), lasts(ranks.size());
  if (!ids.empty()) {
    sizes[ranks.rank()] = ids.size();
    firsts[ranks.rank()] = ids.front();
    lasts[ranks.rank()] = ids.back();
  }
  for (auto* const numbers : {&sizes, &firsts, &lasts})
    ranks.sum(std::span(*numbers));
  std::optional<std::uint64_t> last;
  for (std::size_t rank = 0; rank < ranks.size(); ++rank)
    if (sizes[rank] > 0) {
      if (last && *last >= firsts[rank])
        return false;
      last = lasts[rank];
    }
  return true;
}

// The root rank verifies the file; then each rank reads its part.
Snapshot read_part(const std::filesystem::path& file, const Communicator& ranks) {
  Snapshot snapshot;
  std::string seal;
  std::optional<hdf5::Handle> root;
  ranks.on_root([&] {
    root.emplace(open_sealed(file));
    seal = seal_in(file);
  });
  ranks.broadcast(seal);
  ranks.together([&] {
    if (!root)
      root.emplace(open_sealed(file, seal));
    naming(file, [&] {
      snapshot = snapshot_in(*root, {ranks.rank(), ranks.size()});
      require_consistent(snapshot.patch);
    });
  });
  const bool increase = increase_over_ranks(snapshot.patch.ids, ranks);
  ranks.together([&] {
    naming(file, [&] {
      if (!increase)
        throw IoError(not_sorted);
    });
  });
  return snapshot;
}

} // namespace

Snapshot read_snapshot(const std::filesystem::path& file, const Communicator& ranks) {
  if (!ranks.distributed())
    return read_whole(file);
  bool sealed = false;
  ranks.on_root([&] { sealed = has_seal(file); });
  if (ranks.broadcast(sealed))
    return read_part(file, ranks);
  Snapshot snapshot;
  ranks.on_root([&] { snapshot = read_whole(file); });
  return snapshot;
}

std::string snapshot_seal(const std::filesystem::path& file) {
  if (!has_seal(file))
    return {};
  const std::string seal = seal_in(file); // ends with blanks and a line break
  return seal.substr(0, seal.find_last_not_of(" \n") + 1);
}

} // namespace keeler::io
