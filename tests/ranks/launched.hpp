// The ranks that mpirun started for a test.
#pragma once

#include <keeler/comm/communicator.hpp>

namespace keeler_test {

const keeler::Communicator& launched();

} // namespace keeler_test
