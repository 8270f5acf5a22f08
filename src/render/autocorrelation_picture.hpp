// A picture of the autocorrelation of the surface density: the map with the ridge that defines the pitch, and the
// radial profile that defines the spacing.
#pragma once

#include <keeler/diagnostics/wakes.hpp>

#include <string>

namespace keeler {

/// Writes a PNG of 1600 × 860 pixels. Throws IoError when the file cannot be written.
void render_autocorrelation(const AutocorrelationMap& map, const Wakes& wakes, double critical_wavelength,
                            const std::string& path, const std::string& title);

} // namespace keeler
