// Compares every answer of a run's finder with the certified finder's answer to the same query.
#pragma once

#include <keeler/collision/drift.hpp>
#include <keeler/finders/counts.hpp>
#include <keeler/finders/finder.hpp>

#include <memory>
#include <vector>

namespace keeler::study {

/// Sums over the calls of a run. The certified finder's answer to a call counts as true.
struct FinderVerdict {
  finders::FinderCounts counts; ///< calls, iterations and evaluations of the audited finder
  std::uint64_t true_hits = 0;  ///< calls with a contact
  std::uint64_t missed = 0;     ///< there is a contact, the finder reported none
  std::uint64_t false_hits = 0; ///< reported without a contact, or while the surfaces are more than 1e-6 R apart
  std::uint64_t late = 0;       ///< reported after the spheres had overlapped by more than 1e-6 R
  std::uint64_t misordered = 0; ///< particles with a wrong first contact in a step, by the finder's times
  double deepest = 0.0;         ///< largest overlap before a contact was reported, in R

  std::uint64_t calls() const { return counts.total().count; }
  /// Calls that reported a contact.
  std::uint64_t hits() const {
    return counts.of(finders::FinderExit::hit).count + counts.of(finders::FinderExit::overlapping).count;
  }
};

/// Observes a drift and audits each of its finder's calls.
class FinderAudit : public collision::DriftObserver {
public:
  FinderAudit();

  bool wants_every_candidate() const override { return true; }

  void begins(const finders::DriftStep& step) override; ///< `step` must live until the next call or the last verdict()
  /// Precondition: begins() was called.
  void searched(const finders::Query& query, const finders::FinderResult& result) override;
  void changed(std::size_t particle) override { certified_->changed(particle); }

  /// Returns the sums up to and including the last step.
  FinderVerdict verdict();

private:
  struct First {
    double time = HUGE_VAL;
    finders::Query with;
  };
  void count_misordered();
  void note_first(std::vector<First>& firsts, const finders::Query& query, double time);

  std::unique_ptr<finders::Finder> certified_;
  const finders::DriftStep* step_ = nullptr;
  FinderVerdict verdict_;
  std::vector<First> found_, true_; // per particle in this step, of the contacts that both finders found
};

} // namespace keeler::study
