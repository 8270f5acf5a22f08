#include "past.hpp"

#include <keeler/core/error.hpp>
#include <keeler/initial_conditions/possible.hpp>
#include <keeler/io/snapshot.hpp>
#include <keeler/runs/stored_patches.hpp>
#include <keeler/scene/load.hpp>

#include <cassert>

#include <hdf5.h>

namespace keeler::live_view {

namespace fs = std::filesystem;

bool Past::is_safe_beside_a_run() {
  hbool_t safe = 0;
  return H5is_library_threadsafe(&safe) >= 0 && safe;
}

fs::path Past::file_of(const std::string& name) const {
  return fs::is_directory(path_) ? path_ / name : path_;
}

const std::vector<std::string>& Past::names() {
  if (path_.empty() || !search_.due())
    return names_;
  search_.spend([&] {
    names_.clear();
    if (!fs::is_directory(path_)) {
      if (fs::exists(path_))
        names_.push_back(path_.filename().string());
      return;
    }
    try {
      for (const fs::path& file : runs::snapshots_in(path_))
        names_.push_back(file.filename().string());
    } catch (const IoError&) { // none yet
    }
  });
  return names_;
}

const Patch& Past::patch(const std::string& name) {
  if (name == read_)
    return patch_;
  read_.clear();
  io::Snapshot snapshot = io::read_snapshot(file_of(name));
  initial_conditions::require_possible(snapshot.patch, file_of(name).string());
  if (snapshot.patch.size() == 0)
    throw IoError("'" + file_of(name).string() + "' holds no particle");
  if (!scale_) {
    const Scene scene = scene::parse_stored_scene(snapshot.meta.scene, file_of(name).string());
    scale_ = runs::RingScale::of(snapshot.patch, !scene.external_forces.empty(), scene.gravity.has_value());
  }
  patch_ = std::move(snapshot.patch);
  read_ = name;
  return patch_;
}

Frame Past::frame(std::size_t k, render::ColourField field) {
  assert(k < names_.size());
  return Encoder(field).encode(patch(names_[k]));
}

std::optional<runs::RingScale> Past::scale() {
  if (!scale_ && !names().empty())
    patch(names_.front());
  return scale_;
}

} // namespace keeler::live_view
