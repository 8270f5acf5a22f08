#include <keeler/initial_conditions/from_table.hpp>

#include "separation.hpp"

#include <keeler/cells/overlap.hpp>
#include <keeler/core/error.hpp>
#include <keeler/core/format.hpp>
#include <keeler/core/threads.hpp>
#include <keeler/core/units.hpp>
#include <keeler/initial_conditions/possible.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <numeric>

namespace keeler::initial_conditions {
namespace {

[[noreturn]] void fail(const io::ParticleTable& table, std::size_t k, const std::string& fault) {
  throw UsageError(fmt::format("{}: the particle has {}; correct it or remove the row", table.location_of(k), fault));
}

void require_fitting(const io::ParticleTable& table, const scene::TableScene& of) {
  if (table.masses.empty() && !of.density)
    throw UsageError(
        fmt::format("{}: no column m, and the scene has no particles.density (one of them is needed for the masses); "
                    "add either",
                    table.file));
  if (!table.spins.empty() && !of.scene.collisions.friction)
    throw UsageError(
        fmt::format("{}: sx sy sz are spins, but the scene's particles are smooth (it has no [collisions.friction]); "
                    "add that table to the scene or remove the columns",
                    table.file));
}

// What the table states of the patch must be the scene's.
void require_frame(const io::ParticleTable& table, const Scene& scene) {
  constexpr double tolerance = 1e-6; // of what other programs round
  const auto differ = [](double stated, double wanted) { return std::fabs(stated - wanted) > tolerance * wanted; };
  const io::TableFrame& frame = table.frame;
  if (frame.has_box() && (differ(frame.size_x, scene.size_x) || differ(frame.size_y, scene.size_y)))
    throw UsageError(
        fmt::format("{0}: it is of a box of {1} m x {2} m, and the scene's is {3} m x {4} m; set box.size = [{1}, {2}]",
                    table.file, frame.size_x, frame.size_y, scene.size_x, scene.size_y));
  if (frame.orbital_frequency != 0.0 && differ(frame.orbital_frequency, scene.planet.orbital_frequency))
    throw UsageError(
        fmt::format("{}: its velocities are for Omega = {:g} rad/s, and the scene's planet has {:g}; change "
                    "[planet]",
                    table.file, frame.orbital_frequency, scene.planet.orbital_frequency));
  if (!(frame.shear_offset >= 0.0 && frame.shear_offset < scene.size_y))
    throw UsageError(
        fmt::format("{}: the shear offset is {:g} m; give one from 0 to the box's length along the orbit, {:g} m",
                    table.file, frame.shear_offset, scene.size_y));
}

} // namespace

Patch patch_from_table(const io::ParticleTable& table, const scene::TableScene& of) {
  assert(table.positions.size() == table.size() && table.radii.size() == table.size());
  require_fitting(table, of);
  const Scene& scene = of.scene;
  require_frame(table, scene);
  Patch patch;
  patch.offset = table.frame.shear_offset;
  patch.frequencies = scene.planet.frequencies;
  patch.orbital_frequency = scene.planet.orbital_frequency;
  patch.box = {scene.size_x, scene.size_y, scene.planet.frequencies.shear(), 0.0};
  patch.positions = table.positions;
  patch.radii = table.radii;
  patch.masses = table.masses;
  if (patch.masses.empty())
    for (const double radius : patch.radii)
      patch.masses.push_back(4.0 / 3.0 * pi * *of.density * radius * radius * radius);
  for (std::size_t k = 0; k < table.size(); ++k)
    patch.velocities.push_back(table.velocities.empty() ? Vec3(0.0, -patch.box.shear * table.positions[k].x(), 0.0)
                                                        : Vec3(table.velocities[k] / patch.orbital_frequency));
  for (const Vec3& spin : table.spins)
    patch.spins.emplace_back(spin / patch.orbital_frequency);
  patch.ids.resize(table.size());
  std::iota(patch.ids.begin(), patch.ids.end(), std::uint64_t{0});
  for (std::size_t k = 0; k < patch.size(); ++k) {
    std::string fault = particle_fault(patch, k);
    if (fault.empty())
      fault = box_fault({patch.positions[k], patch.velocities[k]}, patch.box, patch.frequencies);
    if (!fault.empty())
      fail(table, k, fault);
  }
  try {
    cells::require_no_heap(patch, table.file);
  } catch (const InvariantError& error) {
    throw InvariantError(error.what() + overlap_hint(patch));
  }
  return patch;
}

std::string overlap_hint(const Patch& patch) {
  constexpr double tiny = 0.02; // of the box: 30 m in km are 0.001 of it
  Vec3 low = patch.positions.front(), high = low;
  for (const Vec3& position : patch.positions)
    low = low.cwiseMin(position), high = high.cwiseMax(position);
  const Vec3 span = high - low;
  if (patch.size() > 1 && span.x() < tiny * patch.box.size_x && span.y() < tiny * patch.box.size_y)
    return fmt::format("; all are within {:.2g} m x {:.2g} m of a box of {:.5g} m x {:.5g} m: lengths are in m, are "
                       "these in km?",
                       span.x(), span.y(), patch.box.size_x, patch.box.size_y);
  if (cells::count_overlaps(patch, cells::allowed_overlap) > 50 * patch.size())
    return {}; // a heap: the largest overlap would take long to find
  const cells::Overlap worst = cells::largest_overlap(patch);
  const auto index = [&](std::uint64_t id) {
    return static_cast<std::size_t>(std::find(patch.ids.begin(), patch.ids.end(), id) - patch.ids.begin());
  };
  const std::size_t i = index(worst.id_i), j = index(worst.id_j);
  if ((patch.positions[i] - patch.positions[j]).norm() > patch.radii[i] + patch.radii[j])
    return fmt::format("; that pair meets across an edge of the box: is the shear offset right ({:g} m here; a CSV has "
                       "none, the other formats of keeler convert keep it), and is the box that of the particles?",
                       patch.offset);
  return {};
}

Relaxation relax(Patch& patch) {
  assert(patch.positions.size() == patch.size() && patch.velocities.size() == patch.size());
  constexpr int max_sweeps = 4000;
  constexpr std::size_t max_each = 50; // an equal sphere has room for 12 neighbours
  if (const std::size_t overlaps = cells::count_overlaps(patch, cells::allowed_overlap);
      overlaps > max_each * patch.size())
    throw InvariantError(
        fmt::format("{} overlap in {} pairs (more than {} per particle are a heap, for which no room can be made); "
                    "spread them out",
                    pluralize(patch.size(), "particle"), overlaps, max_each));
  std::vector<Sphere> spheres(patch.size());
  for (std::size_t k = 0; k < patch.size(); ++k)
    spheres[k] = {patch.positions[k], patch.radii[k], patch.positions[k].z(), static_cast<std::uint32_t>(k)};
  sort_by_position(spheres, patch.box);
  SphereSlabs alone({}, patch.box);
  if (!separate(spheres, patch.box, patch.offset, alone, max_sweeps, [](int) {}))
    throw InvariantError(
        fmt::format("particles still overlap after {} sweeps of moving them apart (the patch is too dense "
                    "somewhere); remove particles there or reduce their radii",
                    max_sweeps));
  Relaxation result;
  for (const Sphere& sphere : spheres) {
    Vec3& position = patch.positions[sphere.particle];
    const Vec3 shift = sphere.position - position;
    result.moved += shift != Vec3::Zero();
    result.farthest = std::max(result.farthest, shift.norm());
    patch.velocities[sphere.particle].y() -= patch.box.shear * shift.x();
    position = sphere.position;
  }
  return result;
}

} // namespace keeler::initial_conditions
