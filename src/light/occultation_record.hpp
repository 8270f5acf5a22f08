// The numbers of an occultation, by name.
#pragma once

#include <keeler/light/footprints.hpp>
#include <keeler/light/wake_model.hpp>
#include <keeler/quantities/quantity.hpp>

namespace keeler::light {

/// Returns the numbers of a line of sight but for the autocovariance; angles in degrees.
quantities::Record record_of(const FootprintStatistics& statistics);

/// Returns the model that fits the transmissions of all lines of sight; nothing where they leave it open.
std::optional<FittedWakes> fit_wakes(std::span<const FootprintStatistics> found, BarSection section);

/// Returns the numbers of a fit.
quantities::Record record_of(const FittedWakes& fit);

/// Returns the quantities in such records.
std::vector<quantities::Quantity> occultation_quantities();
std::vector<quantities::Quantity> wake_model_quantities();

} // namespace keeler::light
