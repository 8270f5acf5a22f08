// What a finder did in a run, call by call, against the certified finder's answer to the same call.
#pragma once

#include <keeler/collision/drift.hpp>
#include <keeler/finders/counts.hpp>

#include <memory>
#include <vector>

namespace keeler {

/// Sums over the calls of a run. The truth of each call is the certified finder's.
struct FinderVerdict {
  FinderCounts counts;          ///< of the finder
  std::uint64_t true_hits = 0;  ///< calls that have a contact
  std::uint64_t missed = 0;     ///< it has a contact, the finder found none
  std::uint64_t false_hits = 0; ///< it has none, the finder called one; or called it more than 1e-6 R apart
  std::uint64_t late = 0;       ///< called after the spheres had been inside each other by more than 1e-6 R
  std::uint64_t misordered = 0; ///< particles whose first contact of a step, by the finder's times, is not the first
  double deepest = 0.0;         ///< how deep spheres were at most until their contact was called, in R

  std::uint64_t calls() const { return counts.total().count; }
  /// Calls that reported a contact.
  std::uint64_t hits() const { return counts.of(FinderExit::hit).count + counts.of(FinderExit::overlapping).count; }
};

class FinderAudit : public DriftObserver {
public:
  FinderAudit();

  bool wants_every_candidate() const override { return true; }

  void begins(const DriftStep& step) override;
  void searched(const Query& query, const FinderResult& result) override;
  void changed(std::size_t particle) override { certified_->changed(particle); }

  /// Everything up to the last step.
  FinderVerdict verdict();

private:
  struct First {
    double time = HUGE_VAL;
    Query with;
  };
  void count_misordered();
  void note_first(std::vector<First>& firsts, const Query& query, double time);

  std::unique_ptr<Finder> certified_;
  const DriftStep* step_ = nullptr;
  FinderVerdict verdict_;
  std::vector<First> found_, true_; // of each particle in this step, among contacts that both found
};

} // namespace keeler
