// How much memory this process takes and may take, and the check that numbers of a user pass before they become sizes.
#pragma once

#include <cstddef>
#include <string>

namespace keeler {

/// The most that it has had resident so far, bytes; NaN where the system does not say.
double peak_memory();

/// The memory that it may still take, bytes: the least of what the machine has left, of what its control groups leave,
/// and of what is left below its limit on address space (ulimit -v). At most 2⁴⁷, the address space of a process.
double available_memory();

/// Throws UsageError when so many bytes are not a number or more than available_memory(): "WHAT needs 2.1e+09 GB of
/// memory, and 12.3 GB can be had here; REMEDY".
void require_memory(double bytes, const std::string& what, const std::string& remedy);

/// Returns a count that was computed from numbers of a user as a size: a whole number of at least 0, rounded down, so
/// many of which there is memory for, `bytes_each`. Throws as require_memory(); `what` names all of them.
std::size_t affordable_size(double count, double bytes_each, const std::string& what, const std::string& remedy);

} // namespace keeler
