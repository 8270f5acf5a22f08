// The orbits of a distributed step: every change is journaled, and in a repetition ghosts stay on the paths that their
// owners have reported. For distributed_drift.cpp alone.
#pragma once

#include "path_journal.hpp"
#include "sequential_orbits.hpp"

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <utility>
#include <vector>

namespace keeler::collision {

/// What an owner reports of a path: the ghost (numbered among all ghosts of a rank), when it changed, and to what.
struct PathReport {
  std::uint64_t ghost;
  double time;
  Elements elements;
  Vec3 spin;
};

inline bool same_bits(const Elements& a, const Elements& b) {
  return std::memcmp(&a, &b, sizeof a) == 0;
}

inline constexpr std::uint64_t after_all_ids = ~std::uint64_t{0}; // contacts at the same instant come first

class JournaledOrbits : public SequentialOrbits {
public:
  JournaledOrbits(const StepContext& step, StepHistory& history, BroadPhase& broad_phase, const ContactCounter& counter,
                  PathJournal& journal)
      : SequentialOrbits(step, history, broad_phase, counter), journal_(journal) {}

  void change(std::uint32_t i, const Elements& elements, double time) {
    journal_.note_change(i, time, elements);
    SequentialOrbits::change(i, elements, time);
  }

private:
  PathJournal& journal_;
};

/// Keeps ghosts on the paths that their owners have reported; other particles as JournaledOrbits.
class ReportedOrbits : public JournaledOrbits {
public:
  /// Precondition: reports are sorted by ghost and time.
  ReportedOrbits(JournaledOrbits orbits, std::size_t own, std::size_t ghosts, const std::vector<PathReport>& reports)
      : JournaledOrbits(std::move(orbits)), own_(own), reports_(reports), paths_(ghosts) {
    for (std::size_t k = 0; k < reports.size(); ++k) {
      Path& path = paths_[reports[k].ghost];
      if (path.end == 0)
        path.next = k;
      path.end = k + 1;
    }
  }

  /// Returns the event at which a reported change happens: one that follows all contacts of its instant.
  Event event_of(std::size_t report) const {
    const auto i = static_cast<std::uint32_t>(own_ + reports_[report].ghost);
    return {reports_[report].time, after_all_ids, report, {}, i, i, static_cast<std::uint32_t>(report), 0};
  }

  bool is_due(const Event& event) {
    if (event.low_id == after_all_ids)
      return take_report(event);
    return SequentialOrbits::is_due(event) && !(is_reported(event.low) && is_reported(event.high));
  }

  void change(std::uint32_t i, const Elements& elements, double time) {
    if (is_reported(i)) {
      Path& path = paths_[i - own_];
      const bool confirmed =
          path.next < path.end && reports_[path.next].time == time && same_bits(reports_[path.next].elements, elements);
      if (confirmed)
        ++path.next;
      else
        path.is_reported = false;
    }
    JournaledOrbits::change(i, elements, time);
  }

  bool may_repredict(std::uint32_t) const { return false; }

private:
  struct Path {
    std::size_t next = 0, end = 0; // reports still to come
    bool is_reported = true;       // until a contact that its owner has not reported
  };

  bool is_reported(std::uint32_t i) const { return i >= own_ && paths_[i - own_].is_reported; }

  // Makes a reported change, unless the contact that caused it has been carried out here.
  bool take_report(const Event& event) {
    Path& path = paths_[event.low - own_];
    if (!path.is_reported || path.next != event.low_count)
      return false;
    const PathReport& report = reports_[path.next++];
    JournaledOrbits::change(event.low, report.elements, report.time);
    if (step_.particles.rough)
      set_spin(event.low, report.spin);
    return true;
  }

  std::size_t own_;
  const std::vector<PathReport>& reports_;
  std::vector<Path> paths_; // of each ghost
};

} // namespace keeler::collision
