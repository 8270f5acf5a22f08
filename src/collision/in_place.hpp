// The orbits of a loop that has all contacts of the step. For drift_engine.cpp and distributed_drift.cpp alone.
#pragma once

#include "drift_engine.hpp"

#include <span>
#include <vector>

namespace keeler {

// In the store itself.
struct DriftEngine::InPlace {
  DriftEngine& drift;
  CollisionTally& tally;

  const Body& body(std::size_t i) const { return drift.particles_->bodies[i]; }
  std::uint32_t stamp(std::size_t i) const { return drift.so_far_.stamp(i); }
  double last_change(std::size_t i) const { return drift.so_far_.last_change(i); }
  bool is_due(const Event& event) const { return drift.so_far_.holds(event); }
  bool keeps(const Event&) const { return true; }
  std::span<const std::uint32_t> to_search_again() const { return {}; }

  void change(std::uint32_t i, const Elements& elements, double time) {
    if (stamp(i) == 0)
      drift.touched_.push_back(i);
    if constexpr (Communicator::possible)
      if (drift.borders_)
        drift.note_change(i, time, elements);
    drift.so_far_.change(i, time);
    drift.particles_->bodies[i].elements = elements;
    if (drift.through_grid_)
      drift.grid_.changed(i);
    else if (!drift.lists_.reaches_far() && !drift.lists_.changed(i, time))
      rebuild_list(i);
    drift.finder().changed(i);
    if (drift.watch_)
      drift.watch_->changed(i);
  }

  void set_spin(std::uint32_t i, const Vec3& spin) { drift.particles_->spins[i] = spin; }

  void rebuild_list(std::uint32_t i) {
    drift.lists_.rebuild_list(i);
    if (drift.lists_.reaches_far())
      drift.lists_.rebuild_for_step();
  }

  // Who watches sees partners in the order of their ids and images.
  bool may_look_again(std::uint32_t i) const {
    return !drift.through_grid_ && !drift.watch_ && drift.finder().exact() && drift.lists_.has_many(i);
  }

  template<class Visit> void visit_partners(std::uint32_t i, double from, double until, const Visit& visit) {
    if (!drift.watch_)
      return visit_unordered(i, from, until, visit);
    std::vector<Candidate> partners;
    visit_unordered(i, from, until, [&](std::size_t j, const Image& image) {
      partners.push_back({i, static_cast<std::uint32_t>(j), image});
    });
    drift.put_in_order(partners);
    for (const Candidate& c : partners)
      visit(c.high, c.image);
  }

  template<class Visit> void visit_unordered(std::uint32_t i, double from, double until, const Visit& visit) {
    if (drift.through_grid_)
      drift.grid_.visit_partners(i, from, visit);
    else if (drift.lists_.reaches_far())
      drift.lists_.visit_everywhere(i, from, visit);
    else
      drift.lists_.visit_partners(i, from, until, buffer, visit);
  }

  void prefetch_partner(std::size_t i) const { drift.so_far_.prefetch(i); }
  void prefetch(std::size_t i, int stage) const {
    if (stage == 0)
      drift.so_far_.prefetch(i);
    if (!drift.through_grid_)
      drift.lists_.prefetch(i, stage);
  }

  void find_all(std::span<const Query> queries, std::span<FinderResult> results) const {
    drift.finder().find_all(queries, results);
    for (std::size_t k = 0; k < queries.size(); ++k) {
      if (drift.watch_)
        drift.watch_->searched(queries[k], results[k]);
      drift.gave_up_ += results[k].exit == FinderExit::gave_up;
    }
  }

  void happened(const Contact& contact) { is_counted = drift.count(contact, tally); }
  void record(const CollisionRecord& record) {
    if (drift.watch_)
      drift.watch_->collided(record);
    if (drift.takes_records_ && is_counted)
      drift.records_.push_back(record);
  }

  std::vector<std::uint32_t> buffer{};
  bool is_counted = true; // the last contact
};

} // namespace keeler
