// The scene's [[particles.aggregate]] tables: balls of the scene's own particles, placed in the start.
#pragma once

#include "settings.hpp"

#include <keeler/scene/scene.hpp>

#include <vector>

namespace keeler {

std::vector<Key> aggregate_keys();

/// Of a fresh start, whose number of particles is known. Throws UsageError where it has too few of them.
std::vector<AggregateSettings> read_aggregates(Settings& settings, const std::string& name,
                                               const ParticleSettings& particles);

} // namespace keeler
