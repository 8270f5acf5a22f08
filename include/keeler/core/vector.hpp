// Vectors of three doubles. The particle store uses plain doubles: see particles/store.hpp.
#pragma once

#include <Eigen/Core>

namespace keeler {

using Vec3 = Eigen::Vector3d; ///< a column of three doubles

} // namespace keeler
