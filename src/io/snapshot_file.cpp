// Writes snapshots.
#include <keeler/io/snapshot.hpp>

#include "formats.hpp"
#include "provenance_attributes.hpp"
#include "sealed_file.hpp"

#include <keeler/core/units.hpp>

#include <algorithm>
#include <cassert>
#include <optional>

namespace keeler::io {
namespace {

static_assert(sizeof(Vec3) == 3 * sizeof(double), "arrays of vectors are written as (N, 3) doubles");

void write_header(const hdf5::Handle& root, const Patch& frame, std::size_t particles) {
  const auto count = static_cast<std::uint32_t>(particles);
  const std::vector<std::uint32_t> counts{0, count, 0, 0, 0, 0};
  const hdf5::Handle header = hdf5::create_group(root, "Header");
  hdf5::write_attribute(header, "NumPart_ThisFile", counts);
  hdf5::write_attribute(header, "NumPart_Total", counts);
  hdf5::write_attribute(header, "NumPart_Total_HighWord", std::vector<std::uint32_t>(6, 0));
  hdf5::write_attribute(header, "MassTable", std::vector<double>(6, 0.0)); // 0: masses are in /PartType1/Masses
  hdf5::write_attribute(header, "NumFilesPerSnapshot", std::int32_t{1});
  hdf5::write_attribute(header, "Time", frame.time_orbits * two_pi / frame.orbital_frequency);
  hdf5::write_attribute(header, "BoxSize", std::max(frame.box.size_x, frame.box.size_y)); // yt takes a scalar only
  hdf5::write_attribute(header, "UnitLength_in_cm", 100.0);
  hdf5::write_attribute(header, "UnitMass_in_g", 1000.0);
  hdf5::write_attribute(header, "UnitVelocity_in_cm_per_s", 100.0);
}

// The arrays of /PartType1, in SI.
class ParticleArrays {
public:
  ParticleArrays(const hdf5::Handle& root, std::size_t count, bool rough) {
    const hdf5::Handle group = hdf5::create_group(root, particles_group);
    const hdf5::Shape vectors{count, 3}, numbers{count};
    create(group, "Coordinates", FieldType::float64, vectors, "m",
           "x radial outward, y along the orbit, z up; the centre of the cell is 0");
    create(group, "Velocities", FieldType::float64, vectors, "m/s", "in the rotating frame, the shear included");
    create(group, "Masses", FieldType::float64, numbers, "kg", "mass");
    create(group, "ParticleIDs", FieldType::uint64, numbers, "1", "identity, kept for ever");
    create(group, "Radius", FieldType::float64, numbers, "m", "radius of the sphere");
    if (rough)
      create(group, "Spins", FieldType::float64, vectors, "rad/s",
             "angular velocity against the stars, along x, y and z");
  }

  // Writes particles [first, first + count) of the patch to the rows from `row` on.
  void write(std::size_t row, const Patch& patch, std::size_t first, std::size_t count) const {
    assert(first + count <= patch.size() && (arrays_.size() > 5) == !patch.spins.empty());
    const auto in_si = [&](const std::vector<Vec3>& rates) {
      std::vector<Vec3> some(count);
      for (std::size_t k = 0; k < count; ++k)
        some[k] = rates[first + k] * patch.orbital_frequency;
      return some;
    };
    const auto put = [&](std::size_t array, const void* data) {
      hdf5::write_rows(arrays_[array].dataset, arrays_[array].type, row, count, data);
    };
    put(0, patch.positions.data() + first);
    put(1, in_si(patch.velocities).data());
    put(2, patch.masses.data() + first);
    put(3, patch.ids.data() + first);
    put(4, patch.radii.data() + first);
    if (arrays_.size() > 5)
      put(5, in_si(patch.spins).data());
  }

private:
  struct Array {
    hid_t type;
    hdf5::Handle dataset;
  };

  void create(const hdf5::Handle& group, const std::string& name, FieldType field, const hdf5::Shape& shape,
              std::string_view unit, std::string_view about) {
    const hid_t type = hdf5::native_type(field);
    arrays_.push_back({type, hdf5::create_dataset(group, name, type, shape, hdf5::Packing::compressed)});
    hdf5::write_attribute(arrays_.back().dataset, "unit", unit);
    hdf5::write_attribute(arrays_.back().dataset, "about", about);
  }

  std::vector<Array> arrays_;
};

// Writes the array number(0), …, number(count − 1).
template<class T, class Number>
void write_numbers(const hdf5::Handle& group, const std::string& name, std::size_t count, const Number& number) {
  const hid_t type = hdf5::native_type<T>();
  const hdf5::Handle dataset = hdf5::create_dataset(group, name, type, {count}, hdf5::Packing::compressed);
  std::vector<T> some(std::min(count, hdf5::chunk_rows));
  for (std::size_t first = 0; first < count; first += some.size()) {
    some.resize(std::min(some.size(), count - first));
    for (std::size_t k = 0; k < some.size(); ++k)
      some[k] = number(first + k);
    hdf5::write_rows(dataset, type, first, some.size(), some.data());
  }
}

// Writes one vertex cell per particle for ParaView's VTKHDF reader; points and their data are hard links to the arrays
// of /PartType1.
void write_vtk_view(const hdf5::Handle& root, std::size_t count) {
  constexpr std::uint8_t vertex = 1; // VTK_VERTEX
  const auto identity = [](std::size_t k) { return static_cast<std::int64_t>(k); };
  const hdf5::Handle group = hdf5::create_group(root, "VTKHDF");
  hdf5::write_attribute(group, "Version", std::vector<std::int64_t>{1, 0});
  hdf5::write_attribute(group, "Type", std::string_view("UnstructuredGrid"));
  for (const char* name : {"NumberOfPoints", "NumberOfCells", "NumberOfConnectivityIds"})
    hdf5::write_dataset(group, name, std::vector<std::int64_t>{identity(count)});
  write_numbers<std::int64_t>(group, "Offsets", count + 1, identity);
  write_numbers<std::int64_t>(group, "Connectivity", count, identity);
  write_numbers<std::uint8_t>(group, "Types", count, [](std::size_t) { return vertex; });

  const hdf5::Handle particles = hdf5::open_group(root, particles_group);
  hdf5::create_hard_link(particles, "Coordinates", group, "Points");
  const hdf5::Handle point_data = hdf5::create_group(group, "PointData");
  for (const char* name : {"Velocities", "Masses", "ParticleIDs", "Radius", "Spins"})
    if (hdf5::exists(particles, name))
      hdf5::create_hard_link(particles, name, point_data, name);
}

// Returns a patch without its particles.
Patch frame_of(const Patch& patch) {
  Patch frame;
  frame.box = patch.box;
  frame.offset = patch.offset;
  frame.frequencies = patch.frequencies;
  frame.orbital_frequency = patch.orbital_frequency;
  frame.time_orbits = patch.time_orbits;
  return frame;
}

// The bounding box of the cell and of all spheres, some of which may lie outside the cell by their eccentricity.
struct Bounds {
  explicit Bounds(const ShearingBox& box) : low(-0.5 * box.size_x, -0.5 * box.size_y, 0.0), high(-low) {}

  void add(const Vec3& position, double radius) {
    low = low.cwiseMin(position - Vec3::Constant(radius));
    high = high.cwiseMax(position + Vec3::Constant(radius));
  }

  Vec3 low, high;
};

void write_ring_box(const hdf5::Handle& root, const Patch& frame, const Bounds& bounds) {
  const hdf5::Handle group = hdf5::create_group(root, "RingBox");
  hdf5::write_attribute(group, "L_x", frame.box.size_x);
  hdf5::write_attribute(group, "L_y", frame.box.size_y);
  hdf5::write_attribute(group, "Omega", frame.orbital_frequency);
  hdf5::write_attribute(group, "kappa_over_Omega", frame.frequencies.kappa);
  hdf5::write_attribute(group, "nu_over_Omega", frame.frequencies.nu);
  hdf5::write_attribute(group, "shear_over_Omega", frame.box.shear);
  hdf5::write_attribute(group, "shear_offset", frame.offset);
  hdf5::write_attribute(group, "shear_offset_at_start", frame.box.first_offset);
  hdf5::write_attribute(group, "time_orbits", frame.time_orbits);
  hdf5::write_attribute(group, "time_s", frame.time_orbits * two_pi / frame.orbital_frequency);
  hdf5::write_attribute(group, "bounds_low", std::vector<double>(bounds.low.data(), bounds.low.data() + 3));
  hdf5::write_attribute(group, "bounds_high", std::vector<double>(bounds.high.data(), bounds.high.data() + 3));
  hdf5::write_attribute(group, "units", std::string_view(ring_box_units));
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

} // namespace

struct SnapshotFile::Parts {
  Parts(const std::filesystem::path& file, const Patch& whole, std::size_t particles, const SnapshotMeta& its_meta)
      : out(file), frame(frame_of(whole)), count(particles), meta(its_meta), bounds(whole.box) {}

  SealedFile out;
  Patch frame; // without particles
  std::size_t count, written = 0;
  SnapshotMeta meta;
  Bounds bounds;
  std::optional<ParticleArrays> arrays;
};

SnapshotFile::SnapshotFile(const std::filesystem::path& file, const Patch& frame, std::size_t count, bool rough,
                           const SnapshotMeta& meta)
    : parts_(std::make_unique<Parts>(file, frame, count, meta)) {
  assert(frame.orbital_frequency > 0.0);
  parts_->out.write([&](const hdf5::Handle& root) {
    write_header(root, frame, count);
    parts_->arrays.emplace(root, count, rough);
  });
}

SnapshotFile::~SnapshotFile() = default;

void SnapshotFile::add(const Patch& patch, std::size_t first, std::size_t count) {
  assert(parts_->written % piece == 0 && parts_->written + count <= parts_->count);
  parts_->out.write([&](const hdf5::Handle&) { parts_->arrays->write(parts_->written, patch, first, count); });
  for (std::size_t k = first; k < first + count; ++k)
    parts_->bounds.add(patch.positions[k], patch.radii[k]);
  parts_->written += count;
}

void SnapshotFile::finish() {
  assert(parts_->written == parts_->count);
  parts_->out.write([&](const hdf5::Handle& root) {
    parts_->arrays.reset();
    write_vtk_view(root, parts_->count);
    write_ring_box(root, parts_->frame, parts_->bounds);
    hdf5::write_attribute(hdf5::create_group(root, "Parameters"), "scene", parts_->meta.scene);
    const hdf5::Handle code = hdf5::create_group(root, "Code");
    write_provenance(code, parts_->meta.provenance);
    hdf5::write_attribute(code, "format", std::string_view(snapshot_format));
    hdf5::write_attribute(code, "format_version", snapshot_version);
    write_clumping(root, parts_->meta);
  });
  parts_->out.finish();
}

void write_snapshot(const std::filesystem::path& file, const Patch& patch, const SnapshotMeta& meta) {
  SnapshotFile snapshot(file, patch, patch.size(), !patch.spins.empty(), meta);
  for (std::size_t first = 0; first < patch.size(); first += SnapshotFile::piece)
    snapshot.add(patch, first, std::min(SnapshotFile::piece, patch.size() - first));
  snapshot.finish();
}

} // namespace keeler::io
