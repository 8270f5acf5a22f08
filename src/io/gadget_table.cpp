// Tables of particles as HDF5 of GADGET's kind: /Header, /Units, /PartTypeN. Places are in [0, BoxSize].
#include "formats.hpp"
#include "sealed_file.hpp"
#include "table_columns.hpp"
#include "table_files.hpp"

#include <keeler/core/error.hpp>
#include <keeler/core/interrupt.hpp>
#include <keeler/core/units.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

namespace keeler::io {

namespace {

constexpr std::size_t type_count = 6; // of particles, in /Header

// Attributes beyond GADGET's, so that a file of Keeler reads back whole.
constexpr const char *sides_name = "BoxSizes", *offset_name = "ShearOffset", *frequency_name = "Omega";

// Returns a number that one of these groups states, also as a text (SWIFT writes its parameters so).
std::optional<double> stated(const hdf5::Handle& root, std::initializer_list<const char*> groups,
                             const std::string& name) {
  for (const char* group_name : groups) {
    if (!hdf5::exists(root, group_name))
      continue;
    const hdf5::Handle group = hdf5::open_group(root, group_name);
    if (!hdf5::has_attribute(group, name))
      continue;
    const hdf5::Layout layout = hdf5::layout_of_attribute(group, name);
    if (layout.type != "text")
      return hdf5::read_attribute<double>(group, name);
    try {
      return std::stod(hdf5::read_text_attribute(group, name));
    } catch (const std::logic_error&) {
      throw IoError(fmt::format("the attribute {} of /{} is no number; correct or remove it", name, group_name));
    }
  }
  return std::nullopt;
}

struct Units {
  double length = 1.0, mass = 1.0, velocity = 1.0; ///< in SI
};

Units units_of(const hdf5::Handle& root, const std::string& file) {
  const auto gadget = [&](const char* name) { return stated(root, {"Units", "Parameters", "Header"}, name); };
  const auto swift = [&](const char* name) { return stated(root, {"Units"}, name); };
  Units units;
  const auto length = swift("Unit length in cgs (U_L)"), mass = swift("Unit mass in cgs (U_M)"),
             time = swift("Unit time in cgs (U_t)");
  if (length && mass && time) {
    units = {*length / 100.0, *mass / 1000.0, *length / 100.0 / *time};
  } else {
    const auto length_cm = gadget("UnitLength_in_cm"), mass_g = gadget("UnitMass_in_g"),
               velocity = gadget("UnitVelocity_in_cm_per_s");
    if (!length_cm || !mass_g || !velocity)
      refuse_table(file,
                   "it states no units; add UnitLength_in_cm, UnitMass_in_g and UnitVelocity_in_cm_per_s as attributes "
                   "of /Header (100, 1000 and 100 for SI)");
    units = {*length_cm / 100.0, *mass_g / 1000.0, *velocity / 100.0};
  }
  for (const double unit : {units.length, units.mass, units.velocity})
    if (!std::isfinite(unit) || unit <= 0.0)
      refuse_table(file, fmt::format("it states a unit of {:g} SI; correct its attributes", unit));
  return units;
}

void require_not_comoving(const hdf5::Handle& root, const std::string& file) {
  for (const auto& [name, usual] : {std::pair("HubbleParam", 1.0), std::pair("ComovingIntegrationOn", 0.0),
                                    std::pair("Cosmological run", 0.0), std::pair("Redshift", 0.0)}) {
    const auto value = stated(root, {"Header", "Parameters", "Cosmology"}, name);
    if (value && *value != usual && *value != 0.0)
      refuse_table(file,
                   fmt::format("its {} is {:g}: a cosmological run, whose units Keeler does not convert; write the "
                               "particles in SI",
                               name, *value));
  }
}

// Returns the only type that has particles.
std::string group_with_particles(const hdf5::Handle& root, const std::string& file) {
  std::vector<std::string> found;
  for (std::size_t type = 0; type < 2 * type_count; ++type) { // SWIFT has seven
    const std::string name = fmt::format("PartType{}", type);
    if (hdf5::exists(root, name) && hdf5::exists(hdf5::open_group(root, name), "Coordinates"))
      found.push_back(name);
  }
  if (found.size() != 1)
    refuse_table(file,
                 fmt::format("{} groups PartTypeN have Coordinates, and a table has one; leave one", found.size()));
  return found.front();
}

// Reads the arrays of one group: (N, 3) or (N) numbers.
class Arrays {
public:
  Arrays(const hdf5::Handle& root, const std::string& file)
      : file_(file), name_(group_with_particles(root, file)), group_(hdf5::open_group(root, name_)) {
    count_ = length_of("Coordinates");
    require_rows(count_, file_);
  }

  bool has(const char* array) const { return hdf5::exists(group_, array); }
  std::size_t count() const { return count_; }
  char type() const { return name_.back(); }

  std::vector<double> numbers(const char* array, double unit) const {
    std::vector<double> values(count_);
    read(array, {count_}, values.data());
    for (double& value : values)
      value *= unit;
    return values;
  }

  std::vector<Vec3> vectors(const char* array, double unit) const {
    static_assert(sizeof(Vec3) == 3 * sizeof(double));
    std::vector<Vec3> values(count_);
    read(array, {count_, 3}, values.data());
    for (Vec3& value : values)
      value *= unit;
    return values;
  }

private:
  std::size_t length_of(const char* array) const {
    const hdf5::Layout layout = hdf5::layout_of_dataset(hdf5::open_dataset(group_, array));
    return layout.shape.empty() ? 0 : layout.shape.front();
  }

  void read(const char* array, const hdf5::Shape& shape, void* into) const {
    const hdf5::Handle dataset = hdf5::open_dataset(group_, array);
    const hdf5::Layout layout = hdf5::layout_of_dataset(dataset);
    if (!layout.is_numeric() || layout.shape != shape)
      refuse_table(file_, fmt::format("/{}/{} is no array of {} x {} numbers; write it as one", name_, array,
                                      shape.front(), shape.size() == 2 ? 3 : 1));
    hdf5::read_dataset(dataset, hdf5::native_type<double>(), into);
  }

  std::string file_, name_;
  hdf5::Handle group_;
  std::size_t count_ = 0;
};

// Returns the masses: an array, or one for all in MassTable; none if neither is there.
std::vector<double> masses_of(const hdf5::Handle& root, const Arrays& arrays, double unit) {
  if (arrays.has("Masses"))
    return arrays.numbers("Masses", unit);
  const hdf5::Handle header = hdf5::open_group(root, "Header");
  if (!hdf5::has_attribute(header, "MassTable"))
    return {};
  const auto table = hdf5::read_attribute_values<double>(header, "MassTable");
  const auto type = static_cast<std::size_t>(arrays.type() - '0');
  return type < table.size() && table[type] > 0.0 ? std::vector<double>(arrays.count(), table[type] * unit)
                                                  : std::vector<double>{};
}

// Returns half of the sides of the box, in the file's units: where the centre is.
Vec3 centre_of(const hdf5::Handle& header, const std::string& file) {
  if (!hdf5::has_attribute(header, "BoxSize"))
    refuse_table(file, "its /Header has no BoxSize, so the centre is not known; add it");
  const auto sides = hdf5::read_attribute_values<double>(header, "BoxSize");
  if (sides.size() != 1 && sides.size() != 3)
    refuse_table(file, fmt::format("its BoxSize has {} numbers; give one, or three", sides.size()));
  return 0.5 * (sides.size() == 1 ? Vec3::Constant(sides[0]) : Vec3(sides[0], sides[1], sides[2]));
}

void write_header(const hdf5::Handle& root, const ParticleTable& table, double side) {
  const auto count = static_cast<std::uint32_t>(table.size());
  const std::vector<std::uint32_t> counts{0, count, 0, 0, 0, 0};
  const hdf5::Handle header = hdf5::create_group(root, "Header");
  hdf5::write_attribute(header, "NumPart_ThisFile", counts);
  hdf5::write_attribute(header, "NumPart_Total", counts);
  hdf5::write_attribute(header, "NumPart_Total_HighWord", std::vector<std::uint32_t>(type_count, 0));
  hdf5::write_attribute(header, "MassTable", std::vector<double>(type_count, 0.0));
  hdf5::write_attribute(header, "NumFilesPerSnapshot", std::int32_t{1});
  hdf5::write_attribute(header, "Redshift", 0.0);
  hdf5::write_attribute(header, "BoxSize", side);
  hdf5::write_attribute(header, sides_name, std::vector<double>{table.frame.size_x, table.frame.size_y});
  hdf5::write_attribute(header, offset_name, table.frame.shear_offset);
  hdf5::write_attribute(header, frequency_name, table.frame.orbital_frequency);
  const double orbit_s = table.frame.orbital_frequency > 0.0 ? two_pi / table.frame.orbital_frequency : 0.0;
  hdf5::write_attribute(header, "Time", table.frame.time_orbits * orbit_s);
}

// SI, in the words of GADGET and of SWIFT.
void write_units(const hdf5::Handle& root) {
  const hdf5::Handle units = hdf5::create_group(root, "Units");
  for (const auto& [name, in_cgs] :
       {std::pair("UnitLength_in_cm", 100.0), std::pair("UnitMass_in_g", 1000.0),
        std::pair("UnitVelocity_in_cm_per_s", 100.0), std::pair("Unit length in cgs (U_L)", 100.0),
        std::pair("Unit mass in cgs (U_M)", 1000.0), std::pair("Unit time in cgs (U_t)", 1.0),
        std::pair("Unit current in cgs (U_I)", 1.0), std::pair("Unit temperature in cgs (U_T)", 1.0)})
    hdf5::write_attribute(units, name, in_cgs);
}

template<class Row>
void write_array(const hdf5::Handle& group, const char* name, const std::vector<Row>& rows, double to_cgs) {
  throw_if_interrupted();
  hdf5::Shape shape{rows.size()};
  hid_t type = hdf5::native_type<double>();
  if constexpr (std::is_same_v<Row, Vec3>)
    shape.push_back(3);
  else
    type = hdf5::native_type<Row>();
  const hdf5::Handle dataset = hdf5::write_dataset(group, name, type, shape, rows.data());
  if (to_cgs > 0.0)
    hdf5::write_attribute(dataset, "to_cgs", to_cgs);
}

} // namespace

bool has_gadget_groups(const hdf5::Handle& root) {
  const std::vector<std::string> names = hdf5::names_in(root);
  return std::any_of(names.begin(), names.end(), [](const auto& name) { return name.starts_with("PartType"); });
}

ParticleTable read_gadget_table(const hdf5::Handle& root, const std::string& file) {
  if (hdf5::exists(root, "Code") && hdf5::exists(root, "RingBox"))
    refuse_table(file, "it is a snapshot, not a table; start from it by start.from or --from");
  if (!hdf5::exists(root, "Header"))
    refuse_table(file,
                 "it has groups PartTypeN and no /Header with BoxSize and units; add it, or write x, y, z, vx, vy, vz, "
                 "r and m of its particles in SI units as arrays in the root of an HDF5 file, or as CSV");
  require_not_comoving(root, file);
  const Units units = units_of(root, file);
  const Arrays arrays(root, file);
  if (!arrays.has("Radius"))
    refuse_table(file,
                 fmt::format("/PartType{} has no Radius, which a hard sphere needs; add an array of radii, in the unit "
                             "of length",
                             arrays.type()));
  const hdf5::Handle header = hdf5::open_group(root, "Header");
  ParticleTable table{file, arrays.vectors("Coordinates", 1.0), {}, arrays.numbers("Radius", units.length), {}, {}};
  const Vec3 centre = centre_of(header, file);
  for (Vec3& position : table.positions)
    position = (position - centre) * units.length;
  if (arrays.has("Velocities"))
    table.velocities = arrays.vectors("Velocities", units.velocity);
  table.masses = masses_of(root, arrays, units.mass);
  if (arrays.has("Spins"))
    table.spins = arrays.vectors("Spins", units.velocity / units.length);
  if (hdf5::has_attribute(header, sides_name)) {
    const auto sides = hdf5::read_attribute_values<double>(header, sides_name);
    if (sides.size() == 2)
      table.frame = {sides[0] * units.length, sides[1] * units.length,
                     stated(root, {"Header"}, offset_name).value_or(0.0) * units.length,
                     stated(root, {"Header"}, frequency_name).value_or(0.0), 0.0};
  }
  return table;
}

void write_gadget_table(const std::filesystem::path& file, const ParticleTable& table) {
  if (!table.frame.has_box())
    throw UsageError(fmt::format("'{}' states no box, and GADGET's format needs its size; make a snapshot of it by "
                                 "\"keeler generate SCENE --from-table\" first",
                                 table.file));
  const double side = std::max(table.frame.size_x, table.frame.size_y);
  std::vector<Vec3> positions = table.positions;
  for (Vec3& position : positions)
    position += Vec3::Constant(0.5 * side);
  std::vector<std::uint64_t> ids(table.size());
  for (std::size_t k = 0; k < ids.size(); ++k)
    ids[k] = id_of(table, k);
  SealedFile out(file);
  out.write([&](const hdf5::Handle& root) {
    write_header(root, table, side);
    write_units(root);
    const hdf5::Handle group = hdf5::create_group(root, particles_group);
    write_array(group, "Coordinates", positions, 100.0);
    write_array(group, "ParticleIDs", ids, 0.0);
    write_array(group, "Radius", table.radii, 100.0);
    if (!table.velocities.empty())
      write_array(group, "Velocities", table.velocities, 100.0);
    if (!table.masses.empty())
      write_array(group, "Masses", table.masses, 1000.0);
    if (!table.spins.empty())
      write_array(group, "Spins", table.spins, 1.0);
  });
  out.finish();
}

} // namespace keeler::io
