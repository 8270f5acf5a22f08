// A drift as a code would make it that takes paths within a step for straight lines: what the paper's Figure 1 warns
// of. It stands here to be measured against, and is no part of a run.
//
// Each particle follows the tangent of its epicycle from the start of the step, or from its last collision in the step.
// Contacts are found on these lines and carried out at their places; there the epicycle is begun anew, from that place
// and the new velocity. A particle without a collision stays on its epicycle. So a collision a time t after the start
// of its line displaces a particle by −a t²/2, a its acceleration, and nothing else is wrong: velocities are those of
// the epicycle.
#pragma once

#include <keeler/cells/grid.hpp>
#include <keeler/collision/events.hpp>
#include <keeler/collision/settings.hpp>
#include <keeler/hill/shearing_box.hpp>
#include <keeler/particles/store.hpp>

namespace keeler {

class StraightDrift {
public:
  /// `step` is the length h of a drift (rad).
  StraightDrift(const CollisionSettings& settings, const Frequencies& frequencies, double orbital_frequency,
                double step);

  /// Carries out the collisions in [−h/2, h/2) around the epoch of the elements, in the order of events.hpp; `offset`
  /// is the box's shear offset at the epoch. Returns their number. Throws InvariantError when a particle collides more
  /// than 100,000 times in the step.
  std::uint64_t collide(Particles& particles, const ShearingBox& box, double offset);

private:
  struct Line {
    Vec3 place, velocity;
    double since;
    Vec3 at(double time) const { return place + (time - since) * velocity; }
  };

  void prepare();
  void follow(std::size_t i, const State& state, double since);
  template<class Visit> void visit_candidates(std::size_t i, const Visit& visit) const;
  void predict(std::size_t i, std::size_t j, const Image& image);
  State image_state(const Image& image, double time) const;
  bool carry_out(const Event& event);

  CollisionSettings settings_;
  Frequencies frequencies_;
  double orbital_frequency_, step_;

  // the step at hand
  Particles* particles_ = nullptr;
  ShearingBox box_;
  double offset_ = 0.0;
  PeriodicGrid grid_;
  EventQueue events_;
  std::vector<Line> lines_;
  std::vector<Vec3> binned_; // mid-step places as the grid knows them
  std::vector<std::uint32_t> stamps_;
  double largest_radius_ = 0.0, largest_speed_ = 0.0, largest_stray_ = 0.0; // speeds beyond the shear
};

} // namespace keeler
