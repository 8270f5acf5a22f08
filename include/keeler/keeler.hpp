// All that Keeler's library offers, by subject. How to build with it, its units, and what may change between versions
// is in the manual: docs/manual/library.md.
#pragma once

// Scenes
#include <keeler/core/key.hpp>
#include <keeler/scene/load.hpp>
#include <keeler/scene/planet.hpp>
#include <keeler/scene/scene.hpp>

// A simulation
#include <keeler/simulation/simulation.hpp>
#include <keeler/simulation/state.hpp>

// States and particles
#include <keeler/core/vector.hpp>
#include <keeler/hill/elements.hpp>
#include <keeler/hill/shearing_box.hpp>
#include <keeler/particles/patch.hpp>
#include <keeler/particles/sizes.hpp>
#include <keeler/particles/start.hpp>
#include <keeler/particles/store.hpp>

// Gravity and forces
#include <keeler/forces/force.hpp>
#include <keeler/gravity/solver.hpp>

// Collisions
#include <keeler/collision/drift.hpp>
#include <keeler/collision/restitution.hpp>
#include <keeler/collision/settings.hpp>
#include <keeler/contact_solver/resting_state.hpp>

// Starts
#include <keeler/initial_conditions/clumped.hpp>
#include <keeler/initial_conditions/initial.hpp>

// Measuring
#include <keeler/diagnostics/analysis.hpp>
#include <keeler/diagnostics/clusters.hpp>
#include <keeler/diagnostics/occultation.hpp>
#include <keeler/diagnostics/transmission.hpp>
#include <keeler/light/footprints.hpp>
#include <keeler/light/photometry.hpp>
#include <keeler/light/scattering.hpp>
#include <keeler/light/wake_model.hpp>
#include <keeler/quantities/quantity.hpp>
#include <keeler/statistics/measured.hpp>

// Files and runs
#include <keeler/io/snapshot.hpp>
#include <keeler/runs/own_numbers.hpp>
#include <keeler/runs/run.hpp>

// Errors, threads and ranks
#include <keeler/comm/communicator.hpp>
#include <keeler/core/error.hpp>
#include <keeler/core/interrupt.hpp>
#include <keeler/core/threads.hpp>
