#include <keeler/io/contacts.hpp>

#include "formats.hpp"
#include "provenance_attributes.hpp"
#include "sealed_file.hpp"

#include <keeler/core/error.hpp>

#include <fmt/format.h>

namespace keeler::io {
namespace {

constexpr char contacts_group[] = "Contacts";

// Calls column(name, unit, about, member) for each column: the single list of what a row holds. `member` returns a
// reference to the number in a row.
template<class Column> void for_each_column(const Column& column) {
  column(
      "Step", "1", "steps done before the contact", [](auto& row) -> auto& { return row.step; });
  column(
      "Time", "orbits", "time since the run began", [](auto& row) -> auto& { return row.time_orbits; });
  column(
      "X", "m", "where the spheres touch, radial", [](auto& row) -> auto& { return row.position.x(); });
  column(
      "Y", "m", "where the spheres touch, along the orbit", [](auto& row) -> auto& { return row.position.y(); });
  column(
      "Z", "m", "where the spheres touch, vertical", [](auto& row) -> auto& { return row.position.z(); });
  column(
      "LowID", "1", "id of one particle", [](auto& row) -> auto& { return row.low_id; });
  column(
      "HighID", "1", "id of the other, the higher one", [](auto& row) -> auto& { return row.high_id; });
  column(
      "ImageX", "L_x", "image of the other particle", [](auto& row) -> auto& { return row.image.nx; });
  column(
      "ImageY", "L_y", "image of the other particle", [](auto& row) -> auto& { return row.image.ny; });
  column(
      "NormalSpeed", "m/s", "speed of the approach along the line of centres",
      [](auto& row) -> auto& { return row.normal_speed; });
  column(
      "TangentialSpeed", "m/s", "relative speed across the line of centres before the contact",
      [](auto& row) -> auto& { return row.tangential_speed; });
  column(
      "Fast", "1", "1: faster than collisions.elastic_below_speed; 0: slower, and elastic",
      [](auto& row) -> auto& { return row.fast; });
  column(
      "NormalX", "1", "line of centres, a unit vector from the particle LowID to HighID: radial",
      [](auto& row) -> auto& { return row.normal.x(); });
  column(
      "NormalY", "1", "line of centres: along the orbit", [](auto& row) -> auto& { return row.normal.y(); });
  column(
      "NormalZ", "1", "line of centres: vertical", [](auto& row) -> auto& { return row.normal.z(); });
  column(
      "ImpulseX", "kg m/s", "momentum that the particle HighID got, LowID the opposite: radial",
      [](auto& row) -> auto& { return row.impulse.x(); });
  column(
      "ImpulseY", "kg m/s", "momentum that the particle HighID got: along the orbit",
      [](auto& row) -> auto& { return row.impulse.y(); });
  column(
      "ImpulseZ", "kg m/s", "momentum that the particle HighID got: vertical",
      [](auto& row) -> auto& { return row.impulse.z(); });
  column(
      "AtRest", "1", "1: a contact at rest, with the impulse that carries a kick; 0: a collision",
      [](auto& row) -> auto& { return row.at_rest; });
}

// Files of the same version that were written before there were these columns lack them; their rows have zeros.
bool may_be_absent(const std::string& column) {
  return column == "AtRest" || column.starts_with("Impulse") || (column.starts_with("Normal") && column.size() == 7);
}

// Type of a number in the file: a bool is stored as one byte.
template<class T> struct Stored { using type = T; };
template<> struct Stored<bool> { using type = std::uint8_t; };

template<class Member>
using StoredType = typename Stored<std::remove_cvref_t<std::invoke_result_t<Member, ContactRow&>>>::type;

void write_into(const hdf5::Handle& root, std::span<const ContactRow> rows, const ContactMeta& meta) {
  const hdf5::Handle group = hdf5::create_group(root, contacts_group);
  hdf5::write_attribute(group, "first_row", meta.first_row);
  hdf5::write_attribute(group, "Omega", meta.orbital_frequency);
  for_each_column([&](const std::string& name, std::string_view unit, std::string_view about, const auto& member) {
    std::vector<StoredType<decltype(member)>> column;
    column.reserve(rows.size());
    for (const ContactRow& row : rows)
      column.push_back(member(row));
    const hdf5::Handle dataset = hdf5::write_dataset(group, name, column, hdf5::Packing::compressed);
    hdf5::write_attribute(dataset, "unit", unit);
    hdf5::write_attribute(dataset, "about", about);
  });
  hdf5::write_attribute(hdf5::create_group(root, "Parameters"), "scene", meta.scene);
  const hdf5::Handle code = hdf5::create_group(root, "Code");
  write_provenance(code, meta.provenance);
  hdf5::write_attribute(code, "format", std::string_view(contacts_format));
  hdf5::write_attribute(code, "format_version", contacts_version);
}

} // namespace

void write_contacts(const std::filesystem::path& file, std::span<const ContactRow> rows, const ContactMeta& meta) {
  SealedFile out(file);
  out.write([&](const hdf5::Handle& root) { write_into(root, rows, meta); });
  out.finish();
}

ContactFile read_contacts(const std::filesystem::path& file) {
  const hdf5::Handle image = open_sealed(file);
  try {
    if (!hdf5::exists(image, "Code") || !hdf5::exists(image, contacts_group))
      throw IoError("it is not a file of contacts");
    const hdf5::Handle code = hdf5::open_group(image, "Code"), group = hdf5::open_group(image, contacts_group);
    require_version(code, code, {contacts_version, contacts_version}, "");
    ContactFile read;
    read.meta.first_row = hdf5::read_attribute<std::int64_t>(group, "first_row");
    read.meta.orbital_frequency = hdf5::read_attribute<double>(group, "Omega");
    read.meta.scene = hdf5::read_text_attribute(hdf5::open_group(image, "Parameters"), "scene");
    read.meta.provenance = read_provenance(code);
    read.meta.provenance.erase("format");
    read.rows.resize(hdf5::layout_of_dataset(hdf5::open_dataset(group, "Step")).count());
    for_each_column([&](const std::string& name, std::string_view, std::string_view, const auto& member) {
      using T = StoredType<decltype(member)>;
      if (may_be_absent(name) && !hdf5::exists(group, name))
        return;
      const hdf5::Handle dataset = hdf5::open_dataset(group, name);
      if (hdf5::layout_of_dataset(dataset).shape != hdf5::Shape{read.rows.size()})
        throw IoError(fmt::format("its column {} has another length than its column Step", name));
      std::vector<T> column(read.rows.size());
      hdf5::read_dataset(dataset, hdf5::native_type<T>(), column.data());
      for (std::size_t k = 0; k < column.size(); ++k)
        member(read.rows[k]) = static_cast<std::remove_cvref_t<decltype(member(read.rows[k]))>>(column[k]);
    });
    return read;
  } catch (const IoError& error) {
    throw IoError(fmt::format("cannot read contacts '{}': {}", file.string(), error.what()));
  }
}

} // namespace keeler::io
