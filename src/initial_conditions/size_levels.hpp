// Hierarchical cells (Ogarko & Luding 2012): spheres sorted into octaves of size, with a grid for each, so that large
// and small spheres find each other without long searches within either size.
#pragma once

#include "sphere.hpp"

#include <keeler/cells/grid.hpp>

#include <vector>

namespace keeler::initial_conditions {

class SizeLevels {
public:
  SizeLevels(const std::vector<Sphere>& spheres, const ShearingBox& box, double offset);

  /// Returns the octave of a radius, 0 for the largest; never decreases with decreasing radius.
  std::size_t level_of(double radius) const;

  /// Calls visit(k, image) for each image of a sphere k, of this level or a later one, that may be closer to the
  /// position than `stretch` times (radius + radius of k). May visit others too.
  template<class Visit>
  void visit_near(const Vec3& position, double radius, double stretch, std::size_t first_level,
                  const Visit& visit) const {
    for (std::size_t l = first_level; l < levels_.size(); ++l) {
      const Level& level = levels_[l];
      const double reach = stretch * (radius + level.largest);
      if (!level.members.empty())
        level.grid.visit_near(position, reach, reach, [&](std::size_t member, const Image& image) {
          visit(std::size_t{level.members[member]}, image);
        });
    }
  }

private:
  struct Level {
    std::vector<std::uint32_t> members;
    double largest = 0.0; // radius
    cells::PeriodicGrid grid;
  };

  double largest_ = 0.0;
  std::vector<Level> levels_;
};

} // namespace keeler::initial_conditions
