// What the ranks of a run are asked for: the same of all, or the run does not begin.
#pragma once

#include <keeler/runs/run.hpp>

namespace keeler {

/// Collective. Throws UsageError where a rank has other options than the first one, another scene, or other files that
/// the scene names. Options that only the first rank heeds count too: ranks that differ in them were not started as one
/// run.
void require_same_run(const Scene& scene, const RunOptions& options);

/// The same of a run that goes on, whose scene is in its checkpoint.
void require_same_run(const RunOptions& options);

} // namespace keeler
