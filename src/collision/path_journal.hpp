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
#include <span>
#include <vector>

namespace keeler::collision {

/// The end of a particle's path, and what it changed to. Spins of smooth particles are zero.
struct PathChange {
  std::uint32_t particle;
  double time;
  Elements elements; ///< after the change; until PathJournal::complete(), before it
  Vec3 spin;         ///< likewise
};

/// What a distributed step notes of its changes: the state before it, to undo it where domains do not; the paths of
/// particles that two ranks have; and whether an own particle has gone beyond the margin.
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
      changes_.push_back({i, time, before, spin});
    note_path(i, after);
  }

  /// Notes all changes of a step that was carried out in domains, which can undo it themselves. `dirty`: all particles
  /// that were hit.
  void note_domains(const OptimisticLoop& domains, std::span<const std::uint32_t> dirty) {
    domains.visit_all_changes([&](const Change& change) {
      if (change.earlier) // the path began in this step
        note_path(change.particle, change.ended);
    });
    std::vector<std::uint32_t> with_copies;
    for (const std::uint32_t i : dirty) {
      note_path(i, step_.particles.bodies[i].elements);
      if (ghosts_.on_two_ranks(i))
        with_copies.push_back(i);
    }
    std::sort(with_copies.begin(), with_copies.end());
    with_copies.erase(std::unique(with_copies.begin(), with_copies.end()), with_copies.end());
    changes_.reserve(changes_.size() + 2 * with_copies.size()); // nearly all are hit once or twice
    for (const std::uint32_t i : with_copies) {
      const auto changes_before = static_cast<std::ptrdiff_t>(changes_.size());
      domains.visit_changes(history_, i, [&](double time, const Elements& before, const Vec3& spin) { // last one first
        changes_.push_back({i, time, before, spin});
      });
      std::reverse(changes_.begin() + changes_before, changes_.end());
    }
  }

  /// Sorts the changes by particle and time when all contacts are carried out, and fills in what paths changed to.
  void complete() {
    const auto comes_first = [](const PathChange& a, const PathChange& b) {
      return a.particle != b.particle ? a.particle < b.particle : a.time < b.time;
    };
    if (!std::is_sorted(changes_.begin(), changes_.end(), comes_first)) // as domains have left them
      std::stable_sort(changes_.begin(), changes_.end(), comes_first);
    for (std::size_t k = 0; k < changes_.size(); ++k) {
      PathChange& change = changes_[k];
      const bool last = k + 1 == changes_.size() || changes_[k + 1].particle != change.particle;
      change.elements = last ? step_.particles.bodies[change.particle].elements : changes_[k + 1].elements;
      if (step_.particles.rough)
        change.spin = last ? step_.particles.spins[change.particle] : changes_[k + 1].spin;
    }
  }

  /// Restores all particles that note_change() noted as at the start of the step, and forgets the step. Precondition:
  /// the history has begun it again.
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
  std::vector<Beginning> beginnings_; // one per particle that note_change() noted
  std::vector<PathChange> changes_;
  bool has_strayed_ = false;
};

} // namespace keeler::collision
