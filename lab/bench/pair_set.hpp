// The pairs that a step passes to its finder before the first collision, recorded so that different finders can be
// timed on identical queries in identical order.
#pragma once

#include <keeler/collision/drift.hpp>
#include <keeler/finders/finder.hpp>

#include <vector>

namespace keeler::bench {

class PairSet {
public:
  /// Records the pairs of a drift phase on a copy of these particles: all candidate pairs of the grid with
  /// `every_candidate`, otherwise the pairs that remain after the drift's rejection. `step` is the length of the drift
  /// (rad), `offset` the box's shear offset at mid-step.
  static PairSet of(Particles particles, const ShearingBox& box, double offset,
                    const collision::CollisionSettings& settings, const Frequencies& frequencies, double step,
                    bool every_candidate);

  /// Returns the step for a finder. It refers to `bodies`, and is valid while this set lives and is not moved.
  finders::DriftStep view() const;

  std::vector<Body> bodies;
  std::vector<finders::Query> queries;

private:
  explicit PairSet(const finders::DriftStep& step) : step_(step) {}
  finders::DriftStep step_;
};

/// Returns the processor time per call, ns. Repeats the queries of the whole set for at least `min_seconds`; 0 without
/// queries. Precondition: `min_seconds` > 0.
double ns_per_call(const PairSet& pairs, finders::Finder& finder, double min_seconds);

/// A contact by dense scan, the independent check of the certified finder: it uses no bounds and no code of the
/// finders. It evaluates both epicycles at 512 times and refines the first crossing of contact by bisection; where the
/// distance has a minimum between two times, it bisects for the minimum.
struct ScanResult {
  bool contact = false;
  double time = 0.0;
  double closest = 0.0; ///< smallest |d| / R − 1 found while approaching
};
ScanResult dense_scan(const finders::Pair& pair, const Frequencies& frequencies);

} // namespace keeler::bench
