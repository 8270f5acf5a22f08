// Epicycles in Hill's frame: x radial outward, y along the orbit, z up; Omega = 1.
//
//   x = X − e cos φ     y = Y + (2/κ) e sin φ     z = i sin ζ      dφ/dt = κ, dζ/dt = ν, dY/dt = −S X
//
// The eccentricity and the inclination are kept as vectors at an epoch shared by all particles: nothing is singular at
// e = 0 or i = 0, a velocity change is linear in the elements, and one rotation a time serves every particle.
#pragma once

#include <keeler/core/vector.hpp>

#include <cmath>

namespace keeler {

/// Epicyclic and vertical frequency in units of the orbital frequency.
struct Frequencies {
  double kappa = 1.0;
  double nu = 1.0;

  /// Shear rate S = (4 − κ²)/2: guiding centres drift at −S X.
  double shear() const { return 0.5 * (4.0 - kappa * kappa); }
};

/// Guiding-centre elements at an epoch, in metres.
struct Elements {
  double guiding_x = 0.0; ///< X
  double guiding_y = 0.0; ///< Y at the epoch
  double e_cos = 0.0;     ///< e cos φ at the epoch
  double e_sin = 0.0;     ///< e sin φ
  double i_sin = 0.0;     ///< i sin ζ at the epoch
  double i_cos = 0.0;     ///< i cos ζ

  double eccentricity() const { return std::sqrt(e_cos * e_cos + e_sin * e_sin); }
  double inclination() const { return std::sqrt(i_sin * i_sin + i_cos * i_cos); }
};

/// Elements of b minus those of a at one epoch: the relative motion of two particles is again an epicycle.
inline Elements operator-(const Elements& b, const Elements& a) {
  return {b.guiding_x - a.guiding_x, b.guiding_y - a.guiding_y, b.e_cos - a.e_cos,
          b.e_sin - a.e_sin,         b.i_sin - a.i_sin,         b.i_cos - a.i_cos};
}

/// The rotation of all epicycles from the epoch to a time `after` it: computed once, used for every particle.
struct Rotation {
  double after = 0.0; ///< time since the epoch, rad
  double cos_e = 1.0, sin_e = 0.0;
  double cos_i = 1.0, sin_i = 0.0;

  Rotation() = default;
  Rotation(const Frequencies& frequencies, double after);
};

/// Position (m) and velocity (m per rad) in Hill's frame.
struct State {
  Vec3 position = Vec3::Zero();
  Vec3 velocity = Vec3::Zero();
};

/// Sine and cosine from our own polynomials (arguments up to about 1e5). Only sums, products and roundings of doubles,
/// so the same bits wherever they are compiled without contraction; the C library picks its code by processor. Error
/// below 1.5 units in the last place of 1.
void sine_cosine(double angle, double& sine, double& cosine);

/// Position and velocity at the rotation's time.
inline State state_at(const Elements& el, const Frequencies& f, const Rotation& r) {
  const double ec = el.e_cos * r.cos_e - el.e_sin * r.sin_e;
  const double es = el.e_sin * r.cos_e + el.e_cos * r.sin_e;
  const double is = el.i_sin * r.cos_i + el.i_cos * r.sin_i;
  const double ic = el.i_cos * r.cos_i - el.i_sin * r.sin_i;
  const double drift = f.shear() * el.guiding_x;
  State s;
  s.position = Vec3(el.guiding_x - ec, el.guiding_y - drift * r.after + (2.0 / f.kappa) * es, is);
  s.velocity = Vec3(f.kappa * es, 2.0 * ec - drift, f.nu * ic);
  return s;
}

/// The elements, at the epoch, of a particle that has this position and velocity at the rotation's time.
Elements elements_from(const State& state, const Frequencies& f, const Rotation& r);

/// Adds a velocity change made at the rotation's time: linear in the elements, no trigonometry beyond the rotation.
inline void kick(Elements& el, const Vec3& dv, const Frequencies& f, const Rotation& r) {
  const double a = 2.0 / (f.kappa * f.kappa);
  const double d_x = a * dv.y(); // ΔX = Δ(e cos φ)
  const double d_es = dv.x() / f.kappa;
  const double d_ic = dv.z() / f.nu;
  el.guiding_x += d_x;
  el.guiding_y += f.shear() * d_x * r.after - a * dv.x();
  el.e_cos += d_x * r.cos_e + d_es * r.sin_e;
  el.e_sin += d_es * r.cos_e - d_x * r.sin_e;
  el.i_sin -= d_ic * r.sin_i;
  el.i_cos += d_ic * r.cos_i;
}

/// Velocity along y beyond the shear at the particle's own place, ẏ + S x = ½κ² e cos φ, at the rotation's time.
inline double azimuthal_velocity(const Elements& el, const Frequencies& f, const Rotation& r) {
  return 0.5 * f.kappa * f.kappa * (el.e_cos * r.cos_e - el.e_sin * r.sin_e);
}

/// Velocity beyond the shear at the particle's own place, at the rotation's time: the same for all images.
inline Vec3 peculiar_velocity(const Elements& el, const Frequencies& f, const Rotation& r) {
  return {f.kappa * (el.e_sin * r.cos_e + el.e_cos * r.sin_e), azimuthal_velocity(el, f, r),
          f.nu * (el.i_cos * r.cos_i - el.i_sin * r.sin_i)};
}

/// Energy per mass of a particle's own epicycle, ½κ²e² + ½ν²i², in m² rad⁻²: the same for all images. It is
/// ½c² + ½ν²z² + (S/κ²) c_y², c the velocity beyond the shear.
inline double epicyclic_energy(const Elements& el, const Frequencies& f) {
  return 0.5 * f.kappa * f.kappa * (el.e_cos * el.e_cos + el.e_sin * el.e_sin) +
         0.5 * f.nu * f.nu * (el.i_sin * el.i_sin + el.i_cos * el.i_cos);
}

/// A rotation applied over and over. Written as a small change, with the low-order part of the sine added where it
/// still counts, so that 10^7 turns leave a random walk of roundings and no drift of phase or length.
struct FixedRotation {
  double sine, sine_low, one_minus_cosine;

  explicit FixedRotation(double angle);

  void turn(double& c, double& s) const {
    const double dc = (c * one_minus_cosine + s * sine_low) + s * sine;
    const double ds = (s * one_minus_cosine - c * sine_low) - c * sine;
    c -= dc;
    s -= ds;
  }
};

/// Moves elements to an epoch one fixed interval (rad) later.
class Rebase {
public:
  Rebase(const Frequencies& f, double interval);
  void operator()(Elements& el) const {
    el.guiding_y -= shift_ * el.guiding_x;
    e_.turn(el.e_cos, el.e_sin);
    i_.turn(el.i_cos, el.i_sin);
  }

private:
  double shift_; // S × interval
  FixedRotation e_, i_;
};

} // namespace keeler
