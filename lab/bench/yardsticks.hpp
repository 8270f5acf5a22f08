// Upper limits of this machine's speed, for comparison with a bench's times; and the clocks of benches.
#pragma once

#include <keeler/particles/store.hpp>

#include <vector>

namespace keeler::bench {

/// Returns processor time when threads() is 1, otherwise wall time; s since an arbitrary origin.
double bench_seconds();
/// Returns wall time, s since an arbitrary origin.
double wall_seconds();

/// Reads and writes an array of lines of 64 bytes in order, on all threads.
class MemoryYardstick {
public:
  explicit MemoryYardstick(std::size_t count) : lines_(count) {}

  /// Returns the time per line, ns. Precondition: the array is not empty.
  double measure();

private:
  std::vector<Body> lines_;
};

/// Evaluates |d|² and d·v of pairs from their elements, at one common time, on all threads, in portable double
/// precision; all data stay in the fastest cache. Returns the time per pair, ns.
double pair_yardstick(double (*clock)() = bench_seconds);

} // namespace keeler::bench
