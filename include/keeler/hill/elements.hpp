// Epicycles in Hill's frame: x radial outward, y along the orbit, z up; Omega = 1.
//
//   x = X − e cos φ     y = Y + (2/κ) e sin φ     z = i sin ζ      dφ/dt = κ, dζ/dt = ν, dY/dt = −S X
//
// Eccentricity and inclination are stored as vectors at an epoch common to all particles: nothing is singular at e = 0
// or i = 0, a velocity change is linear in the elements, and one rotation per instant serves all particles.
#pragma once

#include <keeler/core/vector.hpp>

#include <cmath>

namespace keeler::hill {

/// Epicyclic and vertical frequency in units of the orbital frequency.
struct Frequencies {
  double kappa = 1.0; ///< κ/Ω
  double nu = 1.0;    ///< ν/Ω

  /// Returns the shear rate S = (4 − κ²)/2: guiding centres drift at −S X.
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

  double eccentricity() const { return std::sqrt(e_cos * e_cos + e_sin * e_sin); } ///< e, m
  double inclination() const { return std::sqrt(i_sin * i_sin + i_cos * i_cos); }  ///< i, m
};

/// Returns the relative elements of b and a: the relative motion of two particles is again an epicycle. Precondition:
/// both are at the common epoch.
inline Elements operator-(const Elements& b, const Elements& a) {
  return {b.guiding_x - a.guiding_x, b.guiding_y - a.guiding_y, b.e_cos - a.e_cos,
          b.e_sin - a.e_sin,         b.i_sin - a.i_sin,         b.i_cos - a.i_cos};
}

/// The rotation of all epicycles from the epoch to a time `after` it: computed once and used for all particles.
struct Rotation {
  double after = 0.0; ///< time since the epoch, rad
  double cos_e = 1.0; ///< cos(κ after)
  double sin_e = 0.0; ///< sin(κ after)
  double cos_i = 1.0; ///< cos(ν after)
  double sin_i = 0.0; ///< sin(ν after)

  Rotation() = default;
  Rotation(const Frequencies& frequencies, double after); ///< after: rad
};

/// Position (m) and velocity (m per rad) in Hill's frame.
struct State {
  Vec3 position = Vec3::Zero(); ///< m
  Vec3 velocity = Vec3::Zero(); ///< m rad⁻¹, shear included
};

/// Computes sine and cosine by polynomials (arguments up to about 1e5; error below 1.5 ulp of 1). They use only
/// additions, products and roundings of doubles, so the bits are equal on all machines if compiled without contraction.
/// The C library selects its code by processor.
void sine_cosine(double angle, double& sine, double& cosine);

/// Returns position and velocity at the time of the rotation.
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

/// Inverse of state_at(): returns the elements at the epoch from the state at the time of the rotation.
Elements elements_from(const State& state, const Frequencies& f, const Rotation& r);

/// Applies a velocity change at the time of the rotation. It is linear in the elements and needs no further
/// trigonometry.
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

/// Returns the velocity along y relative to the local shear, ẏ + S x = ½κ² e cos φ, at the time of the rotation.
inline double azimuthal_velocity(const Elements& el, const Frequencies& f, const Rotation& r) {
  return 0.5 * f.kappa * f.kappa * (el.e_cos * r.cos_e - el.e_sin * r.sin_e);
}

/// Returns the velocity relative to the local shear at the time of the rotation. It is equal for all images.
inline Vec3 peculiar_velocity(const Elements& el, const Frequencies& f, const Rotation& r) {
  return {f.kappa * (el.e_sin * r.cos_e + el.e_cos * r.sin_e), azimuthal_velocity(el, f, r),
          f.nu * (el.i_cos * r.cos_i - el.i_sin * r.sin_i)};
}

/// Returns the energy per mass of the epicycle, ½κ²e² + ½ν²i² (m² rad⁻²), equal for all images. With the velocity c
/// relative to the local shear it is ½c² + ½ν²z² + (S/κ²) c_y².
inline double epicyclic_energy(const Elements& el, const Frequencies& f) {
  return 0.5 * f.kappa * f.kappa * (el.e_cos * el.e_cos + el.e_sin * el.e_sin) +
         0.5 * f.nu * f.nu * (el.i_sin * el.i_sin + el.i_cos * el.i_cos);
}

/// A rotation that is applied repeatedly. It adds small increments, with the low-order part of the sine, so that 10^7
/// turns accumulate a random walk of roundings but no drift of phase or length.
struct FixedRotation {
  double sine;             ///< of the angle, rounded
  double sine_low;         ///< the sine beyond `sine`
  double one_minus_cosine; ///< 1 − cosine of the angle

  explicit FixedRotation(double angle); ///< rad

  /// Rotates (c, s) by the angle: (cos φ, sin φ) becomes (cos(φ + angle), sin(φ + angle)).
  void turn(double& c, double& s) const {
    const double dc = (c * one_minus_cosine + s * sine_low) + s * sine;
    const double ds = (s * one_minus_cosine - c * sine_low) - c * sine;
    c -= dc;
    s -= ds;
  }
};

/// Advances elements to an epoch one fixed interval (rad) later.
class Rebase {
public:
  Rebase(const Frequencies& f, double interval); ///< interval: rad
  /// Advances the elements of a particle.
  void operator()(Elements& el) const {
    el.guiding_y -= shift_ * el.guiding_x;
    e_.turn(el.e_cos, el.e_sin);
    i_.turn(el.i_cos, el.i_sin);
  }

private:
  double shift_; // S × interval
  FixedRotation e_, i_;
};

} // namespace keeler::hill

namespace keeler {
using hill::Frequencies, hill::Elements, hill::Rotation, hill::State;
} // namespace keeler
