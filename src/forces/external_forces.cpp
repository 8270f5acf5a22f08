#include <keeler/forces/force.hpp>

#include "constant_acceleration.hpp"
#include "gas.hpp"

#include <keeler/core/error.hpp>
#include <keeler/core/registry.hpp>
#include <keeler/forces/satellite.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <string_view>

namespace keeler::forces {
namespace {

// Names that mean something else in scenes, in the fields of a state (resting_work) or among a run's times.
constexpr std::string_view other_names[] = {
    "box",      "collisions", "gravity",  "moonlet", "output", "particles", "planet",    "quality",
    "start",    "time",       "title",    "resting", "drift",  "exchange",  "snapshots", "checkpoints",
    "contacts", "series",     "stresses", "scene",   "kick",   "advance",   "law",       "force_checks"};

Registry<ForceEntry>& registered_forces() {
  static Registry<ForceEntry> forces("force", &ForceEntry::table,
                                     {constant_acceleration_entry(), satellite_entry(), gas_entry()});
  return forces;
}

} // namespace

void add_force(ForceEntry entry, IfTaken if_taken) {
  if (entry.table && std::ranges::count(other_names, std::string_view(entry.table)) > 0)
    throw UsageError(
        fmt::format("a force cannot be called '{}' (scenes and runs use that name); rename it", entry.table));
  if (entry.table && entry.keys.empty()) // a scene would lose its empty table when it is stored
    throw UsageError(fmt::format("the force '{}' has no keys, and a scene keeps no table without one; declare a key of "
                                 "it, such as a version of its formula",
                                 entry.table));
  registered_forces().add(std::move(entry), if_taken);
}

const std::vector<ForceEntry>& external_forces() {
  return registered_forces().entries();
}

} // namespace keeler::forces
