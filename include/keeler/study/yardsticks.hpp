// What this machine can do at best, to hold a bench's times against; and the clock of benches.
#pragma once

#include <keeler/particles/store.hpp>

#include <vector>

namespace keeler {

/// Processor time on one thread, wall time on several, s since some moment.
double bench_seconds();
double wall_seconds();

/// Reads and writes back an array of lines of 64 bytes, in order, all threads together.
class MemoryYardstick {
public:
  explicit MemoryYardstick(std::size_t count) : lines_(count) {}

  /// For one line, ns.
  double measure();

private:
  std::vector<Body> lines_;
};

/// Evaluates |d|² and d·v of a pair from the elements of both, at one time for all pairs, on all threads, in portable
/// double precision; everything stays in the fastest cache. For one pair, ns.
double pair_yardstick(double (*clock)() = bench_seconds);

} // namespace keeler
