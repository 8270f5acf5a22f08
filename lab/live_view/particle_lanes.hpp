// Four particles at a time, in single precision: what a frame needs of them, read from the store or from a patch.
#pragma once

#include <keeler/forces/force.hpp>
#include <keeler/particles/patch.hpp>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace keeler::live_view {

typedef float Four __attribute__((vector_size(16))); ///< one number of four particles

inline Four four(float value) {
  return Four{value, value, value, value};
}

/// Places and radii (m), and the speed relative to the shear (m rad⁻¹) where it is asked for.
struct Lanes {
  Four x, y, z, radius, speed;
};

/// The indices of four shown particles; at the end the last one is repeated.
struct FourIndices {
  std::uint32_t k[4];

  FourIndices(const std::vector<std::uint32_t>& chosen, std::size_t first) {
    assert(first < chosen.size());
    for (std::size_t lane = 0; lane < 4; ++lane)
      k[lane] = chosen[std::min(first + lane, chosen.size() - 1)];
  }
};

/// Takes the epicycles of bodies to this boundary, as state_at() does.
class BodyLanes {
public:
  explicit BodyLanes(const forces::Boundary& boundary) : particles_(boundary.particles) {
    const Rotation r = boundary.rotation();
    const Frequencies& f = boundary.frequencies;
    cos_e_ = four(static_cast<float>(r.cos_e)), sin_e_ = four(static_cast<float>(r.sin_e));
    cos_i_ = four(static_cast<float>(r.cos_i)), sin_i_ = four(static_cast<float>(r.sin_i));
    drift_ = four(static_cast<float>(-f.shear() * r.after));
    stretch_ = four(static_cast<float>(2.0 / f.kappa));
    kappa_ = four(static_cast<float>(f.kappa)), nu_ = four(static_cast<float>(f.nu));
    along_ = four(static_cast<float>(2.0 - f.shear()));
  }

  template<bool with_speed> Lanes read(const FourIndices& at) const {
    Four low[4], high[4];
    for (int lane = 0; lane < 4; ++lane) {
      particles_.prefetch_after(at.k[lane]);
      const auto* const numbers = reinterpret_cast<const FourDoubles*>(&particles_.bodies[at.k[lane]]);
      low[lane] = __builtin_convertvector(numbers[0], Four);
      high[lane] = __builtin_convertvector(numbers[1], Four);
    }
    transpose(low);
    transpose(high);
    const Four guiding_x = low[0], guiding_y = low[1], e_cos = low[2], e_sin = low[3];
    const Four i_sin = high[0], i_cos = high[1];
    const Four ec = e_cos * cos_e_ - e_sin * sin_e_, es = e_sin * cos_e_ + e_cos * sin_e_;
    Lanes lanes;
    lanes.x = guiding_x - ec;
    lanes.y = guiding_y + drift_ * guiding_x + stretch_ * es;
    lanes.z = i_sin * cos_i_ + i_cos * sin_i_;
    lanes.radius = high[2];
    lanes.speed = four(0.0F);
    if constexpr (with_speed) {
      const Four u = kappa_ * es, v = along_ * ec, w = nu_ * (i_cos * cos_i_ - i_sin * sin_i_);
      const Four square = u * u + v * v + w * w;
      for (int lane = 0; lane < 4; ++lane)
        lanes.speed[lane] = std::sqrt(square[lane]);
    }
    return lanes;
  }

private:
  typedef double FourDoubles __attribute__((vector_size(32), may_alias));
  static_assert(sizeof(Body) == 8 * sizeof(double) && offsetof(Body, radius) == 6 * sizeof(double));
  static_assert(offsetof(Elements, e_cos) == 2 * sizeof(double) && offsetof(Elements, i_sin) == 4 * sizeof(double));

  static void transpose(Four (&rows)[4]) {
    const Four a = __builtin_shufflevector(rows[0], rows[1], 0, 4, 1, 5);
    const Four b = __builtin_shufflevector(rows[2], rows[3], 0, 4, 1, 5);
    const Four c = __builtin_shufflevector(rows[0], rows[1], 2, 6, 3, 7);
    const Four d = __builtin_shufflevector(rows[2], rows[3], 2, 6, 3, 7);
    rows[0] = __builtin_shufflevector(a, b, 0, 1, 4, 5);
    rows[1] = __builtin_shufflevector(a, b, 2, 3, 6, 7);
    rows[2] = __builtin_shufflevector(c, d, 0, 1, 4, 5);
    rows[3] = __builtin_shufflevector(c, d, 2, 3, 6, 7);
  }

  const Particles& particles_;
  Four cos_e_, sin_e_, cos_i_, sin_i_, drift_, stretch_, kappa_, nu_, along_;
};

inline Lanes patch_lanes(const Patch& patch, const FourIndices& at) {
  Lanes lanes{};
  for (int lane = 0; lane < 4; ++lane) {
    const std::size_t k = at.k[lane];
    lanes.x[lane] = static_cast<float>(patch.positions[k].x());
    lanes.y[lane] = static_cast<float>(patch.positions[k].y());
    lanes.z[lane] = static_cast<float>(patch.positions[k].z());
    lanes.radius[lane] = static_cast<float>(patch.radii[k]);
  }
  return lanes;
}

} // namespace keeler::live_view
