// The step, the end and the output schedules of a scene, as whole numbers of ticks.
#pragma once

#include <keeler/config/settings.hpp>
#include <keeler/scene/scene.hpp>

namespace keeler::scene {

/// Reads [time] and the schedules of [output]. Precondition: the scene has its gravity settings, and the step is
/// resolved.
void read_times(Scene& scene, config::Settings& settings);

/// Throws UsageError if a step holds more than TimeSettings::max_oscillations.
void refuse_many_oscillations(const Scene& scene, const config::Settings& settings);

} // namespace keeler::scene
