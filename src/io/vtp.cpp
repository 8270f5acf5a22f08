#include <keeler/io/vtp.hpp>

#include "table_columns.hpp"

#include <keeler/files/files.hpp>
#include <keeler/files/new_file.hpp>

#include <fmt/format.h>

#include <bit>
#include <cstdint>
#include <numeric>
#include <span>

namespace keeler::io {
namespace {

static_assert(std::endian::native == std::endian::little, "the files declare LittleEndian");
static_assert(sizeof(Vec3) == 3 * sizeof(double), "arrays of vectors are written as (N, 3) doubles");

// The arrays of a file: the XML elements that describe them, and the appended data, each array after its length.
class AppendedArrays {
public:
  // Adds an array and returns its XML element. Precondition: `rows` outlives write().
  template<class Row>
  std::string add(const char* type, const char* name, int components, const char* unit, const std::vector<Row>& rows) {
    const std::uint64_t offset = size_;
    const std::span<const std::byte> bytes = std::as_bytes(std::span(rows));
    arrays_.push_back(bytes);
    size_ += sizeof(std::uint64_t) + bytes.size();
    const std::string label =
        *unit ? fmt::format("<InformationKey name=\"UNITS_LABEL\" location=\"vtkDataArray\">{}</InformationKey>", unit)
              : "";
    return fmt::format("<DataArray type=\"{}\" Name=\"{}\" NumberOfComponents=\"{}\" format=\"appended\" offset=\"{}\">"
                       "{}</DataArray>\n",
                       type, name, components, offset, label);
  }

  void write(files::NewFile& out) const {
    for (const std::span<const std::byte> array : arrays_) {
      const std::uint64_t length = array.size();
      out.write(std::as_bytes(std::span(&length, 1)));
      out.write(array);
    }
  }

private:
  std::vector<std::span<const std::byte>> arrays_;
  std::uint64_t size_ = 0;
};

void write_text(files::NewFile& out, std::string_view text) {
  out.write(std::as_bytes(std::span(text)));
}

} // namespace

void write_vtp(const std::filesystem::path& file, const ParticleTable& table) {
  std::vector<std::int64_t> numbers(table.size() + 1); // indices of points; shifted by one, ends of the cells
  std::iota(numbers.begin(), numbers.end(), std::int64_t{0});
  const std::vector<std::int64_t> points(numbers.begin(), numbers.end() - 1), ends(numbers.begin() + 1, numbers.end());
  std::vector<std::uint64_t> ids(table.size());
  for (std::size_t k = 0; k < ids.size(); ++k)
    ids[k] = id_of(table, k);

  AppendedArrays arrays;
  std::string xml = "<?xml version=\"1.0\"?>\n"
                    "<VTKFile type=\"PolyData\" version=\"1.0\" byte_order=\"LittleEndian\" header_type=\"UInt64\">\n"
                    "<PolyData>\n";
  xml += fmt::format("<FieldData><DataArray type=\"Float64\" Name=\"TimeValue\" NumberOfTuples=\"1\" format=\"ascii\">"
                     "{}</DataArray></FieldData>\n",
                     table.frame.time_orbits);
  xml += fmt::format("<Piece NumberOfPoints=\"{0}\" NumberOfVerts=\"{0}\" NumberOfLines=\"0\" NumberOfStrips=\"0\" "
                     "NumberOfPolys=\"0\">\n<PointData>\n",
                     table.size());
  if (!table.velocities.empty())
    xml += arrays.add("Float64", "Velocities", 3, "m/s", table.velocities);
  if (!table.masses.empty())
    xml += arrays.add("Float64", "Masses", 1, "kg", table.masses);
  xml += arrays.add("UInt64", "ParticleIDs", 1, "", ids);
  xml += arrays.add("Float64", "Radius", 1, "m", table.radii);
  if (!table.spins.empty())
    xml += arrays.add("Float64", "Spins", 3, "rad/s", table.spins);
  xml += "</PointData>\n<Points>\n" + arrays.add("Float64", "Points", 3, "m", table.positions);
  xml += "</Points>\n<Verts>\n" + arrays.add("Int64", "connectivity", 1, "", points);
  xml += arrays.add("Int64", "offsets", 1, "", ends);
  xml += "</Verts>\n</Piece>\n</PolyData>\n<AppendedData encoding=\"raw\">\n_";

  files::NewFile out(file);
  write_text(out, xml);
  arrays.write(out);
  write_text(out, "\n</AppendedData>\n</VTKFile>\n");
  out.keep();
}

void write_pvd(const std::filesystem::path& file, const std::vector<VtpInstant>& instants) {
  std::string xml = "<?xml version=\"1.0\"?>\n"
                    "<VTKFile type=\"Collection\" version=\"0.1\" byte_order=\"LittleEndian\">\n<Collection>\n";
  for (const VtpInstant& instant : instants)
    xml += fmt::format("<DataSet timestep=\"{}\" part=\"0\" file=\"{}\"/>\n", instant.time_orbits, instant.file);
  files::write_text(file, xml + "</Collection>\n</VTKFile>\n");
}

} // namespace keeler::io
