#include <keeler/gravity/mean_sheet.hpp>

#include <keeler/gravity/direct.hpp>

#include "clumped_state.hpp"

#include <doctest/doctest.h>

using namespace keeler;
using namespace keeler_test;

namespace {

// The uncovered sheet's field by rays: in direction e the sheet between the distances r and s pulls by ln(s/r) e and
// weighs 1/r − 1/s in the stiffness. What lies beyond all boxes is the whole plane less the covered stretches; near the
// place itself a disk of radius `inner` is left out.
SheetField by_rays(const ShearingBox& box, double offset, int rings, double x, double y) {
  constexpr int rays = 40000; // edges make kinks along the angle: errors of order 1 / rays². The jumps of a place
                              // between two columns stand at ± π/2, where one ray's share ends
  constexpr double inner = 1e-3;
  SheetField sum;
  for (int ray = 0; ray < rays; ++ray) {
    const double angle = 2.0 * pi * (ray + 0.5) / rays, ex = std::cos(angle), ey = std::sin(angle);
    double pull = 0.0, stiffness = 1.0 / inner;
    for (const Vec3& shift : image_shifts(box, offset, rings)) {
      const double to_x = (shift.x() - x) / ex, half_x = 0.5 * box.size_x / std::fabs(ex);
      const double to_y = (shift.y() - y) / ey, half_y = 0.5 * box.size_y / std::fabs(ey);
      const double in = std::max({to_x - half_x, to_y - half_y, inner}), out = std::min(to_x + half_x, to_y + half_y);
      if (in < out) {
        pull -= std::log(out / in);
        stiffness -= 1.0 / in - 1.0 / out;
      }
    }
    sum.x += pull * ex;
    sum.y += pull * ey;
    sum.stiffness += stiffness;
  }
  const double weight = 2.0 * pi / rays;
  return {weight * sum.x, weight * sum.y, weight * sum.stiffness};
}

// side × side equal particles in the plane, evenly spaced, with a probe of hardly any mass among them.
ClumpedState lattice(int side, const Vec3& probe, double offset) {
  ClumpedState state;
  state.box = {100.0, 100.0, 1.5, 0.0};
  state.offset = offset;
  const double spacing = 100.0 / side;
  for (int i = 0; i < side; ++i)
    for (int j = 0; j < side; ++j) {
      state.positions.push_back(Vec3((i + 0.5) * spacing - 50.0, (j + 0.5) * spacing - 50.0, 0.0));
      state.masses.push_back(1000.0);
      state.ids.push_back(state.ids.size());
    }
  state.positions.push_back(probe);
  state.masses.push_back(1e-9);
  state.ids.push_back(state.ids.size());
  return state;
}

// Acceleration of the probe in G Σ, with the sheet and by plain rings.
struct ProbeForce {
  Vec3 with_sheet, plain;
};

ProbeForce probe_force(int side, const Vec3& probe, double offset, int rings) {
  const ClumpedState state = lattice(side, probe, offset);
  DirectSolver solver(rings, choose_instruction_set());
  const std::vector<Vec3> a = accelerations(solver, state.problem());
  const double g_sigma = state.problem().newton_g * 1000.0 * side * side / state.box.area();
  return {a.back() / g_sigma, without_sheet(a, state.problem(), rings).back() / g_sigma};
}

} // namespace

TEST_CASE("the closed form of the mean sheet is what rays through the boxes add up to") {
  for (const ShearingBox& box : {ShearingBox{100.0, 80.0, 1.5, 0.0}, ShearingBox{30.0, 90.0, 1.5, 0.0}})
    for (const double part : {0.0, 0.3, -0.5})
      for (const int rings : {1, 3}) {
        const double offset = part * box.size_y;
        const MeanSheet sheet(box, offset, rings);
        for (const double x : {-0.5, 0.13, 0.4, 0.5})
          for (const double y : {-0.37, 0.5}) {
            const SheetField a = sheet.closed_form(x * box.size_x, y * box.size_y);
            const SheetField b = by_rays(box, offset, rings, x * box.size_x, y * box.size_y);
            CHECK(std::fabs(a.x - b.x) < 1e-6);
            CHECK(std::fabs(a.y - b.y) < 1e-6);
            CHECK(std::fabs(a.stiffness - b.stiffness) * box.size_x < 1e-5); // rays count from 1/inner down
          }
      }
}

TEST_CASE("the table gives the closed form") {
  for (const double length : {25.0, 100.0, 250.0, 1000.0})
    for (const double part : {0.0, 0.3, 0.5})
      for (const int rings : {0, 1, 2}) {
        const ShearingBox box{length, 100.0, 1.5, 0.0};
        const MeanSheet sheet(box, part * box.size_y, rings);
        double plane = 0.0, vertical = 0.0;
        for (int i = -20; i <= 20; ++i)
          for (int j = -20; j <= 20; ++j) {
            const double x = i * box.size_x / 40, y = j * box.size_y / 40;
            const SheetField a = sheet.tabulated(x, y), b = sheet.closed_form(x, y);
            plane = std::max({plane, std::fabs(a.x - b.x), std::fabs(a.y - b.y)});
            vertical = std::max(vertical, std::fabs(a.stiffness / b.stiffness - 1.0));
          }
        // Without rings the cell's edges are as near as softening(), far more than polynomials of degree 11 resolve.
        CHECK(plane < (rings == 0 ? 0.5 : 1e-6));
        CHECK(vertical < (rings == 0 ? 0.5 : 1e-6));
      }
}

TEST_CASE("a uniform sheet pulls nowhere in the plane") {
  // A lattice of spacing 2 m: its own graininess at 5 m height is exp(−2π 5/2), nothing.
  double worst = 0.0, worst_plain = 0.0;
  for (const double part : {0.0, 0.3, 0.5})
    for (const double x : {-49.99, 0.3, 31.0, 45.0, 49.99})
      for (const double y : {-17.0, 49.99}) {
        const ProbeForce force = probe_force(50, Vec3(x, y, 5.0), part * 100.0, 1);
        worst = std::max(worst, force.with_sheet.head<2>().norm());
        worst_plain = std::max(worst_plain, force.plain.head<2>().norm());
      }
  MESSAGE("uniform, 1 ring, pull in the plane / G Sigma: " << worst << ", plain " << worst_plain);
  CHECK(worst_plain > 0.9);
  CHECK(worst < 0.01); // order (z/L)²
}

TEST_CASE("a uniform sheet pulls by 2 pi G Sigma towards its plane") {
  for (const int rings : {0, 1, 2})
    for (const double z : {-5.0, 5.0, 20.0}) {
      double worst = 0.0, worst_plain = 0.0;
      for (const Vec3& place : {Vec3(0.0, 0.0, z), Vec3(30.0, -40.0, z), Vec3(49.0, 49.0, z)}) {
        const ProbeForce force = probe_force(50, place, 37.0, rings);
        worst = std::max(worst, std::fabs(std::fabs(force.with_sheet.z()) - 2.0 * pi) / (2.0 * pi));
        worst_plain = std::max(worst_plain, std::fabs(std::fabs(force.plain.z()) - 2.0 * pi) / (2.0 * pi));
        CHECK(force.with_sheet.z() * z < 0.0);
      }
      MESSAGE(rings << " rings, height " << z << " of 100 m, error of the vertical pull: " << worst << ", plain "
                    << worst_plain);
      CHECK(worst < worst_plain / (rings == 0 ? 2.0 : 10.0));
      if (rings > 0)
        CHECK(worst < (z * z) / 1e4);
    }
}

TEST_CASE("crossing an edge of a uniform sheet hardly changes the force") {
  for (const bool in_x : {true, false})
    for (const double offset : {0.0, 37.0}) {
      const Vec3 inside = in_x ? Vec3(50.0 - 1e-9, 3.0, 5.0) : Vec3(3.0, 50.0 - 1e-9, 5.0);
      const Vec3 outside = in_x ? Vec3(50.0 + 1e-9, 3.0, 5.0) : Vec3(3.0, 50.0 + 1e-9, 5.0);
      const ProbeForce a = probe_force(50, inside, offset, 1), b = probe_force(50, outside, offset, 1);
      const double jump = (a.with_sheet - b.with_sheet).norm(), plain = (a.plain - b.plain).norm();
      MESSAGE("across " << (in_x ? "x" : "y") << ", offset " << offset << ": jump " << jump << " G Sigma, plain "
                        << plain);
      CHECK(plain > 1.5);
      CHECK(jump < 0.02); // order (z/L)²
    }
}

TEST_CASE("high above the patch the sheet pulls by its whole strength and no more") {
  const MeanSheet sheet({100.0, 100.0, 1.5, 0.0}, 0.0, 1);
  CHECK(sheet.acceleration(Vec3(10.0, 20.0, 1e6), 3.0).z() == doctest::Approx(-6.0 * pi).epsilon(1e-6));
  CHECK(sheet.acceleration(Vec3(10.0, 20.0, -1e6), 3.0).z() == doctest::Approx(6.0 * pi).epsilon(1e-6));
}
