// The particles of a run's snapshots, encoded for the three-dimensional view of the page: positions in 16 bits, colours
// in 8.
#pragma once

#include <keeler/particles/patch.hpp>
#include <keeler/render/colour_field.hpp>

#include <nlohmann/json.hpp>

#include <cassert>
#include <cstddef>
#include <string>
#include <vector>

namespace keeler::run_report {

class ParticleView {
public:
  /// Encodes at most `max_particles` (> 0) particles per snapshot, with equal ids in all snapshots.
  explicit ParticleView(std::size_t max_particles) : max_particles_(max_particles) { assert(max_particles > 0); }

  /// Adds a snapshot; call it for the snapshots of one run, oldest first. Throws IoError if the number of particles
  /// differs from the first snapshot's.
  void add(const Patch& patch, const std::string& file);

  std::size_t snapshots() const { return snapshots_.size(); }

  /// Returns the data that view.js reads. Precondition: at least one snapshot was added.
  nlohmann::ordered_json json() const;

private:
  struct Shown {
    std::string file;
    double time_orbits;
    std::vector<Vec3> positions;
    std::vector<std::vector<double>> values; // for each field, of all particles shown
  };
  struct Field {
    const char* name;
    render::ColourField field;
    render::ColourRange range; // over all snapshots
  };

  void choose_fields(const Patch& patch);
  nlohmann::ordered_json fields() const;

  std::size_t max_particles_, total_ = 0;
  double size_x_ = 0.0, size_y_ = 0.0;
  std::vector<double> radii_;
  std::vector<Field> fields_;
  std::vector<Shown> snapshots_;
};

} // namespace keeler::run_report
