#include <keeler/diagnostics/epicyclic_waves.hpp>

#include <keeler/core/exact_sum.hpp>
#include <keeler/core/units.hpp>
#include <keeler/diagnostics/dispersion.hpp>
#include <keeler/diagnostics/radial_modes.hpp>

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <complex>
#include <cstdint>
#include <span>

namespace keeler::diagnostics {
namespace {

using Complex = std::complex<double>;

// Returns the fraction of the mean square `all` in waves with squared amplitudes that add up to `squares`, corrected
// for the fraction `noise` of random particles. The mean square of a wave is half of the square of its amplitude.
double fraction(double squares, double all, double noise) {
  return all > 0.0 ? (0.5 * squares / all - noise) / (1.0 - noise) : 0.0;
}

// Squared amplitudes of the velocities, summed over the modes.
struct Squares {
  double x = 0.0, y = 0.0;

  void add(const Complex& velocity_x, const Complex& velocity_y) {
    x += std::norm(velocity_x);
    y += std::norm(velocity_y);
  }
};

// `random_density` is radial_mode_noise().
std::optional<EpicyclicWaves> waves_of(const Squares& squares, const Vec3& dispersion, double kappa,
                                       double random_density) {
  const double noise = 0.5 * box_long_modes * random_density * random_density;
  const double weight = 4.0 / (kappa * kappa); // of v_y² in the energy of an epicycle
  const double xx = dispersion.x() * dispersion.x(), yy = dispersion.y() * dispersion.y();
  const double motion = xx + weight * yy;
  if (!(noise < 0.5) || !(motion > 0.0))
    return std::nullopt;
  return EpicyclicWaves{fraction(squares.x + weight * squares.y, motion, noise), fraction(squares.x, xx, noise),
                        fraction(squares.y, yy, noise)};
}

constexpr std::size_t bins = 256; // of the guiding radius; a wavelength spans 64 or more

// Integer numbers of units: sums do not depend on their order, nor, modulo 2⁶⁴, on the ranks.
struct Binned {
  using Numbers = std::array<std::uint64_t, bins>;
  Numbers mass{}, cosine{}, sine{}; // Σ m, Σ m e cos φ, Σ m e sin φ
  std::uint64_t mass_squares = 0;

  Binned& operator+=(const Binned& more) {
    for (std::size_t b = 0; b < bins; ++b) {
      mass[b] += more.mass[b];
      cosine[b] += more.cosine[b];
      sine[b] += more.sine[b];
    }
    mass_squares += more.mass_squares;
    return *this;
  }

  void merge(const Communicator& ranks) {
    if (!ranks.distributed())
      return;
    for (Numbers* const numbers : {&mass, &cosine, &sine})
      ranks.sum(*numbers);
    ranks.sum(std::span(&mass_squares, 1));
  }
};

// Units for sums; the absolute values of the terms add up to at most `bound`, so sums stay below 2⁶² units.
class FixedPoint {
public:
  explicit FixedPoint(double bound) : per_one_(std::ldexp(1.0, 61 - std::ilogb(bound))) {}
  std::uint64_t count(double term) const {
    return static_cast<std::uint64_t>(static_cast<std::int64_t>(term * per_one_));
  }
  double value(std::uint64_t units) const { return static_cast<double>(static_cast<std::int64_t>(units)) / per_one_; }

private:
  double per_one_;
};

std::size_t bin_of(double guiding_x, double box_length) {
  const double turns = guiding_x / box_length + 0.5, width = static_cast<double>(bins);
  return static_cast<std::size_t>(std::min(width - 1.0, (turns - std::floor(turns)) * width));
}

// Σ m (e cos φ, e sin φ) of each bin relative to the mean motion, kg m, at the epoch.
struct EccentricityField {
  std::array<double, bins> cosine{}, sine{};
};

EccentricityField about_mean(const Binned& sums, const FixedPoint& kilogram, const FixedPoint& moment, double mass) {
  EccentricityField field;
  double mean_cosine = 0.0, mean_sine = 0.0;
  for (std::size_t b = 0; b < bins; ++b) {
    field.cosine[b] = moment.value(sums.cosine[b]);
    field.sine[b] = moment.value(sums.sine[b]);
    mean_cosine += field.cosine[b] / mass;
    mean_sine += field.sine[b] / mass;
  }
  for (std::size_t b = 0; b < bins; ++b) {
    field.cosine[b] -= mean_cosine * kilogram.value(sums.mass[b]);
    field.sine[b] -= mean_sine * kilogram.value(sums.mass[b]);
  }
  return field;
}

// Returns the squares of the velocities in the modes after a rotation. An amplitude is (2/M) Σ exp(−ikX) over the bins,
// corrected for their width.
Squares squares_of(const EccentricityField& field, double mass, double kappa, const Rotation& rotation) {
  Squares squares;
  for (int n = 1; n <= box_long_modes; ++n) {
    const double phase = two_pi * n / static_cast<double>(bins); // from bin to bin
    double sine = 0.0, cosine = 1.0;
    Complex e_cos, e_sin;
    for (std::size_t b = 0; b < bins; ++b) {
      hill::sine_cosine(phase * (static_cast<double>(b) + 0.5 * (1.0 - static_cast<double>(bins))), sine, cosine);
      const Complex wave(cosine, -sine);
      e_cos += field.cosine[b] * wave;
      e_sin += field.sine[b] * wave;
    }
    hill::sine_cosine(0.5 * phase, sine, cosine);
    const double scale = 2.0 / mass * (0.5 * phase / sine);
    squares.add(scale * kappa * (e_sin * rotation.cos_e + e_cos * rotation.sin_e),
                scale * 0.5 * kappa * kappa * (e_cos * rotation.cos_e - e_sin * rotation.sin_e));
  }
  return squares;
}

} // namespace

Vec3 EpicyclicWaves::residual_dispersion(const Vec3& dispersion) const {
  const auto rest = [](double part) { return std::sqrt(std::max(0.0, 1.0 - part)); };
  return {dispersion.x() * rest(x), dispersion.y() * rest(y), dispersion.z()};
}

std::optional<EpicyclicWaves> epicyclic_waves(const Patch& patch) {
  Squares squares;
  for (const RadialMode& mode : guiding_modes(patch, box_long_modes))
    squares.add(mode.velocity_x, mode.velocity_y);
  return waves_of(squares, velocity_dispersion(patch), patch.frequencies.kappa, radial_mode_noise(patch));
}

// Bounds the sums in advance by the Cauchy-Schwarz inequality, Σ m |e cos φ| ≤ √(Σ m Σ m e²).
std::optional<EpicyclicWaves> epicyclic_waves(const Particles& particles, double box_length,
                                              const Frequencies& frequencies, double after, const ParticleMeans& means,
                                              const Communicator& ranks) {
  assert(box_length > 0.0 && frequencies.kappa > 0.0);
  const double bound = std::sqrt(2.0 * means.mass * means.epicyclic_energy) / frequencies.kappa;
  if (!std::isfinite(bound) || !(bound > 0.0))
    return std::nullopt;
  const FixedPoint kilogram(means.mass), square(means.mass * means.mass), moment(bound);
  Binned sums = exact_total<Binned>(particles.size(), [&](Binned& total, std::size_t k) {
    particles.prefetch_after(k);
    const auto& [elements, radius, mass] = particles.bodies[k];
    const std::size_t b = bin_of(elements.guiding_x, box_length);
    total.mass[b] += kilogram.count(mass);
    total.cosine[b] += moment.count(mass * elements.e_cos);
    total.sine[b] += moment.count(mass * elements.e_sin);
    total.mass_squares += square.count(mass * mass);
  });
  sums.merge(ranks);
  const EccentricityField field = about_mean(sums, kilogram, moment, means.mass);
  return waves_of(squares_of(field, means.mass, frequencies.kappa, Rotation(frequencies, after)), means.dispersion,
                  frequencies.kappa, 2.0 * std::sqrt(square.value(sums.mass_squares)) / means.mass);
}

} // namespace keeler::diagnostics
