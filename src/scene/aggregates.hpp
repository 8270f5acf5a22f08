// The scene's [[particles.aggregate]] tables: balls of the scene's particles at the start.
#pragma once

#include <keeler/config/settings.hpp>
#include <keeler/scene/scene.hpp>

#include <vector>

namespace keeler::scene {

std::vector<Key> aggregate_keys();

/// Returns the aggregates of a fresh start. Throws UsageError if the scene has too few particles for them.
/// Precondition: particles.count is set.
std::vector<AggregateSettings> read_aggregates(config::Settings& settings, const std::string& name,
                                               const ParticleSettings& particles);

} // namespace keeler::scene
