// Provenance of a file: program, machine and command line. It is stored beside the data and is never part of a checksum
// or a state hash: two runs that differ only in provenance are equal.
#pragma once

#include <keeler/io/snapshot.hpp>

#include <string>
#include <vector>

namespace keeler::io {

/// Collects the provenance of this process; `arguments` is its command line. `started` is the time of this call.
Provenance collect_provenance(const std::vector<std::string>& arguments);

/// Returns the current time, "2026-01-31T23:59:59Z".
std::string utc_now();

} // namespace keeler::io
