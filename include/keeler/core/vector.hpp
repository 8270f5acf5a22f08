// Small vectors. Arrays of particles are never stored in Eigen types: see particles/store.hpp.
#pragma once

#include <Eigen/Core>

namespace keeler {

using Vec3 = Eigen::Vector3d;

} // namespace keeler
