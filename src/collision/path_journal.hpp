// The journal of a distributed step: what distributed_drift.cpp needs to undo the step and to report paths.
#pragma once

#include "broad_phase.hpp"
#include "optimistic_loop.hpp"
#include "step_context.hpp"
#include "step_history.hpp"

#include <keeler/decomposition/ghost_layer.hpp>

#include <algorithm>
#include <cassert>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace keeler::collision {

/// The end of a particle's path and the begin of the next one. Spins of smooth particles are zero.
struct PathChange {
  std::uint32_t particle;
  double time; ///< of the end
  Elements before, after;
  Vec3 spin_before, spin_after;
};

/// What a distributed step notes of its changes: the state before it, to undo it; the paths of particles that two ranks
/// have; and whether an own particle has gone beyond the margin.
class PathJournal {
public:
  PathJournal(const StepContext& step, const StepHistory& history, const decomposition::GhostLayer& ghosts)
      : step_(step), history_(history), ghosts_(ghosts) {}

  /// Precondition: the change has not happened yet.
  void note_change(std::uint32_t i, double time, const Elements& after) {
    const Elements& before = step_.particles.bodies[i].elements;
    const Vec3 spin = step_.particles.rough ? step_.particles.spins[i] : Vec3::Zero();
    if (history_.event_count(i) == 0)
      beginnings_.push_back({i, before, spin});
    if (ghosts_.on_two_ranks(i))
      changes_.push_back({i, time, before, {}, spin, Vec3::Zero()});
    note_path(i, after);
  }

  /// Notes all changes of a step that was carried out in domains.
  void note_domains(const OptimisticLoop& domains, std::vector<std::uint32_t> dirty) {
    std::sort(dirty.begin(), dirty.end());
    dirty.erase(std::unique(dirty.begin(), dirty.end()), dirty.end());
    for (const std::uint32_t i : dirty) {
      const bool has_copies = ghosts_.on_two_ranks(i);
      const auto changes_before = static_cast<std::ptrdiff_t>(changes_.size());
      Beginning first{i, step_.particles.bodies[i].elements, Vec3::Zero()};
      domains.visit_changes(history_, i, [&](double time, const Elements& before, const Vec3& spin) { // last one first
        note_path(i, first.elements);
        if (has_copies)
          changes_.push_back({i, time, before, {}, spin, Vec3::Zero()});
        first.elements = before;
        first.spin = spin;
      });
      beginnings_.push_back(first);
      std::reverse(changes_.begin() + changes_before, changes_.end());
    }
  }

  /// Sorts the changes by particle and time when all contacts are carried out, and fills in what paths changed to.
  void complete() {
    std::stable_sort(changes_.begin(), changes_.end(), [](const PathChange& a, const PathChange& b) {
      return a.particle != b.particle ? a.particle < b.particle : a.time < b.time;
    });
    for (std::size_t k = 0; k < changes_.size(); ++k) {
      PathChange& change = changes_[k];
      const bool last = k + 1 == changes_.size() || changes_[k + 1].particle != change.particle;
      change.after = last ? step_.particles.bodies[change.particle].elements : changes_[k + 1].before;
      if (step_.particles.rough)
        change.spin_after = last ? step_.particles.spins[change.particle] : changes_[k + 1].spin_before;
    }
  }

  /// Restores all particles as at the start of the step. Precondition: `history` has begun the step again.
  void undo(BroadPhase& broad_phase) {
    for (const auto& [i, elements, spin] : beginnings_) {
      assert(history_.event_count(i) == 0);
      step_.particles.bodies[i].elements = elements;
      if (step_.particles.rough)
        step_.particles.spins[i] = spin;
      broad_phase.changed(i, step_.begin);
      step_.finder.changed(i);
    }
    beginnings_.clear();
    changes_.clear();
    has_strayed_ = false;
  }

  const std::vector<PathChange>& changes() const { return changes_; }
  /// Calls visit(particle) for each particle that was hit.
  template<class Visit> void visit_hit(const Visit& visit) const {
    for (const Beginning& beginning : beginnings_)
      visit(beginning.particle);
  }
  /// True if an own particle may have gone farther than the margin within which the ghosts suffice.
  bool has_strayed() const { return has_strayed_; }

private:
  struct Beginning {
    std::uint32_t particle;
    Elements elements;
    Vec3 spin;
  };

  void note_path(std::uint32_t i, const Elements& path) {
    has_strayed_ = has_strayed_ || (i < ghosts_.own && !ghosts_.within_margin(i, path));
  }

  const StepContext& step_;
  const StepHistory& history_;
  const decomposition::GhostLayer& ghosts_;
  std::vector<Beginning> beginnings_; // one per particle that was hit
  std::vector<PathChange> changes_;
  bool has_strayed_ = false;
};

} // namespace keeler::collision
