// Targets that read Keeler's HDF5 files: a snapshot and a checkpoint whose content was changed before they were sealed,
// and files that other programs wrote or damaged.
#include "hdf5_edits.hpp"
#include "sealed_file.hpp"
#include "targets.hpp"

#include <keeler/core/error.hpp>
#include <keeler/diagnostics/particle_means.hpp>
#include <keeler/initial_conditions/initial.hpp>
#include <keeler/initial_conditions/possible.hpp>
#include <keeler/io/contacts.hpp>
#include <keeler/io/describe.hpp>
#include <keeler/io/particle_table.hpp>
#include <keeler/io/snapshot.hpp>
#include <keeler/runs/run.hpp>
#include <keeler/scene/load.hpp>
#include <keeler/simulation/simulation.hpp>

namespace keeler::fuzz {
namespace {

namespace fs = std::filesystem;

Patch small_patch() {
  return initial_patch(parse_scene(small_scene(), "scene.toml"));
}

template<class Read> bool reads(const Read& read) {
  try {
    read();
    return true;
  } catch (const Error&) {
    return false;
  }
}

// All that commands do with a file whose name they are given.
void read_all(const fs::path& file) {
  reads([&] { initial_conditions::require_possible(io::read_snapshot(file).patch, file.string()); });
  reads([&] { io::describe_file(file); });
  reads([&] { io::read_contacts(file); });
  reads([&] { io::read_particle_table(file); });
}

// The content of a file that a target of this process starts from.
template<class Write> std::vector<std::byte> content_written(const fs::path& folder, const Write& write) {
  const fs::path file = folder / "pristine";
  write(file);
  return unsealed(file);
}

void write_edited(const fs::path& file, const std::vector<std::byte>& pristine, std::string_view input) {
  Draw draw(input);
  const io::hdf5::Handle image = open_to_edit(pristine);
  edit(image, draw);
  reads([&] { renew_checksum(image); }); // of fields that cannot be read there is none
  const std::string content = content_of(image);
  put(file, content + io::seal_of(std::as_bytes(std::span(content))));
}

} // namespace

void read_edited_snapshot(std::string_view input, const fs::path& folder) {
  static const std::vector<std::byte> pristine = content_written(folder, [](const fs::path& file) {
    io::write_snapshot(file, small_patch(), {small_scene(), {{"version", "1"}}, {{"orbits", {1.0}}}});
  });
  const fs::path file = folder / "snap_000000.hdf";
  write_edited(file, pristine, input);
  read_all(file);
}

void read_edited_checkpoint(std::string_view input, const fs::path& folder) {
  static const std::vector<std::byte> pristine = content_written(folder, [](const fs::path& file) {
    const Scene scene = parse_scene(small_scene(), "scene.toml");
    runs::store_checkpoint(file, Simulation(scene, small_patch()).state(), scene);
  });
  const fs::path file = folder / "checkpoint_000000.h5";
  write_edited(file, pristine, input);
  reads([&] { io::describe_file(file); });
  runs::StoredRun run = runs::load_checkpoint(file);
  if (reads([&] { require_sound(Simulation(run.scene, run.state).patch()); }))
    Simulation(run.scene, std::move(run.state)).means();
}

void read_foreign(std::string_view input, const fs::path& folder) {
  put(folder / "foreign.hdf", input);
  read_all(folder / "foreign.hdf");
}

void read_foreign_here(std::string_view input, const fs::path& folder) {
  put(folder / "foreign.hdf", std::string(input) + io::seal_of(std::as_bytes(std::span(input))));
  read_all(folder / "foreign.hdf");
}

} // namespace keeler::fuzz
