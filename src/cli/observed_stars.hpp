// A table of observed occultations: where the star was, and how much of its light passed.
#pragma once

#include <keeler/light/wake_model.hpp>

#include <string>
#include <vector>

namespace keeler::cli {

inline constexpr double lowest_star = 0.1; ///< degrees: rays cross 600 m of ring per metre of its thickness

struct ObservedStars {
  std::vector<light::StarTransmission> transmissions; ///< the error is 0.01 where the table has none
  bool has_errors = false;
};

/// Reads the columns elevation, azimuth or longitude (degrees), transmission or normal_optical_depth, and error if
/// there is one. Throws UsageError "FILE:LINE: …", IoError.
ObservedStars read_observed_stars(const std::string& file);

} // namespace keeler::cli
