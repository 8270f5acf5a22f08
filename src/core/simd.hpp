// Instruction sets for which the kernels are compiled, and the choice among them when the program starts.
// The choice does not change any bit of a result.
#pragma once

namespace keeler {

enum class InstructionSet { portable, avx2, avx512 };

const char* instruction_set_name(InstructionSet set);

/// True if this build has kernels for the set and this processor can run them.
bool supports(InstructionSet set);

/// Returns the widest supported set, or the one in the environment variable KEELER_SIMD (portable, avx2 or avx512).
/// Throws UsageError if that is unknown or not supported.
InstructionSet choose_instruction_set();

} // namespace keeler
