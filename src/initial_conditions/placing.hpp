// Places without overlap for the particles of a uniform patch, large ones first.
//
// Sizes are placed octave by octave. The places of an octave are drawn clear of everything larger, so that no small
// particle must be pushed out of a large one; then all that are placed so far are moved apart (separation.hpp). Each
// octave is a smaller part of the work than the next in any law with more small particles than large ones; 1 : 10⁴ has
// fourteen.
//
// Of several ranks each has the spheres that were placed in its slab (sphere_slabs.hpp). A particle's tries are its own
// random numbers, so it does not matter who makes them: one that tries a place in another slab goes there.
#pragma once

#include <keeler/core/random.hpp>
#include <keeler/initial_conditions/uniform.hpp>

#include "separation.hpp"
#include "size_levels.hpp"
#include "sphere_slabs.hpp"

#include <utility>

namespace keeler {

/// Volume (m³) of the particles, each without the share that it has of the mass: a moonlet alone is no crowd. Of
/// several ranks each has the radii of some. Collective.
double crowd_volume(const std::vector<double>& radii, const Communicator& ranks = {});

class Placing {
public:
  Placing(const UniformRequest& request, const Communicator& ranks);

  /// Calls progress(share of the work that is done). Throws UsageError when there is no room, Interrupted. Collective.
  void run(const std::function<void(double)>& progress);

  /// The particles by their numbers; of several ranks each has some of them.
  std::vector<Sphere> take_particles();

private:
  struct Octave {
    std::size_t first, last; // in order_
    std::size_t placed;      // particles of all ranks when it is done
  };
  /// A particle that tries places until one is free.
  struct Trial {
    RandomStream random{0, RandomPurpose::position, 0};
    double radius = 0.0;
    std::uint32_t particle = 0;
    int tries = 0;
    double flat = 0.0, normal = 0.0; // of its height
    Vec3 place = Vec3::Zero();       // the last one tried
  };
  void find_octaves();
  void draw(const Octave& octave);
  bool is_free(const Trial& trial, const SizeLevels& larger) const;
  std::pair<double, double> draw_guiding_centre(RandomStream& random) const;
  void try_another_place(Trial& trial) const;
  std::vector<Sphere> place(std::vector<Trial> trials, const SizeLevels& larger) const;
  std::vector<Trial> in_their_slabs(std::vector<Trial> trials) const;
  bool is_caught(std::size_t k, const SizeLevels& levels) const;
  void redraw_caught(int round);

  const UniformRequest& request_;
  SphereSlabs slabs_;
  double crowd_volume_;
  std::vector<std::uint32_t> order_; // request_.radii, the largest first
  std::vector<Octave> octaves_;
  std::vector<Sphere> spheres_; // placed so far
};

} // namespace keeler
