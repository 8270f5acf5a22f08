// Places without overlap for the particles of a uniform patch, large ones first.
//
// Sizes are placed octave by octave. The places of an octave are drawn clear of everything larger, so that no small
// particle must be pushed out of a large one; then all that are placed so far are moved apart (separation.hpp). Each
// octave is a smaller part of the work than the next in any law with more small particles than large ones; 1 : 10⁴ has
// fourteen.
#pragma once

#include <keeler/core/random.hpp>
#include <keeler/states/uniform.hpp>

#include "separation.hpp"
#include "size_levels.hpp"

#include <utility>

namespace keeler {

/// Volume (m³) of the particles, each without the share that it has of the mass: a moonlet alone is no crowd.
double crowd_volume(const std::vector<double>& radii);

class Placing {
public:
  explicit Placing(const UniformRequest& request);

  /// Calls progress(share of the work that is done). Throws UsageError when there is no room, Interrupted.
  void run(const std::function<void(double)>& progress);

  /// By particle, m.
  std::vector<Vec3> places() const;

private:
  struct Octave {
    std::size_t first, last; // in order_
  };
  void draw(const Octave& octave);
  bool is_free(const Vec3& place, double radius, const SizeLevels& larger) const;
  std::pair<double, double> draw_guiding_centre(RandomStream& random) const;
  Vec3 draw_place(RandomStream random, double radius, const SizeLevels& larger) const;
  void redraw_caught(int round);

  const UniformRequest& request_;
  double crowd_volume_;
  std::vector<std::uint32_t> order_; // particles, the largest first
  std::vector<Octave> octaves_;
  std::vector<Sphere> spheres_; // placed so far
};

} // namespace keeler
