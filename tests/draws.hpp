// How many random cases a test draws.
#pragma once

#include <algorithm>
#include <cstdint>

namespace keeler::test {

/// As many as the test says; a sixth of them where a sanitizer watches every access, which it does in the first ones as
/// well as in the last, ten times as slowly.
constexpr std::uint64_t draws(std::uint64_t number) {
#ifdef KEELER_SANITIZED
  return std::max<std::uint64_t>(1, number / 6);
#else
  return number;
#endif
}

} // namespace keeler::test
