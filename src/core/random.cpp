#include <keeler/core/random.hpp>

#include <keeler/core/units.hpp>

#include <cmath>

#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wpragmas"
#pragma GCC diagnostic ignored "-Wconversion"
#pragma GCC diagnostic ignored "-Wpedantic"
#pragma GCC diagnostic ignored "-Wunused-parameter"
#include <Random123/philox.h>
#pragma GCC diagnostic pop

namespace keeler {

RandomStream::RandomStream(std::uint64_t seed, RandomPurpose purpose, std::uint64_t id)
    : key_{seed, static_cast<std::uint64_t>(purpose)}, id_(id) {}

std::uint64_t RandomStream::next() {
  if (used_ == 4) {
    const r123::Philox4x64 philox;
    const r123::Philox4x64::ctr_type counter = {{block_++, id_, 0, 0}};
    const r123::Philox4x64::key_type key = {{key_[0], key_[1]}};
    const r123::Philox4x64::ctr_type block = philox(counter, key);
    for (int k = 0; k < 4; ++k)
      buffer_[k] = block[k];
    used_ = 0;
  }
  return buffer_[used_++];
}

double RandomStream::uniform() {
  return (static_cast<double>(next() >> 12) + 0.5) * 0x1p-52;
}

double RandomStream::normal() {
  if (has_spare_) {
    has_spare_ = false;
    return spare_normal_;
  }
  const double length = std::sqrt(-2.0 * std::log(uniform()));
  const double angle = two_pi * uniform();
  spare_normal_ = length * std::sin(angle);
  has_spare_ = true;
  return length * std::cos(angle);
}

} // namespace keeler
