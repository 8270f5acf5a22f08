// Where a file comes from: which program, on what, started how. Stored beside the data and never part of a checksum or
// a state hash: two runs that differ in it alone are the same run.
#pragma once

#include <map>
#include <string>
#include <vector>

namespace keeler {

/// name → value: version, commit, compiler, flags, libraries, host, threads, arguments, started (UTC).
using Provenance = std::map<std::string, std::string>;

/// What holds for this process; `arguments` is its command line. `started` is the time of this call.
Provenance collect_provenance(const std::vector<std::string>& arguments);

/// This second: "2026-01-31T23:59:59Z".
std::string utc_now();

} // namespace keeler
