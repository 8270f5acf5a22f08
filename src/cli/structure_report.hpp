// What `keeler analyze` prints of the structure in snapshots as text: wakes, local motions, clusters.
#pragma once

#include <keeler/diagnostics/analysis.hpp>

namespace keeler {

void print_structure(const Analysis& analysis);

} // namespace keeler
