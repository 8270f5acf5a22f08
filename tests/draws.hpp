// What tests do less of where a sanitizer watches every access.
#pragma once

#include <algorithm>
#include <cstdint>

namespace keeler::test {

/// Whether a sanitizer watches. It does in the first cases as well as in the last, ten times as slowly: of what only
/// repeats the same code, for the sake of its numbers, it needs no more.
#ifdef KEELER_SANITIZED
inline constexpr bool sanitized = true;
#else
inline constexpr bool sanitized = false;
#endif

/// How many random cases a test draws: as many as it says, a sixth of them where a sanitizer watches.
constexpr std::uint64_t draws(std::uint64_t number) {
  return sanitized ? std::max<std::uint64_t>(1, number / 6) : number;
}

} // namespace keeler::test
