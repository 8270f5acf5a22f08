// How a patch in sunlight is pictured.
#pragma once

#include <keeler/light/photometry.hpp>

#include <string>

namespace keeler::render {

struct LitLook {
  light::Sight sight;   ///< where observer and Sun are
  light::SharedLaw law; ///< of the particles
  std::string law_text; ///< in the caption: "lambert, albedo 0.5"
  int samples = 8;      ///< rays per pixel
};

/// Returns the look that pictures have where nothing else is asked for: observer and Sun 20° above the plane, the
/// observer at the azimuth −60°, phase 60°, Lambert spheres of albedo 0.5.
LitLook usual_lit_look();

} // namespace keeler::render
