#include "far_images.hpp"

#include "clumped_state.hpp"
#include "lattice.hpp"

#include <keeler/core/random.hpp>
#include <keeler/gravity/images.hpp>

#include <doctest/doctest.h>

namespace far_images_test {

using namespace keeler;
using namespace keeler::gravity;
using namespace keeler_test;

namespace {

struct Mass {
  double x, y, z, mass;
};

template<class Real>
std::vector<Vec3> attractions(const FarImages& far, const std::vector<Mass>& bodies, InstructionSet set) {
  return far.attractions<Real>(bodies, bodies, set);
}

} // namespace

TEST_CASE("far images attract as Ewald's sums say, in boxes of any shape, at any offset, thin and thick") {
  for (const ShearingBox& box : {ShearingBox{60.0, 60.0, 1.5, 0.0}, ShearingBox{60.0, 48.0, 1.5, 0.0},
                                 ShearingBox{20.0, 400.0, 1.5, 0.0}, ShearingBox{300.0, 60.0, 1.5, 0.0}})
    for (const double height : {0.0, 0.02, 0.1, 0.4})
      for (const double part : {0.0, 0.3, 0.5, 0.8}) {
        const double offset = folded_offset(box, part * box.size_y),
                     highest = height * std::min(box.size_x, box.size_y);
        const FarImages far(box, offset, 1, highest);
        double error = 0.0, whole = 0.0;
        for (std::uint64_t k = 0; k < 40; ++k) {
          RandomStream random(2, RandomPurpose::position, k);
          const auto random_mass = [&] {
            Mass m{0.0, 0.0, 0.0, 1.0};
            m.x = (random.uniform() - 0.5) * box.size_x;
            m.y = (random.uniform() - 0.5) * box.size_y;
            m.z = (2.0 * random.uniform() - 1.0) * highest;
            return m;
          };
          const Mass target = random_mass(), source = random_mass();
          const std::vector<Vec3> pulls =
              attractions<double>(far, std::vector<Mass>{target, source}, choose_instruction_set());
          const Vec3 exact = far_pull(Lattice(box, offset), near_images(box, offset, {}),
                                      {target.x - source.x, target.y - source.y, target.z - source.z});
          CHECK((pulls[0] + pulls[1]).norm() < 1e-12 / box.area()); // equal and opposite
          error += (pulls[0] - exact).squaredNorm();
          whole += exact.squaredNorm();
        }
        CAPTURE(box.size_x);
        CAPTURE(height);
        CAPTURE(part);
        const double per_sheet = std::sqrt(error / 40) * box.area(), of_pull = std::sqrt(whole / 40) * box.area();
        INFO("rms error / G Sigma " << per_sheet << ", pull " << of_pull);
        CHECK(per_sheet < (height < 0.2 ? 1.5e-3 : 4e-3));
      }
}

TEST_CASE("the field of many bodies is the sum of their fields, in all instruction sets") {
  const ClumpedState state = clumped_state(1100, 3, 3.0); // three blocks, the last one not full
  const double offset = folded_offset(state.box, state.offset);
  std::vector<Mass> bodies;
  for (std::size_t k = 0; k < state.positions.size(); ++k)
    bodies.push_back({state.positions[k].x(), state.positions[k].y(), state.positions[k].z(), state.masses[k]});
  const FarImages far(state.box, offset, 1, 12.0);
  const std::vector<Vec3> pulls = attractions<double>(far, bodies, InstructionSet::portable);
  const std::vector<Vec3> single = attractions<float>(far, bodies, InstructionSet::portable);
  const double h = 1e-3, sheet = 1100 * 2000.0 / state.box.area();
  for (std::size_t k = 0; k < bodies.size(); k += 97) {
    Vec3 slope = Vec3::Zero();
    for (const Mass& other : bodies)
      for (int axis = 0; axis < 3; ++axis) {
        const Vec3 d(bodies[k].x - other.x, bodies[k].y - other.y, bodies[k].z - other.z), step = h * Vec3::Unit(axis);
        slope[axis] -= other.mass * (far.potential(d + step) - far.potential(d - step)) / (2.0 * h);
      }
    CHECK((pulls[k] - slope).norm() < 1e-6 * sheet);
  }
  CHECK(rms_error(single, pulls) < 1e-5); // single precision, and sums of signs both ways
  for (const InstructionSet set : {InstructionSet::avx2, InstructionSet::avx512})
    if (supports(set)) {
      CHECK(attractions<double>(far, bodies, set) == pulls);
      CHECK(attractions<float>(far, bodies, set) == single);
    }
}

TEST_CASE("a body high above the others feels the far images from the largest height allowed") {
  const ShearingBox box{50.0, 50.0, 1.5, 0.0};
  const FarImages far(box, 7.0, 1, 1e6);
  const InstructionSet set = choose_instruction_set();
  const auto with_second_at = [&](double height) {
    return attractions<double>(far, std::vector<Mass>{{1.0, 2.0, 0.0, 5.0}, {9.0, 9.0, height, 1.0}}, set);
  };
  CHECK(with_second_at(1000.0) == with_second_at(25.0));
}

} // namespace far_images_test
