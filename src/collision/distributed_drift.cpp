// A step that ranks share: a distributed step. Its result is the one history of all particles that the order of events
// defines; each rank computes the part of its own particles.
//
// Attempt: each rank carries out all contacts of its own particles and of its ghosts, as if there were no others.
// Ghosts near the outer border lack partners, so their paths may be wrong, and so may paths of particles that touch
// them. But a particle has few contacts in a step, and the far ghosts are there for this: nearly always the paths of
// own particles and of near ghosts are right. Each owner reports the paths of all ghosts of its particles, which tells.
//
// Repetition: where the path of a near ghost differs from its owner's report, the step is undone and repeated with each
// ghost on the path that its owner reported, until no owner has anything new to report (waveform relaxation with
// overlap: Lelarasmee, Ruehli & Sangiovanni-Vincentelli 1982; Gander & Stuart 1998). A ghost leaves that path at a
// contact that its owner has not reported.
//
// Termination and correctness: let all reported paths be right before some time, and let the next contact of the true
// history come then. Its particles are on each other's ranks, as own ones or as near ghosts, and both are on their
// right paths. So every rank that owns one of them finds that contact, with the same numbers, and reports it: each
// repetition makes at least one more contact right. When nothing new is reported and no near ghost differs, each rank
// has found every contact of its own particles on paths that their owners confirm, which is the true history. (Within
// the margins, which are checked last: the first contact that leads beyond them is right too, so that is seen.)
#include "drift_audit.hpp"
#include "drift_engine.hpp"
#include "path_journal.hpp"
#include "reported_orbits.hpp"

#include <keeler/core/stopwatch.hpp>

#include <algorithm>
#include <cassert>
#include <cstring>
#include <exception>
#include <tuple>
#include <utility>

namespace keeler::collision {
namespace {

template<class Row> std::vector<Row> rows_of(const std::vector<std::byte>& bytes) {
  assert(bytes.size() % sizeof(Row) == 0);
  std::vector<Row> rows(bytes.size() / sizeof(Row));
  if (!rows.empty())
    std::memcpy(static_cast<void*>(rows.data()), bytes.data(), bytes.size());
  return rows;
}

template<class Row> std::vector<std::byte> packed(const std::vector<Row>& rows) {
  const auto bytes = std::as_bytes(std::span(rows));
  return {bytes.begin(), bytes.end()};
}

/// One step on all ranks: attempts, and the reports between them.
class DistributedStep {
public:
  DistributedStep(const StepContext& step, StepHistory& history, BroadPhase& broad_phase, StepOutcome& outcome,
                  DriftCosts& costs, decomposition::GhostLayer& ghosts, const Communicator& ranks)
      : step_(step), history_(history), broad_phase_(broad_phase), outcome_(outcome), costs_(costs), ghosts_(ghosts),
        ranks_(ranks), journal_(step, history, ghosts), gave_up_first_(outcome.gave_up) {}

  /// Carries out all contacts by work(counter) and journals them. Keeps the exception of a broken invariant, since the
  /// history may be wrong.
  template<class Work> void attempt(const Work& work) {
    tally_ = {};
    failure_ = nullptr;
    try {
      work(ContactCounter{outcome_, tally_, costs_, ghosts_.own});
    } catch (const InvariantError&) {
      failure_ = std::current_exception();
    }
    journal_.complete();
  }

  /// Returns the orbits for work(counter).
  JournaledOrbits orbits(const ContactCounter& counter) {
    return JournaledOrbits(step_, history_, broad_phase_, counter, journal_);
  }
  /// Notes a step that was carried out in domains.
  void note(OptimisticLoop& domains) {
    domains_ = &domains;
    journal_.note_domains(domains, outcome_.dirty);
  }

  /// Exchanges reports of all ghosts' paths. Returns true if anything is new to one of the ranks.
  bool exchange_reports() {
    comm::Parcels reports(ranks_.size());
    for (const std::size_t rank : ghosts_.partners)
      reports[rank] = packed(reports_of(ghosts_.sent[rank]));
    const bool is_new = ranks_.any(reports != sent_);
    sent_ = std::move(reports);
    const comm::Parcels from = ranks_.exchange(sent_, ghosts_.partners);
    received_.clear();
    for (const std::size_t rank : ghosts_.partners)
      for (PathReport report : rows_of<PathReport>(from[rank])) {
        report.ghost += ghosts_.first[rank] - ghosts_.own;
        assert(report.ghost < ghosts_.near.size());
        received_.push_back(report);
      }
    return is_new;
  }

  /// True on each rank if no rank needs a repetition.
  bool is_right() const { return !ranks_.any(!near_ghosts_agree()); }
  bool must_repeat() const { return ranks_.any(!near_ghosts_agree() || failure_); }
  /// True if the own particles of all ranks have stayed within the margins of the ghosts.
  bool within_margins() const { return !ranks_.any(journal_.has_strayed()); }

  /// Repeats the step with the ghosts on reported paths until nothing new is reported.
  void repeat(const std::vector<Event>& first, EventQueue& events) {
    const Stopwatch stopwatch(costs_.events);
    ++costs_.repeated_steps;
    do {
      ++costs_.repeated_rounds;
      undo();
      attempt([&](const ContactCounter& counter) { follow_reports(first, events, counter); });
    } while (exchange_reports());
  }

  /// Restores everything as at the start of the step.
  void undo() {
    history_.begin_step(step_.particles.size(), step_.begin);
    if (domains_)
      std::exchange(domains_, nullptr)->undo(step_, history_, broad_phase_.lists());
    journal_.undo(broad_phase_);
    outcome_.clear_contacts();
    outcome_.gave_up = gave_up_first_;
  }

  /// Adds what the step did on all ranks. Throws on all ranks if the step failed on one.
  void finish(CollisionTally& tally) {
    ranks_.together([&] {
      if (failure_)
        std::rethrow_exception(failure_);
    });
    if (step_.record_taker)
      gather_records();
    ranks_.merge({&outcome_.energy_lost, &outcome_.momentum_flux, &outcome_.azimuthal_gain, &outcome_.kick_work});
    std::uint64_t counts[] = {tally_.fast, tally_.slow, tally_.unresolved, outcome_.gave_up};
    ranks_.sum(counts);
    outcome_.gave_up = counts[3];
    outcome_.add_sums_to(tally);
    tally.fast += counts[0];
    tally.slow += counts[1];
    tally.unresolved += counts[2];
    ++ghosts_.steps;
    for (std::size_t i = 0; i < ghosts_.own; ++i)
      ghosts_.contacts[i] =
          static_cast<std::uint16_t>(std::min<std::uint32_t>(0xffff, ghosts_.contacts[i] + history_.event_count(i)));
  }

private:
  static PathReport report_of(std::uint64_t ghost, const PathChange& change) {
    return {ghost, change.time, change.elements, change.spin};
  }

  // Returns the reports of own particles that another rank has as ghosts, `lent` in ascending order.
  std::vector<PathReport> reports_of(const std::vector<std::uint32_t>& lent) const {
    assert(std::is_sorted(lent.begin(), lent.end()));
    std::vector<PathReport> rows;
    std::size_t number = 0;
    for (const PathChange& change : journal_.changes()) { // by particle
      while (number < lent.size() && lent[number] < change.particle)
        ++number;
      if (number == lent.size())
        break;
      if (lent[number] == change.particle)
        rows.push_back(report_of(number, change));
    }
    return rows;
  }

  // True if each near ghost went here as its owner reports.
  bool near_ghosts_agree() const {
    const auto is_near = [&](const PathReport& report) { return ghosts_.near[report.ghost]; };
    auto theirs = std::find_if(received_.begin(), received_.end(), is_near);
    for (const PathChange& change : journal_.changes()) { // by particle, as theirs
      if (change.particle < ghosts_.own)
        continue;
      const PathReport here = report_of(change.particle - ghosts_.own, change);
      if (!is_near(here))
        continue;
      if (theirs == received_.end() || std::memcmp(&*theirs, &here, sizeof here) != 0)
        return false;
      theirs = std::find_if(theirs + 1, received_.end(), is_near);
    }
    return theirs == received_.end();
  }

  void follow_reports(const std::vector<Event>& first, EventQueue& events, const ContactCounter& counter) {
    ReportedOrbits followed(orbits(counter), ghosts_.own, ghosts_.near.size(), received_);
    std::vector<Event> all = first;
    for (std::size_t k = 0; k < received_.size(); ++k)
      all.push_back(followed.event_of(k));
    events.assign(all);
    ContactLoop loop(step_, followed, events);
    loop.run();
  }

  // Sends all records to the root, in the order of events.
  void gather_records() {
    std::vector<CollisionRecord>& records = outcome_.records;
    std::vector<std::vector<CollisionRecord>> sent(ranks_.size());
    sent[0] = std::exchange(records, {});
    for (const std::vector<CollisionRecord>& some : ranks_.exchange(sent))
      records.insert(records.end(), some.begin(), some.end());
    const auto key = [](const CollisionRecord& r) {
      return std::tuple(r.time, r.low_id, r.high_id, r.image.nx, r.image.ny);
    };
    std::sort(records.begin(), records.end(),
              [&](const CollisionRecord& a, const CollisionRecord& b) { return key(a) < key(b); });
  }

  const StepContext& step_;
  StepHistory& history_;
  BroadPhase& broad_phase_;
  StepOutcome& outcome_;
  DriftCosts& costs_;
  decomposition::GhostLayer& ghosts_;
  const Communicator& ranks_;
  PathJournal journal_;
  OptimisticLoop* domains_ = nullptr; // that have carried out the present attempt
  std::uint64_t gave_up_first_;       // of the searches before the first contact
  comm::Parcels sent_;                // reports, to each rank
  std::vector<PathReport> received_;  // of the ghosts, in their order
  CollisionTally tally_;              // of the last attempt
  std::exception_ptr failure_;        // in it
};

} // namespace

bool DriftEngine::collide_distributed(Particles& particles, decomposition::GhostLayer& ghosts,
                                      const Communicator& ranks, const ShearingBox& box, double offset,
                                      CollisionTally& tally, const KickInterval& gravity) {
  assert(!(observer_ && observer_->wants_events()));
  assert(ghosts.own <= particles.size() && ghosts.own + ghosts.near.size() == particles.size());
  const StepContext step = context_of(particles, box, offset, gravity);
  std::vector<Event> first;
  broad_phase_.lists().set_folds(ghosts.folds);
  ranks.together([&] {
    begin_step(step, false);
    if (audit_)
      audit_begin(*audit_, step, finder_step_.straight_line, candidates_);
    first = solve(step, ghosts.own);
  });
  DistributedStep distributed(step, history_, broad_phase_, outcome_, costs_, ghosts, ranks);
  distributed.attempt([&](const ContactCounter& counter) {
    const Stopwatch stopwatch(costs_.events);
    if (carry_out_in_domains(step, first, counter)) {
      distributed.note(optimistic_);
    } else {
      JournaledOrbits orbits = distributed.orbits(counter);
      carry_out_in_sequence(step, first, orbits);
    }
  });
  distributed.exchange_reports();
  if (distributed.must_repeat())
    distributed.repeat(first, events_);
  // of two contacts at the very same instant the repetitions may not find which comes first: then each rank needs
  // ghosts of all particles
  const bool done = distributed.is_right() && distributed.within_margins();
  if (done && audit_)
    audit_end(*audit_, step, finder_step_.straight_line, broad_phase_, history_, outcome_.dirty);
  if (done)
    distributed.finish(tally);
  else
    distributed.undo();
  end_step(step);
  return done;
}

} // namespace keeler::collision
