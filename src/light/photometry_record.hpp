// The numbers of a photometry, by name: what commands, tables and Python show.
#pragma once

#include <keeler/light/photometry.hpp>
#include <keeler/quantities/quantity.hpp>

namespace keeler::light {

/// Returns the numbers of one sight; angles in degrees.
quantities::Record record_of(const Photometry& photometry);

/// Returns the quantities in such records.
std::vector<quantities::Quantity> photometry_quantities();

/// Sights with one elevation of the observer and of the Sun and one phase angle, at several azimuths.
struct AzimuthGroup {
  std::vector<Photometry> sights;
  std::optional<BrightnessAsymmetry> asymmetry;
};

/// Returns the groups of at least two sights, in order. Angles within 1e-9 rad are equal.
std::vector<AzimuthGroup> azimuth_groups(std::span<const Photometry> photometry);

/// Returns the numbers of a group: its angles and the asymmetry.
quantities::Record record_of(const AzimuthGroup& group);

} // namespace keeler::light
