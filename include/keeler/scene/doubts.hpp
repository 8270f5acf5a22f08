// What is allowed but seldom meant, and what a patch cannot show: said before a run by `keeler check`, and by the run.
#pragma once

#include <keeler/scene/scene.hpp>

#include <string>
#include <vector>

namespace keeler {

/// How large a patch is, and of what.
struct PatchScale {
  std::size_t particle_count = 0;
  double size_x = 0.0, size_y = 0.0; ///< m
  double lambda_cr = 0.0;            ///< m
  double density = 0.0;              ///< of the particles themselves, kg m^-3: asked where the scene does not give it
};

/// A line each, with numbers; none where nothing is amiss.
std::vector<std::string> doubts(const Scene& scene, const PatchScale& patch);

/// The same before there is a patch: of one that a start file holds only the time step can be judged.
std::vector<std::string> doubts(const Scene& scene);

} // namespace keeler
