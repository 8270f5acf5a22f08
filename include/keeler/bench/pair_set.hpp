// The pairs that a step's grid hands to the finder before anything has collided, kept so that any finder can be asked
// about the very same pairs, in the same order, as often as wanted.
#pragma once

#include <keeler/collision/drift.hpp>

#include <vector>

namespace keeler {

class PairSet {
public:
  /// The pairs of the step that the drift phase would carry out on these particles; they are not changed.
  /// `every_candidate`: all that the grid's cells hold, else what the drift's own rejection leaves.
  static PairSet of(Particles particles, const ShearingBox& box, double offset, const CollisionSettings& settings,
                    const Frequencies& frequencies, double step, bool every_candidate);

  /// The step as finders see it; valid as long as this set stays where it is.
  DriftStep view() const;

  std::vector<Body> bodies;
  std::vector<Query> queries;

private:
  explicit PairSet(const DriftStep& step) : step_(step) {}
  DriftStep step_;
};

/// Processor time of one call, ns: the finder is asked about the whole set again and again for at least that long.
double ns_per_call(const PairSet& pairs, Finder& finder, double min_seconds);

/// A contact by dense scan: both particles on their own epicycles at 512 times of the span, the first approach that
/// crosses contact refined by bisection; a minimum between two times is looked for when the pair turns there.
/// No bound is used and nothing of the finders: the cross-check of their truth.
struct ScanResult {
  bool contact = false;
  double time = 0.0;
  double closest = 0.0; ///< the least |d| / R − 1 met while approaching
};
ScanResult dense_scan(const Pair& pair, const Frequencies& frequencies);

} // namespace keeler
