#include "photometry_record.hpp"

#include <keeler/core/units.hpp>

#include <cmath>

namespace keeler::light {
namespace {

namespace unit = quantities::unit;
using quantities::Spread, quantities::Value, quantities::value_of;
using Of = const Photometry&;

// Returns an angle in degrees, without the rounding of its way through radians.
double degrees_of(double radians) {
  return std::round(radians * 180.0 / pi * 1e10) / 1e10;
}

std::vector<quantities::QuantityRow<Photometry>> rows() {
  return {
      {{"observer_elevation", unit::degrees, "B",
        "elevation of the observer above the ring plane; below 0: the other face"},
       [](Of p) -> Value { return degrees_of(p.sight.observer.elevation); }},
      {{"observer_azimuth", unit::degrees, "phi",
        "azimuth of the observer, from the radius outward to the orbital motion"},
       [](Of p) -> Value { return degrees_of(p.sight.observer.azimuth); }},
      {{"ring_longitude", unit::degrees, "longitude",
        "of the patch, from the point below the observer in the direction of motion: -phi"},
       [](Of p) -> Value { return degrees_of(p.sight.longitude()); }},
      {{"sun_elevation", unit::degrees, "B'", "elevation of the Sun above the ring plane"},
       [](Of p) -> Value { return degrees_of(p.sight.sun.elevation); }},
      {{"sun_azimuth", unit::degrees, "", "azimuth of the Sun"},
       [](Of p) -> Value { return degrees_of(p.sight.sun.azimuth); }},
      {{"phase", unit::degrees, "phase", "the angle between the directions to Sun and observer"},
       [](Of p) -> Value { return degrees_of(p.sight.phase()); }},
      {{"reflectance", unit::none, "I/F",
        "intensity I of the patch where the flux of sunlight is pi F, all orders of scattering", Spread::error},
       [](Of p) -> Value { return value_of(std::optional(p.reflectance)); }},
      {{"single_scattering", unit::none, "single", "I/F of light that was scattered once", Spread::error},
       [](Of p) -> Value { return value_of(std::optional(p.single)); }},
      {{"multiple_scattering", unit::none, "multiple", "I/F of light that was scattered more often", Spread::error},
       [](Of p) -> Value { return value_of(std::optional(p.multiple)); }},
      {{"transmission", unit::none, "T", "fraction of a star's light that passes towards the observer", Spread::error},
       [](Of p) -> Value { return value_of(std::optional(p.transmission)); }},
      {{"snapshot_scatter", unit::none, "", "standard deviation of the I/F of single snapshots"},
       [](Of p) -> Value { return value_of(p.scatter, "there is one snapshot"); }},
      {{"spheres_met", unit::none, "", "mean number of spheres that a ray meets"},
       [](Of p) -> Value { return p.scatterings; }},
      {{"rays", unit::none, "", "number of rays per snapshot"}, [](Of p) -> Value { return p.rays; }},
  };
}

std::vector<quantities::QuantityRow<AzimuthGroup>> group_rows() {
  using Group = const AzimuthGroup&;
  return {
      {{"observer_elevation", unit::degrees, "B", ""},
       [](Group g) -> Value { return degrees_of(g.sights.front().sight.observer.elevation); }},
      {{"sun_elevation", unit::degrees, "B'", ""},
       [](Group g) -> Value { return degrees_of(g.sights.front().sight.sun.elevation); }},
      {{"phase", unit::degrees, "phase", ""},
       [](Group g) -> Value { return degrees_of(g.sights.front().sight.phase()); }},
      {{"mean_reflectance", unit::none, "mean I/F", "mean of the I/F over the azimuths"},
       [](Group g) -> Value {
         double sum = 0.0;
         for (const Photometry& one : g.sights)
           sum += one.reflectance.value;
         return sum / static_cast<double>(g.sights.size());
       }},
      {{"asymmetry", unit::none, "asymmetry", "(max - min)/(max + min) of the I/F over azimuth", Spread::error},
       [](Group g) -> Value {
         return g.asymmetry ? value_of(std::optional(Estimate{g.asymmetry->amplitude, g.asymmetry->error}))
                            : Value(quantities::Unknown{"it takes 8 azimuths in half a turn"});
       }},
      {{"minimum_longitude", unit::degrees, "darkest at longitude",
        "ring longitude of the least I/F, below 180; the other one is 180 farther"},
       [](Group g) -> Value {
         return g.asymmetry ? Value(degrees_of(g.asymmetry->minimum_longitude))
                            : Value(quantities::Unknown{"it takes 8 azimuths in half a turn"});
       }},
  };
}

bool in_one_group(const Sight& a, const Sight& b) {
  constexpr double equal = 1e-9;
  return std::fabs(a.observer.elevation - b.observer.elevation) < equal &&
         std::fabs(a.sun.elevation - b.sun.elevation) < equal && std::fabs(a.phase() - b.phase()) < 1e3 * equal;
}

} // namespace

quantities::Record record_of(const Photometry& photometry) {
  return {entries_of(rows(), photometry)};
}

std::vector<quantities::Quantity> photometry_quantities() {
  return quantities_of(rows());
}

std::vector<AzimuthGroup> azimuth_groups(std::span<const Photometry> photometry) {
  std::vector<AzimuthGroup> groups;
  for (const Photometry& one : photometry) {
    if (groups.empty() || !in_one_group(groups.back().sights.front().sight, one.sight))
      groups.emplace_back();
    groups.back().sights.push_back(one);
  }
  std::erase_if(groups, [](const AzimuthGroup& group) { return group.sights.size() < 2; });
  for (AzimuthGroup& group : groups)
    group.asymmetry = brightness_asymmetry(group.sights);
  return groups;
}

quantities::Record record_of(const AzimuthGroup& group) {
  return {entries_of(group_rows(), group)};
}

} // namespace keeler::light
