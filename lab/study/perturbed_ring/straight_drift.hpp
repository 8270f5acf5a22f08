// The drift of a code with straight paths within a step, against which the paper's Figure 1 warns. The study measures
// it; no run uses it.
//
// Each particle follows the tangent of its epicycle from the start of the step, or from its last collision in the step.
// Contacts are found on these lines and resolved at the positions there; the new epicycle begins at this position with
// the new velocity. A particle without a collision stays on its epicycle. A collision at time t after the start of a
// line therefore displaces a particle of acceleration a by −a t²/2. This is the only error: velocities are taken from
// the epicycle.
#pragma once

#include <keeler/cells/grid.hpp>
#include <keeler/collision/events.hpp>
#include <keeler/collision/settings.hpp>
#include <keeler/hill/shearing_box.hpp>
#include <keeler/particles/store.hpp>

namespace keeler::study {

class StraightDrift {
public:
  /// `step` is the length h of a drift (rad). Precondition: h > 0.
  StraightDrift(const collision::CollisionSettings& settings, const Frequencies& frequencies, double orbital_frequency,
                double step);

  /// Carries out the collisions in [−h/2, h/2) around the epoch of the elements, in the order of events.hpp, and
  /// returns their number. `offset` is the box's shear offset at the epoch. Throws InvariantError when a particle
  /// collides more than 100,000 times in the step.
  std::uint64_t collide(Particles& particles, const ShearingBox& box, double offset);

private:
  struct Line {
    Vec3 position, velocity; // at `since`
    double since;
    Vec3 at(double time) const { return position + (time - since) * velocity; }
  };

  void prepare();
  void follow(std::size_t i, const State& state, double since);
  template<class Visit> void visit_candidates(std::size_t i, const Visit& visit) const;
  void predict(std::size_t i, std::size_t j, const Image& image);
  State image_state(const Image& image, double time) const;
  bool carry_out(const collision::Event& event);

  collision::CollisionSettings settings_;
  Frequencies frequencies_;
  double orbital_frequency_, step_;

  // state of the current step
  Particles* particles_ = nullptr;
  ShearingBox box_;
  double offset_ = 0.0;
  cells::PeriodicGrid grid_;
  collision::EventQueue events_;
  std::vector<Line> lines_;
  std::vector<Vec3> binned_; // mid-step positions in the grid
  std::vector<std::uint32_t> event_counts_;
  double largest_radius_ = 0.0, largest_speed_ = 0.0, largest_stray_ = 0.0; // peculiar speed; distance from binned_
};

} // namespace keeler::study
