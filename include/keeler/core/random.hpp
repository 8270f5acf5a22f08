// Counter-based random numbers: a stream is named by (seed, purpose, id) and holds no shared state, so the numbers are
// the same for any number of threads and nothing has to be saved for a restart.
#pragma once

#include <array>
#include <cstdint>

namespace keeler {

/// What a stream is for; streams of different purposes are independent. Never renumber: that changes every state.
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
  shuffle = 10
};

/// Philox4x64-10 (Salmon et al. 2011) keyed by seed and purpose, counting draws of one id.
class RandomStream {
public:
  RandomStream(std::uint64_t seed, RandomPurpose purpose, std::uint64_t id);

  /// Uniform in (0, 1), 53 bits, never 0 or 1.
  double uniform();

  /// Normal with mean 0 and variance 1 (Box and Muller 1958).
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
