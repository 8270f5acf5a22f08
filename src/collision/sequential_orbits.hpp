// The OrbitStore of a loop that carries out all contacts of a step, in the particle store itself. For drift_engine.cpp
// and distributed_drift.cpp alone.
#pragma once

#include "broad_phase.hpp"
#include "candidate.hpp"
#include "contact_loop.hpp"
#include "step_history.hpp"
#include "step_outcome.hpp"

#include <span>
#include <vector>

namespace keeler::collision {

class SequentialOrbits {
public:
  SequentialOrbits(const StepContext& step, StepHistory& history, BroadPhase& broad_phase,
                   const ContactCounter& counter)
      : step_(step), history_(history), broad_phase_(broad_phase), counter_(counter) {}

  const Body& body(std::size_t i) const { return step_.particles.bodies[i]; }
  std::uint32_t event_count(std::size_t i) const { return history_.event_count(i); }
  double last_change(std::size_t i) const { return history_.last_change(i); }
  bool is_due(const Event& event) const { return history_.is_valid(event); }
  bool commit(const Event&) const { return true; }
  std::span<const std::uint32_t> reinstated() const { return {}; }

  void add(const Contact& contact) { is_counted_ = counter_.add(contact); }
  void add(const CollisionRecord& record) {
    if (step_.watcher)
      step_.watcher->collided(record);
    if (step_.record_taker && is_counted_)
      counter_.outcome.records.push_back(record);
  }

  void change(std::uint32_t i, const Elements& elements, double time) {
    if (event_count(i) == 0)
      counter_.outcome.dirty.push_back(i);
    history_.change(i, time);
    step_.particles.bodies[i].elements = elements;
    broad_phase_.changed(i, time);
    step_.finder.changed(i);
    if (step_.watcher)
      step_.watcher->changed(i);
  }
  void set_spin(std::uint32_t i, const Vec3& spin) { step_.particles.spins[i] = spin; }

  bool may_repredict(std::uint32_t i) const {
    return !step_.watcher && step_.finder.exact() && broad_phase_.has_many(i);
  }

  /// A watcher sees partners in the order of their ids and images.
  template<class Visit> void visit_partners(std::uint32_t i, double from, double until, const Visit& visit) {
    if (!step_.watcher)
      return broad_phase_.visit_partners(i, from, until, buffer_, visit);
    std::vector<Candidate> partners;
    broad_phase_.visit_partners(i, from, until, buffer_, [&](std::size_t j, const Image& image) {
      partners.push_back({i, static_cast<std::uint32_t>(j), image});
    });
    sort_by_ids(partners, step_.particles.ids);
    for (const Candidate& c : partners)
      visit(c.high, c.image);
  }

  void find_all(std::span<const finders::Query> queries, std::span<finders::FinderResult> results) const {
    step_.finder.find_all(queries, results);
    for (std::size_t k = 0; k < queries.size(); ++k) {
      if (step_.watcher)
        step_.watcher->searched(queries[k], results[k]);
      counter_.outcome.gave_up += results[k].exit == finders::FinderExit::gave_up && queries[k].low < counter_.own;
    }
  }

protected:
  const StepContext& step_;

private:
  StepHistory& history_;
  BroadPhase& broad_phase_;
  ContactCounter counter_;
  std::vector<std::uint32_t> buffer_; // of visit_partners()
  bool is_counted_ = true;            // the last contact
};

} // namespace keeler::collision
