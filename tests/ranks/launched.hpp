// The ranks that mpirun has started together for a test.
#pragma once

#include <keeler/ranks/ranks.hpp>

namespace keeler_test {

const keeler::Ranks& launched();

} // namespace keeler_test
