// Tables of particles as npz of numpy: a zip archive of arrays that are stored, not compressed (numpy.savez). Arrays
// have the names of the Python package: positions, velocities, radii, masses, spins, ids; box, shear_offset,
// orbital_frequency, orbits.
#include "npy_array.hpp"
#include "table_columns.hpp"
#include "table_files.hpp"
#include "zip_archive.hpp"

#include <fmt/format.h>

#include <map>

namespace keeler::io {

namespace {

constexpr const char* known_arrays = "positions velocities radii masses spins ids box shear_offset orbital_frequency "
                                     "orbits";

// The arrays of a file, by name.
class NpzArrays {
public:
  NpzArrays(std::string_view content, const std::string& file) : file_(file) {
    const std::string known = fmt::format(" {} ", known_arrays);
    for (const auto& [member, bytes] : zip_members(content, file)) {
      const std::string name = member.ends_with(".npy") ? member.substr(0, member.size() - 4) : member;
      if (known.find(" " + name + " ") == std::string::npos)
        refuse_table(file_,
                     fmt::format("unknown array '{}'; rename or remove it (the arrays are {})", name, known_arrays));
      if (name != "ids")
        arrays_.emplace(name, npy_array(bytes, fmt::format("{}: {}", file, name)));
    }
    count_ = find("radii") ? find("radii")->values.size() : 0;
  }

  std::size_t count() const { return count_; }

  std::vector<double> numbers(const char* name, bool needed) const {
    const NpyArray* const array = find(name);
    if (array == nullptr && needed)
      refuse_table(file_, fmt::format("the array '{}' is missing; add it (the arrays are {})", name, known_arrays));
    if (array == nullptr)
      return {};
    require_shape(name, *array, {count_});
    return array->values;
  }

  std::vector<Vec3> vectors(const char* name, bool needed) const {
    const NpyArray* const array = find(name);
    if (array == nullptr) {
      numbers(name, needed); // says that it is missing
      return {};
    }
    require_shape(name, *array, {count_, 3});
    std::vector<Vec3> vectors(count_);
    for (std::size_t k = 0; k < count_; ++k)
      vectors[k] = Vec3(array->values[3 * k], array->values[3 * k + 1], array->values[3 * k + 2]);
    return vectors;
  }

  // Returns `size` numbers, zeros without such an array.
  std::vector<double> stated(const char* name, std::size_t size) const {
    const NpyArray* const array = find(name);
    if (array == nullptr)
      return std::vector<double>(size, 0.0);
    if (array->values.size() != size)
      refuse_table(file_, fmt::format("the array '{}' has {} numbers, not {}; correct or remove it", name,
                                      array->values.size(), size));
    return array->values;
  }

private:
  const NpyArray* find(const std::string& name) const {
    const auto found = arrays_.find(name);
    return found == arrays_.end() ? nullptr : &found->second;
  }

  void require_shape(const char* name, const NpyArray& array, const std::vector<std::size_t>& shape) const {
    if (array.shape != shape)
      refuse_table(file_, fmt::format("the array '{}' has the shape ({}), not ({}): one row per radius; correct it",
                                      name, fmt::join(array.shape, ", "), fmt::join(shape, ", ")));
  }

  std::string file_;
  std::map<std::string, NpyArray> arrays_;
  std::size_t count_ = 0;
};

} // namespace

bool is_npz(std::string_view content) {
  return content.starts_with("PK\x03\x04") || content.starts_with("PK\x05\x06");
}

ParticleTable read_npz_table(std::string_view content, const std::string& file) {
  const NpzArrays arrays(content, file);
  ParticleTable table{file,
                      {},
                      arrays.vectors("velocities", false),
                      arrays.numbers("radii", true),
                      arrays.numbers("masses", false),
                      {},
                      arrays.vectors("spins", false)};
  require_rows(arrays.count(), file);
  table.positions = arrays.vectors("positions", true);
  const std::vector<double> box = arrays.stated("box", 2);
  table.frame = {box[0], box[1], arrays.stated("shear_offset", 1)[0], arrays.stated("orbital_frequency", 1)[0],
                 arrays.stated("orbits", 1)[0]};
  return table;
}

void write_npz_table(const std::filesystem::path& file, const ParticleTable& table) {
  const auto bytes = [](const auto& rows) { return std::as_bytes(std::span(rows)); };
  const std::size_t count = table.size();
  std::vector<std::uint64_t> ids(count);
  for (std::size_t k = 0; k < count; ++k)
    ids[k] = id_of(table, k);
  static_assert(sizeof(Vec3) == 3 * sizeof(double), "arrays of vectors are written as (N, 3) doubles");
  const std::vector<double> box{table.frame.size_x, table.frame.size_y};
  const TableFrame& frame = table.frame;
  const auto one = [](const double& number) { return std::as_bytes(std::span(&number, 1)); };
  ZipWriter zip(file);
  const auto add = [&](const char* name, const char* type, const std::vector<std::size_t>& shape,
                       std::span<const std::byte> content) {
    zip.add(fmt::format("{}.npy", name), npy_header(type, shape), content);
  };
  add("positions", "<f8", {count, 3}, bytes(table.positions));
  if (!table.velocities.empty())
    add("velocities", "<f8", {count, 3}, bytes(table.velocities));
  add("radii", "<f8", {count}, bytes(table.radii));
  if (!table.masses.empty())
    add("masses", "<f8", {count}, bytes(table.masses));
  if (!table.spins.empty())
    add("spins", "<f8", {count, 3}, bytes(table.spins));
  add("ids", "<u8", {count}, bytes(ids));
  if (frame.has_box()) {
    add("box", "<f8", {2}, bytes(box));
    add("shear_offset", "<f8", {}, one(frame.shear_offset));
    add("orbits", "<f8", {}, one(frame.time_orbits));
  }
  if (frame.orbital_frequency > 0.0)
    add("orbital_frequency", "<f8", {}, one(frame.orbital_frequency));
  zip.finish();
}

} // namespace keeler::io
