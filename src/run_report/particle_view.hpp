// The particles of a run's snapshots as the page's view in three dimensions takes them: places in 16 bits, colours
// in 8.
#pragma once

#include <keeler/particles/patch.hpp>
#include <keeler/render/colour_field.hpp>

#include <nlohmann/json.hpp>

#include <cstddef>
#include <string>
#include <vector>

namespace keeler {

class ParticleView {
public:
  /// Shows so many particles of each snapshot at most, the same ids in all.
  explicit ParticleView(std::size_t max_particles) : max_particles_(max_particles) {}

  /// Snapshots of one run, oldest first.
  void add(const Patch& patch, const std::string& file);

  std::size_t snapshots() const { return snapshots_.size(); }

  /// What view.js reads. At least one snapshot.
  nlohmann::ordered_json json() const;

private:
  struct Shown {
    std::string file;
    double time_orbits;
    std::vector<Vec3> places;
    std::vector<std::vector<double>> values; // of each field
  };
  struct Field {
    const char* name;
    ColourField field;
    ColourRange range; // of all snapshots
  };

  void choose_fields(const Patch& patch);
  nlohmann::ordered_json fields() const;

  std::size_t max_particles_, of_ = 0;
  double size_x_ = 0.0, size_y_ = 0.0;
  std::vector<double> radii_;
  std::vector<Field> fields_;
  std::vector<Shown> snapshots_;
};

} // namespace keeler
