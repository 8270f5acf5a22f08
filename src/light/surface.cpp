// A surface law that is given as a function.
#include "frame.hpp"

#include <keeler/core/error.hpp>
#include <keeler/light/scattering.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <vector>

namespace keeler::light {
namespace {

// The table holds f/μ₀, which is smooth where light grazes the surface. Its nodes are even in the angles θ₀ and θ to
// the normal and in the azimuth φ between source and observer.
class Surface final : public ScatteringLaw {
public:
  Surface(const SurfaceFunction& brightness, double albedo) : values_(tilts * tilts * azimuths) {
    double largest = 0.0;
    for (std::size_t i = 0; i < tilts; ++i)
      for (std::size_t j = 0; j < tilts; ++j)
        for (std::size_t k = 0; k < azimuths; ++k) {
          const double in = cosine(i), out = cosine(j);
          const double phase = std::acos(std::clamp(
              in * out + sine(in) * sine(out) * std::cos(azimuth_width * static_cast<double>(k)), -1.0, 1.0));
          const double value = brightness(in, out, phase);
          if (!(value >= 0.0) || !std::isfinite(value))
            throw UsageError(fmt::format("the surface shows the I/F {:g} at the cosines {:g} of the source and {:g} of "
                                         "the observer and the phase angle {:g} degrees; it must be a number from 0 "
                                         "on, so correct it",
                                         value, in, out, phase * 180.0 / pi));
          values_[index(i, j, k)] = value / in;
          largest = std::max(largest, value);
        }
    if (!(largest > 0.0))
      throw UsageError("the surface shows the I/F 0 in all directions; give one that scatters light");
    const double scale = albedo / sphere_albedo();
    for (double& value : values_)
      value *= scale;
  }

  double brightness(const Vec3& normal, const Vec3& to, const Vec3& from) const override {
    const double in = normal.dot(from);
    return in > 0.0 ? in * over_cosine(normal, to, from) : 0.0;
  }

  // Directions have the density μ₀/π, so the weight is what is left of f/π.
  Scattering scatter(const Vec3& normal, const Vec3& to, RandomStream& random) const override {
    const Vec3 from = direction_about(normal, std::sqrt(random.uniform()), random);
    return {from, over_cosine(normal, to, from)};
  }

  bool of_particle() const override { return false; }

private:
  static constexpr std::size_t tilts = 37, azimuths = 73;
  static constexpr double tilt_width = 0.5 * pi / (tilts - 1), azimuth_width = pi / (azimuths - 1);
  static constexpr double min_cosine = 1e-3; // of the last node, which stands for the grazing direction

  static double cosine(std::size_t node) {
    return std::max(min_cosine, std::cos(tilt_width * static_cast<double>(node)));
  }
  static double sine(double cosine) { return std::sqrt(std::max(0.0, 1.0 - cosine * cosine)); }
  static std::size_t index(std::size_t in, std::size_t out, std::size_t azimuth) {
    return (in * tilts + out) * azimuths + azimuth;
  }

  // A place between two nodes.
  struct Place {
    std::size_t node;
    double part;

    Place(double position, std::size_t nodes)
        : node(std::min(static_cast<std::size_t>(position), nodes - 2)),
          part(std::min(1.0, position - static_cast<double>(node))) {}
  };

  double at(const Place& in, const Place& out, const Place& azimuth) const {
    const auto along = [&](std::size_t i, std::size_t j) {
      const double* const value = &values_[index(i, j, azimuth.node)];
      return std::lerp(value[0], value[1], azimuth.part);
    };
    return std::lerp(std::lerp(along(in.node, out.node), along(in.node, out.node + 1), out.part),
                     std::lerp(along(in.node + 1, out.node), along(in.node + 1, out.node + 1), out.part), in.part);
  }

  // Returns f/μ₀.
  double over_cosine(const Vec3& normal, const Vec3& to, const Vec3& from) const {
    const double in = std::clamp(normal.dot(from), 0.0, 1.0), out = std::clamp(normal.dot(to), 0.0, 1.0);
    const double across = sine(in) * sine(out);
    const double azimuth = across > 0.0 ? std::acos(std::clamp((to.dot(from) - in * out) / across, -1.0, 1.0)) : 0.0;
    return at({std::acos(in) / tilt_width, tilts}, {std::acos(out) / tilt_width, tilts},
              {azimuth / azimuth_width, azimuths});
  }

  // Returns the fraction of a beam that a sphere of this table scatters: light comes to a point with the density 2 μ₀
  // dμ₀ of the beam, and leaves with ∫ f μ dω/(π μ₀) of it.
  double sphere_albedo() const {
    constexpr int steps = 120, half = steps / 2;
    double sum = 0.0;
    for (int i = 0; i < steps; ++i)
      for (int j = 0; j < steps; ++j)
        for (int k = 0; k < half; ++k) {
          const double in = (i + 0.5) / steps, out = (j + 0.5) / steps;
          sum += in * out *
                 at({std::acos(in) / tilt_width, tilts}, {std::acos(out) / tilt_width, tilts},
                    {(k + 0.5) / half * (azimuths - 1), azimuths});
        }
    return 4.0 * sum / (steps * steps * half); // (2/π) ∫ dμ₀ 2 ∫ dμ ∫₀^π dφ f μ
  }

  std::vector<double> values_;
};

} // namespace

SharedLaw surface_law(const SurfaceFunction& brightness, double albedo) {
  return std::make_shared<Surface>(brightness, albedo);
}

} // namespace keeler::light
