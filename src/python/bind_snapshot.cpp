// Python bindings of snapshots (a patch at one time with its scene): files, initial states, pictures and measurements.
#include "arrays.hpp"
#include "bindings.hpp"
#include "computing.hpp"
#include "numbers.hpp"
#include "snapshot.hpp"

#include <keeler/advice/warnings.hpp>
#include <keeler/cells/overlap.hpp>
#include <keeler/core/error.hpp>
#include <keeler/files/files.hpp>
#include <keeler/files/new_file.hpp>
#include <keeler/initial_conditions/clumped.hpp>
#include <keeler/initial_conditions/from_table.hpp>
#include <keeler/initial_conditions/initial.hpp>
#include <keeler/initial_conditions/possible.hpp>
#include <keeler/initial_conditions/tiled.hpp>
#include <keeler/io/provenance.hpp>
#include <keeler/io/series.hpp>
#include <keeler/io/snapshot.hpp>
#include <keeler/quantities/views.hpp>
#include <keeler/render/patch_picture.hpp>
#include <keeler/runs/measured_part.hpp>
#include <keeler/runs/measurement.hpp>
#include <keeler/runs/moonlet_columns.hpp>
#include <keeler/runs/series_columns.hpp>
#include <keeler/runs/summary.hpp>
#include <keeler/scene/load.hpp>
#include <keeler/scene/patch_scale.hpp>

#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include <cassert>

namespace keeler::python {
namespace {

namespace fs = std::filesystem;

PythonSnapshot read(const fs::path& file, bool is_a_start) {
  require_own_threads();
  const Unlocked unlocked;
  io::Snapshot snapshot = io::read_snapshot(file);
  initial_conditions::require_possible(snapshot.patch, file.string());
  return {std::move(snapshot.patch), std::move(snapshot.meta.scene), is_a_start};
}

// Writes a snapshot. The scene of a start then starts from this file, unless `as_it_is`, for copies in memory.
void write(const PythonSnapshot& snapshot, const fs::path& file, bool as_it_is) {
  require_own_threads();
  const Unlocked unlocked;
  const std::string scene = snapshot.is_a_start && !as_it_is
                                ? parse_scene(snapshot.scene, file.string(), {}, file.string()).resolved
                                : snapshot.scene;
  io::write_snapshot(file, snapshot.patch, {scene, io::collect_provenance({})});
}

PythonSnapshot generate(const Scene& scene, bool clumped) {
  return make_interruptibly([&] {
    Patch patch = clumped ? initial_conditions::clumped_state(scene).patch : initial_patch(scene);
    const Scene decided = decided_by(scene, initial_conditions::scale_of(patch));
    return PythonSnapshot{std::move(patch), decided.resolved};
  });
}

// Tiles a snapshot. The scene cannot reproduce this state, so the new scene starts from a file, with all particles.
PythonSnapshot tile(const PythonSnapshot& snapshot, std::size_t nx, std::size_t ny, const std::string& name) {
  return make_interruptibly([&] {
    const Scene scene = parse_scene(snapshot.scene, name, {"start.keep_fraction=1.0"}, name);
    const Patch patch = initial_conditions::patch_from_snapshot(snapshot.patch, name, scene);
    cells::require_no_overlap(patch, "'" + name + "'");
    return PythonSnapshot{initial_conditions::tiled_patch(patch, nx, ny), scene.resolved, true};
  });
}

PythonSnapshot from_arrays(const std::string& text, const std::string& name, const std::vector<std::string>& overrides,
                           const Doubles& positions, const std::optional<Doubles>& velocities, const Doubles& radii,
                           const std::optional<Doubles>& masses, const std::optional<Doubles>& spins, bool relaxed,
                           double shear_offset, const std::pair<double, double>& box, double orbital_frequency) {
  io::ParticleTable table;
  table.file = "the arrays";
  const auto count = positions.ndim() > 0 ? static_cast<std::size_t>(positions.shape(0)) : 0;
  if (count == 0)
    throw UsageError("positions has no rows; give one row of x, y, z per particle");
  table.positions = vectors_from(positions, count, "positions");
  table.radii = numbers_from(radii, count, "radii");
  if (velocities)
    table.velocities = vectors_from(*velocities, count, "velocities");
  if (masses)
    table.masses = numbers_from(*masses, count, "masses");
  if (spins)
    table.spins = vectors_from(*spins, count, "spins");
  table.frame = {box.first, box.second, shear_offset, orbital_frequency, 0.0};
  return make_interruptibly([&] {
    const scene::TableScene of = scene::parse_table_scene(text, name, overrides);
    Patch patch = initial_conditions::patch_from_table(table, of);
    if (relaxed)
      initial_conditions::relax(patch);
    try {
      cells::require_no_overlap(patch, table.file);
    } catch (const InvariantError& error) {
      throw InvariantError(error.what() + initial_conditions::overlap_hint(patch));
    }
    const Scene scene =
        decided_by(parse_scene(of.scene.resolved, name, {}, table.file), initial_conditions::scale_of(patch));
    return PythonSnapshot{std::move(patch), scene.resolved, true};
  });
}

// Returns the numbers and their descriptions; the Python package combines them into a mapping.
py::object numbers_of(const quantities::Record& record) {
  return py::make_tuple(as_python(json_of(record)), described(quantities_of(record)));
}

py::object analyze_snapshot(const PythonSnapshot& snapshot) {
  return numbers_of(make_interruptibly([&] {
    const runs::TransportReport transport = runs::TransportReport::of_snapshot(
        snapshot.patch, scene::parse_stored_scene(snapshot.scene, "snapshot").gravity);
    return record_of(measure({&snapshot.patch, 1}, transport));
  }));
}

py::object analyze_path(const fs::path& path, const std::optional<double>& since, const std::optional<double>& until) {
  return numbers_of(make_interruptibly([&] {
    const runs::MeasuredPart part = runs::measured_part(path, {since, until});
    return record_of(measure(part.stored.patches, part.transport));
  }));
}

py::dict series(const fs::path& file) {
  const io::SeriesTable table = io::read_series(file);
  assert(table.names.size() == table.columns.size());
  py::dict columns;
  for (std::size_t c = 0; c < table.names.size(); ++c) {
    const std::vector<double>& column = table.columns[c];
    columns[py::str(table.names[c])] = py::array_t<double>(static_cast<py::ssize_t>(column.size()), column.data());
  }
  return columns;
}

// Returns a dictionary from columns to (unit, meaning): of the tables of a run, or of measured numbers.
py::dict column_quantities(bool of_run) {
  using quantities::Quantity, quantities::Shape;
  py::dict all;
  const auto add = [&](const Quantity& quantity) {
    for (const quantities::UnitSystem system : quantity.systems())
      all[py::str(quantity.full_name(system))] =
          py::make_tuple(std::string(unit_in(quantity.unit, system).text), quantity.meaning);
  };
  if (!of_run) {
    for (const Quantity& quantity : runs::measured_quantities())
      if (quantity.shape == Shape::vector)
        for (const std::size_t axis : {0U, 1U, 2U})
          add(quantity.along(axis));
      else if (quantity.shape == Shape::number)
        add(quantity);
    return all;
  }
  for (const Quantity& quantity : runs::series_quantities())
    add(quantity);
  for (const runs::MoonletColumn& column : runs::moonlet_columns())
    all[py::str(column.name)] = py::make_tuple(std::string(column.unit), std::string(column.meaning));
  all["step"] = py::make_tuple(std::string("1"), std::string("steps done"));
  return all;
}

void render(const PythonSnapshot& snapshot, const fs::path& file, const std::string& title, int width) {
  require_own_threads();
  const Unlocked unlocked;
  render::PictureOptions options;
  options.title = title;
  options.width = width;
  render_patch(snapshot.patch, file.string(), options);
}

void write_bytes(const fs::path& file, const std::string& content) {
  require_own_threads();
  const Unlocked unlocked;
  files::write_text(file, content);
}

py::object array_or_none(const std::vector<Vec3>& rows, double factor) {
  return rows.empty() ? py::object(py::none()) : py::object(scaled_copy(rows, factor));
}

} // namespace

void bind_snapshot(py::module_& module) {
  using Self = const PythonSnapshot&;
  py::class_<PythonSnapshot>(module, "Snapshot")
      .def("__len__", [](Self self) { return self.patch.size(); })
      .def_property_readonly("positions",
                             [](const py::object& self) { return view(self.cast<Self>().patch.positions, self); })
      .def("velocities", [](Self self) { return scaled_copy(self.patch.velocities, self.patch.orbital_frequency); })
      .def("spins", [](Self self) { return array_or_none(self.patch.spins, self.patch.orbital_frequency); })
      .def_property_readonly("radii", [](const py::object& self) { return view(self.cast<Self>().patch.radii, self); })
      .def_property_readonly("masses",
                             [](const py::object& self) { return view(self.cast<Self>().patch.masses, self); })
      .def_property_readonly("ids", [](const py::object& self) { return view(self.cast<Self>().patch.ids, self); })
      .def_property_readonly("box", [](Self self) { return std::pair(self.patch.box.size_x, self.patch.box.size_y); })
      .def_property_readonly("shear_offset", [](Self self) { return self.patch.offset; })
      .def_property_readonly("orbital_frequency", [](Self self) { return self.patch.orbital_frequency; })
      .def_property_readonly(
          "frequency_ratios",
          [](Self self) { return std::pair(self.patch.frequencies.kappa, self.patch.frequencies.nu); })
      .def_property_readonly("time_orbits", [](Self self) { return self.patch.time_orbits; })
      .def_readonly("scene", &PythonSnapshot::scene)
      .def_readonly("is_a_start", &PythonSnapshot::is_a_start)
      .def("save", &write, py::arg("file"), py::arg("as_it_is") = false)
      .def("start_doubts", [](Self self) { return advice::warnings(initial_conditions::scale_of(self.patch).start); })
      .def("analyze", &analyze_snapshot)
      .def("tile", &tile, py::arg("nx"), py::arg("ny"), py::arg("name"))
      .def("render", &render, py::arg("file"), py::arg("title"), py::arg("width"));
  module.def("read_snapshot", &read, py::arg("file"), py::arg("is_a_start") = false);
  module.def(
      "write_file", [](const fs::path& file, const py::bytes& content) { write_bytes(file, content); }, py::arg("file"),
      py::arg("content"));
  module.def("is_stream", &files::is_stream, py::arg("file"));
  module.def("read_series", &series, py::arg("file"));
  module.def("generate", &generate, py::arg("scene"), py::arg("clumped"));
  module.def("column_quantities", &column_quantities, py::arg("of_run"));
  module.def("quantities", [] { return described(runs::measured_quantities()); });
  module.def("summary_quantities", [] { return described(runs::summary_quantities()); });
  module.def("analyze", &analyze_path, py::arg("path"), py::arg("since"), py::arg("until"));
  module.def("from_arrays", &from_arrays, py::arg("text"), py::arg("name"), py::arg("overrides"), py::arg("positions"),
             py::arg("velocities"), py::arg("radii"), py::arg("masses"), py::arg("spins"), py::arg("relax"),
             py::arg("shear_offset"), py::arg("box"), py::arg("orbital_frequency"));
}

} // namespace keeler::python
