// Instruction sets that the kernels are compiled for, and the choice among them when the program starts.
// The choice never changes a bit of a result.
#pragma once

namespace keeler {

enum class InstructionSet { portable, avx2, avx512 };

const char* instruction_set_name(InstructionSet set);

/// Whether this build holds kernels for the set and this processor can run them.
bool supports(InstructionSet set);

/// The widest supported set, or the one that the environment variable KEELER_SIMD names (portable, avx2 or avx512).
/// Throws UsageError when it names an unknown or unsupported one.
InstructionSet choose_instruction_set();

} // namespace keeler
