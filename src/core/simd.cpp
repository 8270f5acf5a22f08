#include <keeler/core/simd.hpp>

#include <keeler/core/error.hpp>

#include <cstdlib>
#include <string>

namespace keeler {
namespace {

constexpr InstructionSet widest_first[] = {InstructionSet::avx512, InstructionSet::avx2, InstructionSet::portable};

} // namespace

const char* instruction_set_name(InstructionSet set) {
  switch (set) {
  case InstructionSet::avx512:
    return "avx512";
  case InstructionSet::avx2:
    return "avx2";
  case InstructionSet::portable:
    break;
  }
  return "portable";
}

bool supports([[maybe_unused]] InstructionSet set) {
#if defined(__x86_64__)
  if (set == InstructionSet::avx512)
    return __builtin_cpu_supports("avx512f");
  if (set == InstructionSet::avx2)
    return __builtin_cpu_supports("avx2");
#endif
  return set == InstructionSet::portable;
}

InstructionSet choose_instruction_set() {
  const char* variable = std::getenv("KEELER_SIMD");
  const std::string wanted = variable ? variable : "";
  for (const InstructionSet set : widest_first) {
    if (wanted.empty() ? supports(set) : wanted == instruction_set_name(set)) {
      if (!supports(set))
        throw UsageError("KEELER_SIMD=" + wanted + ": this processor does not support these instructions; unset it");
      return set;
    }
  }
  throw UsageError("KEELER_SIMD=" + wanted +
                   " is not a known instruction set; use portable, avx2 or avx512, or unset it");
}

} // namespace keeler
