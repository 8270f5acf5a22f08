// Text of the mesh solver's kernels; see mesh_kernels.hpp. The including file sets KEELER_KERNEL_SPACE and
// KEELER_LANES, defines Lanes, and
//   Lanes difference(const double* from, double origin)     of KEELER_LANES numbers, in double, then rounded
//   void append(NearSources&, x, y, z, mass, inside)        the lanes where the integer vector `inside` is not 0
// Everything here has internal linkage except `mesh`.

namespace keeler::KEELER_KERNEL_SPACE {
namespace {

inline Lanes load(const float* from) {
  return *reinterpret_cast<const Lanes*>(from);
}

inline void store(float* to, const Lanes& value) {
  *reinterpret_cast<Lanes*>(to) = value;
}

inline Lanes positive(const Lanes& value) {
  return value > 0.0f ? value : Lanes{};
}

void gather(NearSources& sources, const NearRange& range, const NearGroup& group) {
  const float scale = static_cast<float>(group.scale);
  for (std::size_t k = 0; k < range.count; k += KEELER_LANES) {
    const Lanes x = difference(range.x + k, group.origin_x) * scale;
    const Lanes y = difference(range.y + k, group.origin_y) * scale;
    const Lanes z = difference(range.z + k, group.origin_z) * scale;
    const Lanes gap_x = positive(group.low[0] - x) + positive(x - group.high[0]);
    const Lanes gap_y = positive(group.low[1] - y) + positive(y - group.high[1]);
    const Lanes gap_z = positive(group.low[2] - z) + positive(z - group.high[2]);
    const Lanes gap2 = gap_x * gap_x + gap_y * gap_y + gap_z * gap_z;
    const int left = range.count - k < KEELER_LANES ? static_cast<int>(range.count - k) : KEELER_LANES;
    const Lanes mass = *reinterpret_cast<const LanesInRow*>(range.mass + k);
    append(sources, x, y, z, mass, (gap2 < 1.0f) & (lane_numbers < left));
  }
}

// 1/√value by a guess from the bits and two of Newton's steps, the first one tuned (Moroz et al. 2018 have its
// constants): relative error below 7e-7.
inline Lanes reciprocal_root(const Lanes& value) {
  const IntLanes bits = 0x5f1ffff9 - (reinterpret_cast<const IntLanes&>(value) >> 1);
  const Lanes guess = reinterpret_cast<const Lanes&>(bits);
  const Lanes better = guess * (1.6819135f - 0.703952253f * value * guess * guess);
  return better * (1.5f - 0.5f * value * better * better);
}

void attract(NearTargets& t, std::size_t target_count, const NearSources& s, const float* inside) {
  for (std::size_t b = 0; b < target_count; b += KEELER_LANES) {
    const Lanes x = load(t.x + b), y = load(t.y + b), z = load(t.z + b);
    Lanes ax = load(t.ax + b), ay = load(t.ay + b), az = load(t.az + b);
    for (std::size_t k = 0; k < s.count; ++k) {
      const Lanes dx = s.x[k] - x, dy = s.y[k] - y, dz = s.z[k] - z;
      const Lanes d2 = dx * dx + dy * dy + dz * dz;
      const Lanes inverse = reciprocal_root(d2);
      Lanes cloud = inside[5] * d2 + inside[4];
      cloud = cloud * d2 + inside[3];
      cloud = cloud * d2 + inside[2];
      cloud = cloud * d2 + inside[1];
      cloud = cloud * d2 + inside[0];
      const Lanes weight = s.mass[k] * (inverse * inverse * inverse - cloud);
      const Lanes used = (d2 < 1.0f) & (d2 > same_near_place_squared) ? weight : Lanes{};
      ax += used * dx;
      ay += used * dy;
      az += used * dz;
    }
    store(t.ax + b, ax);
    store(t.ay + b, ay);
    store(t.az + b, az);
  }
}

void convolve(const float* from, std::size_t planes, const float* near, std::size_t reach, const float* far,
              const float* decay, float* to, std::size_t stride) {
  for (std::size_t b = 0; b < 16; b += KEELER_LANES) {
    const Lanes rate = load(decay + b), far_factor = load(far + b);
    Lanes below{};
    for (std::size_t k = 0; k < planes; ++k) {
      const float* const here = from + 16 * k + b;
      below = rate * (below + load(here - 16));
      Lanes sum = load(near + b) * load(here) + far_factor * below;
      for (std::size_t l = 1; l <= reach; ++l)
        sum += load(near + 16 * l + b) * (load(here - 16 * l) + load(here + 16 * l));
      store(to + k * stride + b, sum);
    }
    Lanes above{};
    for (std::size_t k = planes; k-- > 0;) {
      above = rate * (above + load(from + 16 * (k + 1) + b));
      store(to + k * stride + b, load(to + k * stride + b) + far_factor * above);
    }
  }
}

} // namespace

extern const MeshKernels mesh;
const MeshKernels mesh = {gather, attract, convolve};

} // namespace keeler::KEELER_KERNEL_SPACE
