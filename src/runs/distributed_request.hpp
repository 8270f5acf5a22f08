// A distributed run begins only if all ranks received the same request.
#pragma once

#include <keeler/runs/run.hpp>

namespace keeler::runs {

/// Throws UsageError if the options of a rank, its scene, or the files that the scene names differ from the root's.
/// Options that only the root uses are compared too: ranks that differ in them were not started as one run. Collective.
void require_same_run(const Scene& scene, const RunOptions& options);

/// As above for a resumed run, which reads its scene from the checkpoint.
void require_same_run(const RunOptions& options);

} // namespace keeler::runs
