// Source of the mesh solver's kernels (mesh_kernels.hpp). The including file sets KEELER_KERNEL_SPACE and
// KEELER_LANES, defines Lanes, LanesInRow (anywhere in a row), IntLanes, lane_numbers, and
//   Lanes difference(const double* from, double origin)     KEELER_LANES differences in double, then rounded
//   std::size_t append(NearSources&, std::size_t count, x, y, z, mass, inside)
//                                                           appends the lanes where the integer vector `inside` is not
//                                                           0 to the first `count` sources; returns the new count
//   Sixteen rows(const float* from, std::size_t stride)     loads four values from each of four rows
//   void put_rows(float* to, std::size_t stride, const Sixteen&)
//   Sixteen each_row(const Four&), all_rows(const Four&)    value r in all of row r; the four values in every row
//   Four rows_sum(const Sixteen&)                           (row 0 + row 2) + (row 1 + row 3)
// Everything here has internal linkage except `mesh`.

namespace keeler::gravity::KEELER_KERNEL_SPACE {
namespace {

constexpr int parts = 16 / KEELER_LANES;

inline Lanes load(const float* from) {
  return *reinterpret_cast<const Lanes*>(from);
}

inline void store(float* to, const Lanes& value) {
  *reinterpret_cast<Lanes*>(to) = value;
}

// Returns the distance of a coordinate beyond ± half.
inline Lanes beyond(const Lanes& coordinate, float half) {
  const IntLanes bits = reinterpret_cast<const IntLanes&>(coordinate) & 0x7fffffff;
  const Lanes gap = reinterpret_cast<const Lanes&>(bits) - half;
  return gap > 0.0f ? gap : Lanes{};
}

inline Sixteen operator*(const Sixteen& a, const Sixteen& b) {
  Sixteen result;
  for (int p = 0; p < parts; ++p)
    result.part[p] = a.part[p] * b.part[p];
  return result;
}

inline Sixteen operator*(float a, const Sixteen& b) {
  Sixteen result;
  for (int p = 0; p < parts; ++p)
    result.part[p] = a * b.part[p];
  return result;
}

inline Sixteen operator+(const Sixteen& a, const Sixteen& b) {
  Sixteen result;
  for (int p = 0; p < parts; ++p)
    result.part[p] = a.part[p] + b.part[p];
  return result;
}

// Returns the sums of three times sixteen numbers: over the rows, then in halves.
inline Four sums(const Sixteen& x, const Sixteen& y, const Sixteen& z) {
  const Four a = rows_sum(x), b = rows_sum(y), c = rows_sum(z);
  const Four ab = __builtin_shufflevector(a, b, 0, 1, 4, 5) + __builtin_shufflevector(a, b, 2, 3, 6, 7);
  const Four cc = c + __builtin_shufflevector(c, c, 2, 3, 0, 1);
  return __builtin_shufflevector(ab, cc, 0, 2, 4, 4) + __builtin_shufflevector(ab, cc, 1, 3, 5, 5);
}

void gather(NearSources& sources, const ParticleRange& range, const NearGroup& group) {
  std::size_t count = sources.count;
  for (std::size_t k = 0; k < range.count; k += KEELER_LANES) {
    const Lanes x = difference(range.x + k, group.origin_x) * group.scale;
    const Lanes y = difference(range.y + k, group.origin_y) * group.scale;
    const Lanes z = difference(range.z + k, group.origin_z) * group.scale;
    const Lanes gap_x = beyond(x, group.half[0]), gap_y = beyond(y, group.half[1]), gap_z = beyond(z, group.half[2]);
    const Lanes gap2 = gap_x * gap_x + gap_y * gap_y + gap_z * gap_z;
    const int left = range.count - k < KEELER_LANES ? static_cast<int>(range.count - k) : KEELER_LANES;
    const Lanes mass = *reinterpret_cast<const LanesInRow*>(range.mass + k);
    count = append(sources, count, x, y, z, mass, (gap2 < 1.0f) & (lane_numbers < left));
  }
  sources.count = count;
}

// Returns value^(−3/2): an estimate g of 1/√value from the bits, within 3.5 %, and a polynomial for (value g²)^(−3/2),
// within 7e-6.
inline Lanes inverse_cube(const Lanes& value) {
  const IntLanes bits = 0x5f3759df - (reinterpret_cast<const IntLanes&>(value) >> 1);
  const Lanes guess = reinterpret_cast<const Lanes&>(bits);
  const Lanes square = guess * guess, near_one = value * square;
  return guess * square * (6.57925456f - near_one * (11.85124836f - near_one * (8.46472286f - near_one * 2.19273577f)));
}

// Pads the list with massless sources to a multiple of sixteen; returns its length.
std::size_t padded_length(NearSources& s) {
  const std::size_t padded = (s.count + 15) / 16 * 16;
  for (std::size_t k = s.count; k < padded; ++k) {
    s.x[k] = s.y[k] = s.z[k] = 1.0f;
    s.mass[k] = 0.0f;
  }
  return padded;
}

void attract(NearTargets& t, std::size_t target_count, NearSources& s, const float* inside) {
  const std::size_t padded = padded_length(s);
  for (std::size_t i = 0; i < target_count; ++i) {
    const float x = t.x[i], y = t.y[i], z = t.z[i];
    Sixteen ax{}, ay{}, az{};
    for (std::size_t k = 0; k < padded; k += 16)
      for (int p = 0; p < parts; ++p) {
        const std::size_t at = k + static_cast<std::size_t>(p * KEELER_LANES);
        const Lanes dx = load(s.x + at) - x, dy = load(s.y + at) - y, dz = load(s.z + at) - z;
        const Lanes d2 = dx * dx + (dy * dy + (dz * dz + min_near_distance_squared));
        const Lanes cloud = ((inside[3] * d2 + inside[2]) * d2 + inside[1]) * d2 + inside[0];
        const Lanes weight = load(s.mass + at) * (inverse_cube(d2) - cloud);
        const Lanes used = d2 < 1.0f ? weight : Lanes{};
        ax.part[p] += used * dx;
        ay.part[p] += used * dy;
        az.part[p] += used * dz;
      }
    const Four gathered = sums(ax, ay, az);
    t.ax[i] += gathered[0];
    t.ay[i] += gathered[1];
    t.az[i] += gathered[2];
  }
}

void energy(NearTargets& t, std::size_t target_count, NearSources& s, const float* inside, const float* cloud) {
  const std::size_t padded = padded_length(s);
  for (std::size_t i = 0; i < target_count; ++i) {
    const float x = t.x[i], y = t.y[i], z = t.z[i];
    Sixteen potential{}, stress{};
    for (std::size_t k = 0; k < padded; k += 16)
      for (int p = 0; p < parts; ++p) {
        const std::size_t at = k + static_cast<std::size_t>(p * KEELER_LANES);
        const Lanes dx = load(s.x + at) - x, dy = load(s.y + at) - y, dz = load(s.z + at) - z;
        const Lanes d2 = dx * dx + (dy * dy + (dz * dz + min_near_distance_squared)), cube = inverse_cube(d2);
        const Lanes smooth = (((cloud[4] * d2 + cloud[3]) * d2 + cloud[2]) * d2 + cloud[1]) * d2 + cloud[0];
        const Lanes pull = cube - (((inside[3] * d2 + inside[2]) * d2 + inside[1]) * d2 + inside[0]);
        const Lanes mass = d2 < 1.0f ? load(s.mass + at) : Lanes{};
        const Lanes others = d2 > 2.0f * min_near_distance_squared ? mass : Lanes{};
        potential.part[p] += others * (d2 * cube - smooth);
        stress.part[p] += others * dx * dy * pull;
      }
    const Four gathered = sums(potential, stress, Sixteen{});
    t.ax[i] += gathered[0];
    t.ay[i] += gathered[1];
  }
}

// The position of a particle on the mesh: its lowest node, and the position in its cell along x, y, z, in [0, 1].
struct MeshPosition {
  MeshPosition(const MeshView& mesh, const ParticleRange& range, std::size_t k) {
    const double position[3] = {range.x[k], range.y[k], range.z[k]};
    std::size_t cell[3];
    for (int axis = 0; axis < 3; ++axis) {
      const double in_cells = (position[axis] - mesh.corner[axis]) * mesh.per_metre[axis];
      cell[axis] = in_cells > 0.0 ? static_cast<std::size_t>(in_cells) : 0;
      if (cell[axis] >= mesh.cells[axis])
        cell[axis] = mesh.cells[axis] - 1; // by rounding a coordinate may be on the far edge
      fraction[axis] = static_cast<float>(in_cells - static_cast<double>(cell[axis]));
    }
    node = mesh.values + (cell[0] - mesh.first_column) * mesh.column_length + cell[2] * mesh.row_length + cell[1];
  }
  float* node;
  float fraction[3];
};

// Returns the weights of the four nodes around a particle at t in [0, 1] of its cell: the cubic B-spline.
inline Four weights(float t) {
  const Four constant = {1.0f / 6, 4.0f / 6, 1.0f / 6, 0.0f}, linear = {-0.5f, 0.0f, 0.5f, 0.0f};
  const Four square = {0.5f, -1.0f, 0.5f, 0.0f}, cube = {-1.0f / 6, 0.5f, -0.5f, 1.0f / 6};
  return constant + t * (linear + t * (square + t * cube));
}

// Returns the derivatives of the weights, per spacing.
inline Four derivatives(float t) {
  const Four linear = {-0.5f, 0.0f, 0.5f, 0.0f}, square = {1.0f, -2.0f, 1.0f, 0.0f};
  const Four cube = {-0.5f, 1.5f, -1.5f, 0.5f};
  return linear + t * (square + t * cube);
}

void spread(const MeshView& mesh, const ParticleRange& range) {
  for (std::size_t k = 0; k < range.count; ++k) {
    const MeshPosition at(mesh, range, k);
    const Four x = range.mass[k] * weights(at.fraction[0]);
    const Sixteen flat = each_row(weights(at.fraction[2])) * all_rows(weights(at.fraction[1]));
    for (std::size_t a = 0; a < 4; ++a) {
      float* const nodes = at.node + a * mesh.column_length;
      put_rows(nodes, mesh.row_length, rows(nodes, mesh.row_length) + x[a] * flat);
    }
  }
}

// Returns first sin 2πt + second sin 4πt for t in [0, 1], by polynomials in v = 2t − 1: sin πv within 2e-5, cos πv
// within 0.01 (it contributes 8 % of the sum).
inline Four harmonics(const Four& t, const SelfForce& self) {
  const Four v = 2.0f * t - 1.0f, v2 = v * v;
  const Four sine = v * (1.0f - v2) * (3.1415451f - v2 * (2.0245943f - v2 * (0.5163292f - 0.0625282f * v2)));
  const Four cosine = (1.0f - 4.0f * v2) * (1.0f - v2 * (0.9348f - 0.2681f * v2));
  const Four first = {self.first[0], self.first[1], self.first[2], 0.0f};
  const Four second = {self.second[0], self.second[1], self.second[2], 0.0f};
  return sine * (2.0f * second * cosine - first);
}

void interpolate(const MeshView& mesh, const ParticleRange& range, const SelfForce& self, float* x, float* y,
                 float* z) {
  const Four per_metre = {static_cast<float>(mesh.per_metre[0]), static_cast<float>(mesh.per_metre[1]),
                          static_cast<float>(mesh.per_metre[2]), 0.0f};
  for (std::size_t k = 0; k < range.count; ++k) {
    const MeshPosition at(mesh, range, k);
    const Four weight_x = weights(at.fraction[0]), derivative_x = derivatives(at.fraction[0]);
    Sixteen flat{}, sloping{}; // sums over x
    for (std::size_t a = 0; a < 4; ++a) {
      const Sixteen nodes = rows(at.node + a * mesh.column_length, mesh.row_length);
      flat = flat + weight_x[a] * nodes;
      sloping = sloping + derivative_x[a] * nodes;
    }
    const Sixteen weight_y = all_rows(weights(at.fraction[1])), weight_z = each_row(weights(at.fraction[2]));
    const Sixteen along_y = flat * weight_z * all_rows(derivatives(at.fraction[1]));
    const Sixteen along_z = flat * weight_y * each_row(derivatives(at.fraction[2]));
    const Four gradient = sums(sloping * weight_z * weight_y, along_y, along_z);
    const Four fractions = {at.fraction[0], at.fraction[1], at.fraction[2], 0.0f};
    const Four result = gradient * per_metre - range.mass[k] * harmonics(fractions, self);
    x[k] = result[0];
    y[k] = result[1];
    z[k] = result[2];
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
      Lanes total = load(near + b) * load(here) + far_factor * below;
      for (std::size_t l = 1; l <= reach; ++l)
        total += load(near + 16 * l + b) * (load(here - 16 * l) + load(here + 16 * l));
      store(to + k * stride + b, total);
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
const MeshKernels mesh = {gather, attract, energy, spread, interpolate, convolve};

} // namespace keeler::gravity::KEELER_KERNEL_SPACE
