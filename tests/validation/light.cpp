// Light scattered by layers: exact solutions in the limit of thin layers, conservation, reciprocity.
#include "rows.hpp"

#include "unit/light/chandrasekhar.hpp"
#include "unit/light/states.hpp"

#include <keeler/core/units.hpp>
#include <keeler/light/photometry.hpp>

#include <fmt/format.h>

#include <cmath>

namespace keeler::validation {
namespace {

using light::Photometry, light::Sight;

constexpr double in_rad = pi / 180.0;
constexpr double dilute = 5e-4; // filling factor
constexpr std::size_t thin_layer_spheres = 200'000;

Photometry seen(std::span<const Patch> patches, const Sight& sight, const light::SharedLaw& law, std::uint64_t rays) {
  light::PhotometrySettings settings;
  settings.law = law;
  settings.rays = rays;
  return light::photometry(patches, {&sight, 1}, settings).front();
}

// A row of a ratio: a tolerance of four standard errors, and of the state's finite number of spheres.
Row ratio_row(const std::string& what, const Estimate& found, double expected, double of_state, const char* source,
              const std::string& command) {
  return {.what = what,
          .measured = found.value / expected,
          .error = found.error / expected,
          .expected = 1.0,
          .tolerance = 4.0 * found.error / expected + of_state,
          .tolerance_is = "4 standard errors, and the chance of the places",
          .source = source,
          .command = command};
}

std::vector<Row> single_scattering() {
  std::vector<Row> rows;
  const double albedo = 0.6;
  const light::SharedLaw law = light::law_named("callisto", albedo);
  for (const double tau : {0.1, 0.5, 2.0}) {
    const Patch patch = test::random_layer(tau, dilute, thin_layer_spheres, 4, 0.31);
    for (const double observer : {70.0, 25.0, -40.0})
      for (const double sun : {50.0, 15.0}) {
        const Sight sight{{observer * in_rad, 0.7}, {sun * in_rad, 2.3}};
        const double mu = std::fabs(std::sin(sight.observer.elevation)), mu0 = std::sin(sight.sun.elevation);
        const double of_sphere =
            law->brightness(Vec3::UnitZ(), sight.observer.direction(), sight.sun.direction()); // ϖ P/4
        const double expected =
            of_sphere * (sight.lit() ? mu0 / (mu + mu0) * (1.0 - std::exp(-tau * (1.0 / mu + 1.0 / mu0)))
                                     : mu0 / (mu0 - mu) * (std::exp(-tau / mu0) - std::exp(-tau / mu)));
        rows.push_back(ratio_row(
            fmt::format("single scattering over the exact one, tau {}, B {}, B' {}", tau, observer, sun),
            seen({&patch, 1}, sight, law, 65536).single, expected, sight.lit() ? 0.008 : 0.008 + 0.005 * tau / mu0,
            "a thin layer: varpi P/4 mu0/(mu + mu0) (1 - exp(-tau (1/mu + 1/mu0))), and its like for the other face "
            "(Chandrasekhar 1950, 21)",
            fmt::format("{} spheres at random, filling factor {}, seed 4", thin_layer_spheres, dilute)));
      }
  }
  return rows;
}

std::vector<Row> x_and_y() {
  std::vector<Row> rows;
  for (const double tau : {0.1, 1.0, 4.0}) {
    const Patch patch = test::random_layer(tau, dilute, thin_layer_spheres, 4, 0.31);
    for (const double albedo : {0.5, 0.9, 1.0}) {
      const double b = 60.0, sun = 20.0;
      const test::IsotropicLayer exact(albedo, tau, {std::sin(b * in_rad), std::sin(sun * in_rad)});
      for (const double face : {1.0, -1.0}) {
        const Sight sight{{face * b * in_rad, 0.0}, {sun * in_rad, 2.0}};
        rows.push_back(
            ratio_row(fmt::format("isotropic I/F over that by X and Y, albedo {}, tau {}, B {}, B' {}", albedo, tau,
                                  face * b, sun),
                      seen({&patch, 1}, sight, light::isotropic_law(albedo), 32768).reflectance,
                      face > 0.0 ? exact.reflected(0, 1) : exact.transmitted(0, 1), face > 0.0 ? 0.008 : 0.02,
                      "X and Y functions (Chandrasekhar 1950, ch. VIII)",
                      fmt::format("{} spheres at random, filling factor {}, seed 4", thin_layer_spheres, dilute)));
      }
    }
  }
  return rows;
}

// Spheres that do not overlap: their places are not independent, so they hide less of each other.
std::vector<Row> filling_factors() {
  std::vector<Row> rows;
  const std::pair<double, std::size_t> layers[] = {{30.0, 3100}, {15.0, 3100}, {15.0, 6200}}; // heights, spheres
  for (const auto& layer : layers) {
    const double height = layer.first;
    const Patch patch = test::dense_layer(60.0, 60.0, height, layer.second, 3, 20.0);
    double area = 0.0, volume = 0.0;
    for (const double r : patch.radii)
      area += pi * r * r, volume += 4.0 / 3.0 * pi * r * r * r;
    const double tau = area / patch.box.area(), filling = volume / (patch.box.area() * height);
    const Sight sight{{90.0 * in_rad, 0.0}, {90.0 * in_rad, 0.0}};
    const light::SharedLaw law = light::law_named("callisto", 0.5);
    const Photometry found = seen({&patch, 1}, sight, law, 262144);
    const double measured = -std::log(found.transmission.value) / tau;
    const std::string command = fmt::format(
        "{} spheres of 0.4 to 1 m at random in 60 x 60 x {} m, none overlapping, seed 3", patch.size(), height);
    rows.push_back(
        {.what = fmt::format("optical depth by transmission over sum of areas, filling factor {:.3f}", filling),
         .measured = measured,
         .error = found.transmission.error / found.transmission.value / tau,
         .expected = 1.0 / (1.0 - filling),
         .tolerance = 0.04,
         .tolerance_is = "4 %: faces of the layer, one state",
         .source = "1/(1 - D): free paths among hard spheres (Torquato & Lu 1993, Phys. Rev. E 47, 2950); "
                   "the effect of Salo & Karjalainen 2003",
         .command = command});
    const double of_sphere = law->brightness(Vec3::UnitZ(), Vec3::UnitZ(), Vec3::UnitZ());
    rows.push_back({.what = fmt::format("single scattering at phase 0, filling factor {:.3f}", filling),
                    .measured = found.single.value,
                    .error = found.single.error,
                    .expected = of_sphere * (1.0 - found.transmission.value),
                    .tolerance = 2e-4,
                    .tolerance_is = "of the same rays: limbs within the rounding of single precision",
                    .source = "varpi P(0)/4 (1 - T): what is seen is lit",
                    .command = command});
  }
  return rows;
}

std::vector<Row> conservation() {
  std::vector<Row> rows;
  const Patch patch = test::dense_layer(20.0, 20.0, 4.0, 160, 2, 3.0);
  const char* const state = "160 spheres of 0.4 to 1 m in 20 x 20 x 4 m, seed 2";
  const double nodes[] = {0.0694318442, 0.3300094782, 0.6699905218, 0.9305681558};
  const double parts[] = {0.1739274226, 0.3260725774, 0.3260725774, 0.1739274226};
  for (const char* const name : {"lambert", "lommel_seeliger", "isotropic", "callisto"}) {
    const light::SharedLaw law = light::law_named(name, 1.0);
    double sky = 0.0, squares = 0.0;
    for (int k = 0; k < 4; ++k)
      for (int j = 0; j < 12; ++j)
        for (const double face : {1.0, -1.0}) {
          const Sight sight{{50.0 * in_rad, 0.4}, {face * std::asin(nodes[k]), two_pi * (j + 0.37) / 12}};
          const Photometry one = seen({&patch, 1}, sight, law, 16384);
          sky += 2.0 * one.reflectance.value * parts[k] / 12.0;
          squares += std::pow(2.0 * one.reflectance.error * parts[k] / 12.0, 2);
          if (k == 0 && j == 0 && face > 0.0)
            sky += one.transmission.value;
        }
    rows.push_back({.what = fmt::format("brightness of an even sky through a patch of albedo 1, {}", name),
                    .measured = sky,
                    .error = std::sqrt(squares),
                    .expected = 1.0,
                    .tolerance = 0.01,
                    .tolerance_is = "the rule of 4 x 12 directions a face",
                    .source = "what goes in comes out",
                    .command = state});
  }
  for (const char* const name : {"lambert", "lommel_seeliger", "callisto"}) {
    const light::SharedLaw law = light::law_named(name, 0.9);
    const light::Bearing a{50.0 * in_rad, 0.4}, b{12.0 * in_rad, 2.1};
    const Photometry there = seen({&patch, 1}, {a, b}, law, 1u << 20), back = seen({&patch, 1}, {b, a}, law, 1u << 20);
    const double one = there.reflectance.value * std::sin(a.elevation),
                 two = back.reflectance.value * std::sin(b.elevation);
    rows.push_back({.what = fmt::format("mu I/F there over back, {}", name),
                    .measured = one / two,
                    .error = std::hypot(there.reflectance.error / there.reflectance.value,
                                        back.reflectance.error / back.reflectance.value),
                    .expected = 1.0,
                    .tolerance = 0.008,
                    .tolerance_is = "4 standard errors",
                    .source = "reciprocity",
                    .command = state});
  }
  return rows;
}

std::vector<Row> exact_light() {
  std::vector<Row> rows;
  if (!light::can_trace())
    return rows;
  for (const auto& part : {single_scattering(), x_and_y(), filling_factors(), conservation()})
    rows.insert(rows.end(), part.begin(), part.end());
  return rows;
}

} // namespace

std::vector<Subject> light_subjects() {
  return {{"light", "Light", false, exact_light}};
}

} // namespace keeler::validation
