// Counter-based random numbers: a stream is identified by (seed, purpose, id) and has no shared state, so the numbers
// do not depend on the number of threads, and a restart needs no saved state.
#pragma once

#include <array>
#include <cstdint>

namespace keeler {

/// Purpose of a stream; streams of different purposes are independent. Never renumber: all states would change.
enum class RandomPurpose : std::uint32_t {
  position = 1,
  velocity = 2,
  size = 3,
  relaxation = 4,
  gravity_origin = 5,
  sample = 6,
  contact = 7,
  thinning = 8,
  aggregate = 9,
  shuffle = 10,
  light = 11
};

/// Philox4x64-10 (Salmon et al. 2011) with seed and purpose as key, and the id and a draw counter as counter.
class RandomStream {
public:
  RandomStream(std::uint64_t seed, RandomPurpose purpose, std::uint64_t id);

  /// Draws a uniform number in (0, 1), never 0 or 1.
  double uniform();

  /// Draws a normal number of mean 0 and variance 1 (Box and Muller 1958).
  double normal();

private:
  std::uint64_t next();

  std::array<std::uint64_t, 2> key_;
  std::uint64_t id_;
  std::uint64_t block_ = 0;
  std::array<std::uint64_t, 4> buffer_{};
  int used_ = 4;
  double spare_normal_ = 0.0;
  bool has_spare_ = false;
};

} // namespace keeler
