// Memory use and limits of this process, and the check of user-supplied numbers before they are used as sizes.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

namespace keeler {

/// Returns the peak resident memory of this process, bytes; NaN if unknown.
double peak_memory();

/// Returns the memory that this process can still allocate, bytes: the minimum of the free memory of the machine, of
/// its control groups, and of its address space limit (ulimit -v). At most 2⁴⁷, the address space of a process.
double available_memory();

/// Throws UsageError if `bytes` is NaN or above available_memory(): "WHAT needs 2.1e9 GB of memory, and 12.3 GB are
/// available; REMEDY".
void require_memory(double bytes, const std::string& what, const std::string& remedy);

/// Converts a count, computed from user input, to a size: rounds down, and throws as require_memory() if it is negative
/// or NaN, or memory is missing for so many items of `bytes_each` (>= 0). `what` names the items.
std::size_t affordable_size(double count, double bytes_each, const std::string& what, const std::string& remedy);

/// Makes the program's operator new use large blocks again (large_blocks.hpp), and the C library keep freed blocks of
/// any size for the next ones, for the rest of this process. By default it returns blocks of 32 MiB and more to the
/// system, so a large patch fetches the memory of each kick page by page. Does nothing if the environment sets
/// GLIBC_TUNABLES or a variable of mallopt(3), or without the GNU C library. Why: docs/dev/estimate.md.
void keep_freed_memory();

/// As above, but the C library returns its freed blocks early: in programs without that operator new, what one rank
/// keeps would leave gaps. Why: docs/dev/ranks.md.
void return_freed_memory();

/// Empties a vector and frees its memory, which `v = {}` keeps: that assigns an empty list.
template<class T> void free_memory(std::vector<T>& v) {
  std::vector<T>().swap(v);
}

} // namespace keeler
