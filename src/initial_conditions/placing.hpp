// Positions without overlap for the particles of a uniform patch, large ones first.
//
// Sizes are placed octave by octave. Positions of an octave are drawn clear of everything larger, so that no small
// particle must be pushed out of a large one; then all particles placed so far are moved apart (separation.hpp). Each
// octave takes a smaller part of the work than the next in any law with more small particles than large ones; 1 : 10⁴
// has fourteen.
//
// In a distributed start each rank has the spheres that were placed in its slab (sphere_slabs.hpp). The trials of a
// particle use a random stream of that particle, so any rank can make them: a trial in another slab is sent there.
#pragma once

#include <keeler/core/random.hpp>
#include <keeler/initial_conditions/uniform.hpp>

#include "separation.hpp"
#include "size_levels.hpp"
#include "sphere_slabs.hpp"

#include <utility>

namespace keeler::initial_conditions {

/// Returns the volume (m³) of the particles, each weighted by 1 − its fraction of the mass, so that a dominant moonlet
/// does not count. Collective: each rank has the radii of some particles.
double crowd_volume(const std::vector<double>& radii, const Communicator& ranks = {});

class Placing {
public:
  Placing(const UniformRequest& request, const Communicator& ranks);

  /// Calls progress(fraction of the work done). Throws UsageError if there is no room, Interrupted. Collective.
  void run(const std::function<void(double)>& progress);

  /// Returns the particles by number; each rank has some of them.
  std::vector<Sphere> take_particles();

private:
  struct Octave {
    std::size_t first, last; // in order_
    std::size_t placed;      // particles of all ranks after this octave
  };
  /// A particle that tries positions until one is free.
  struct Trial {
    RandomStream random{0, RandomPurpose::position, 0};
    double radius = 0.0;
    std::uint32_t particle = 0;
    int tries = 0;
    double flat = 0.0, normal = 0.0; // random numbers of its height
    Vec3 position = Vec3::Zero();    // the last one tried
  };
  void find_octaves();
  void draw(const Octave& octave);
  bool is_free(const Trial& trial, const SizeLevels& larger) const;
  std::pair<double, double> draw_guiding_centre(RandomStream& random) const;
  void try_another_position(Trial& trial) const;
  std::vector<Sphere> place(std::vector<Trial> trials, const SizeLevels& larger) const;
  std::vector<Trial> send_to_owners(std::vector<Trial> trials) const;
  bool still_overlaps(std::size_t k, const SizeLevels& levels) const;
  void redraw_overlapping(int round);

  const UniformRequest& request_;
  SphereSlabs slabs_;
  double crowd_volume_;
  std::vector<std::uint32_t> order_; // indices of request_.radii, by descending radius
  std::vector<Octave> octaves_;
  std::vector<Sphere> spheres_; // placed so far
};

} // namespace keeler::initial_conditions
