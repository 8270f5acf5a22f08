// Source of the kernels (kernels.hpp). The including file sets KEELER_KERNEL_SPACE and KEELER_LANES and defines the
// vectors of one register: Lanes and Longs (of doubles and 64-bit integers), Floats and Ints (twice as many lanes), and
// larger(a, b), which is a > b ? a : b.

namespace keeler::gravity::KEELER_KERNEL_SPACE {
namespace {

constexpr std::size_t float_lanes = 2 * KEELER_LANES;
typedef float HalfFloats __attribute__((vector_size(4 * KEELER_LANES), may_alias));

inline Lanes load(const double* from) {
  return *reinterpret_cast<const Lanes*>(from);
}

inline Floats load(const float* from) {
  return *reinterpret_cast<const Floats*>(from);
}

inline void store(double* to, const Lanes& value) {
  *reinterpret_cast<Lanes*>(to) = value;
}

// The root r = 1/√q in two steps. The first, from the bits of q, gives v ≈ √middle · r, where |h| < 1.3e-3 middle for
// h = middle − q v² (Moroz et al. 2018, "Fast calculation of inverse square root"). The second is a polynomial in h, to
// second order.
constexpr double slope = 2.38924456, middle = 2.01796572;
constexpr double inverse1 = 0.70395209813619219, inverse3 = 0.34884244605566223; // middle^(−1/2), middle^(−3/2)

template<class Real> constexpr auto magic = 0x5f1ffff9;
template<> constexpr auto magic<double> = 0x5fe3ffff20000000;

template<class Real, class Integers, class Vector> inline void first_root(const Vector& q, Vector& v) {
  const Vector guess = reinterpret_cast<Vector>(magic<Real> - (reinterpret_cast<Integers>(q) >> 1));
  v = guess * (static_cast<Real>(slope) - q * guess * guess);
}

template<class Real, class Integers, class Vector> inline void inverse_root(const Vector& q, Vector& root) {
  constexpr auto a = static_cast<Real>(inverse1), b = static_cast<Real>(0.5 * inverse1 / middle),
                 c = static_cast<Real>(0.375 * inverse1 / (middle * middle));
  Vector v;
  first_root<Real, Integers>(q, v);
  const Vector h = static_cast<Real>(middle) - q * (v * v);
  root = v * (a + h * (b + h * c));
}

void points(TargetBlock& t, std::size_t target_count, const PointSource* sources, std::size_t count) {
  constexpr double nearest = min_distance * min_distance;
  for (std::size_t b = 0; b < target_count; b += KEELER_LANES) {
    const Lanes x = load(t.x + b), y = load(t.y + b), z = load(t.z + b);
    Lanes ax = load(t.ax + b), ay = load(t.ay + b), az = load(t.az + b);
    for (const PointSource* s = sources; s != sources + count; ++s) {
      const Lanes dx = s->x - x, dy = s->y - y, dz = s->z - z;
      const Lanes d2 = larger(dx * dx + dy * dy + dz * dz, Lanes{} + nearest);
      Lanes root; // to 1e-9; its error h is corrected below
      inverse_root<double, Longs>(d2, root);
      const Lanes root2 = root * root;
      const Lanes h = 1.0 - d2 * root2;
      const Lanes rough = s->mass * root * root2;
      const Lanes weight = rough + rough * (1.5 * h);
      ax += weight * dx;
      ay += weight * dy;
      az += weight * dz;
    }
    store(t.ax + b, ax);
    store(t.ay + b, ay);
    store(t.az + b, az);
  }
}

// Adds a register's sums, times a factor, to their doubles and zeroes it.
inline void flush(Floats& sum, double* to, double scale = 1.0) {
  alignas(64) float values[float_lanes];
  *reinterpret_cast<Floats*>(values) = sum;
  for (std::size_t k = 0; k < float_lanes; k += KEELER_LANES) {
    const HalfFloats& half = *reinterpret_cast<const HalfFloats*>(values + k);
    store(to + k, load(to + k) + scale * __builtin_convertvector(half, Lanes));
  }
  sum = Floats{};
}

void points_single(SingleTargetBlock& t, std::size_t target_count, const SinglePoint* sources, const PointRange* ranges,
                   std::size_t range_count) {
  constexpr std::size_t chunk = 128;
  constexpr float nearest = min_distance_single * min_distance_single;
  // 1/|d|³ = v³ scale (offset + h (tilt + h)), the expansion of (1 − h/middle)^(−3/2)
  constexpr double scale = 1.875 * inverse3 / (middle * middle);
  constexpr auto tilt = static_cast<float>(0.8 * middle), offset = static_cast<float>(middle * middle / 1.875);
  for (std::size_t b = 0; b < target_count; b += float_lanes) {
    const Floats x = load(t.x + b), y = load(t.y + b), z = load(t.z + b);
    const Floats xl = load(t.x_low + b), yl = load(t.y_low + b), zl = load(t.z_low + b);
    Floats ax{}, ay{}, az{};
    std::size_t gathered = 0;
    for (const PointRange* r = ranges; r != ranges + range_count; ++r)
      for (std::size_t done = 0; done < r->count; done += chunk) {
        const std::size_t part = r->count - done < chunk ? r->count - done : chunk;
        const SinglePoint* const first = sources + r->begin + done;
        for (const SinglePoint* s = first; s != first + part; ++s) {
          const Floats dx = (s->x - x) + (s->x_low - xl);
          const Floats dy = (s->y - y) + (s->y_low - yl);
          const Floats dz = (s->z - z) + (s->z_low - zl);
          const Floats d2 = larger(dx * dx + dy * dy + dz * dz, Floats{} + nearest);
          Floats v;
          first_root<float, Ints>(d2, v);
          const Floats v2 = v * v;
          const Floats h = static_cast<float>(middle) - d2 * v2;
          const Floats weight = (s->mass * v) * v2 * (offset + h * (tilt + h));
          ax += weight * dx;
          ay += weight * dy;
          az += weight * dz;
        }
        gathered += part;
        if (gathered >= chunk) {
          flush(ax, t.ax + b, scale);
          flush(ay, t.ay + b, scale);
          flush(az, t.az + b, scale);
          gathered = 0;
        }
      }
    flush(ax, t.ax + b, scale);
    flush(ay, t.ay + b, scale);
    flush(az, t.az + b, scale);
  }
}

void cells(SingleTargetBlock& t, std::size_t target_count, const CellSource* sources, std::size_t count) {
  for (std::size_t b = 0; b < target_count; b += float_lanes) {
    const Floats x = load(t.from_x + b), y = load(t.from_y + b), z = load(t.from_z + b);
    Floats ax{}, ay{}, az{};
    for (const CellSource* s = sources; s != sources + count; ++s) {
      const Floats dx = s->x - x, dy = s->y - y, dz = s->z - z;
      const Floats d2 = dx * dx + dy * dy + dz * dz;
      Floats root;
      inverse_root<float, Ints>(d2, root);
      const Floats root2 = root * root;
      const Floats qx = s->xx * dx + s->xy * dy + s->xz * dz;
      const Floats qy = s->xy * dx + s->yy * dy + s->yz * dz;
      const Floats qz = s->xz * dx + s->yz * dy + s->zz * dz;
      const Floats dqd = qx * dx + qy * dy + qz * dz;
      const Floats along = s->mass * d2 + 2.5F * dqd * root2;
      const Floats root5 = root2 * root2 * root;
      ax += root5 * (along * dx - qx);
      ay += root5 * (along * dy - qy);
      az += root5 * (along * dz - qz);
    }
    flush(ax, t.ax + b);
    flush(ay, t.ay + b);
    flush(az, t.az + b);
  }
}

// Sixteen lanes in every set, in several registers if they are narrower.
typedef float Sixteen __attribute__((vector_size(64), may_alias));
typedef int SixteenInts __attribute__((vector_size(64), may_alias));

inline const Sixteen& load16(const float* from) {
  return *reinterpret_cast<const Sixteen*>(from);
}

// Sums sixteen lanes; the tree of additions is fixed.
inline float sum_of(const Sixteen& v) {
  float s[8];
  for (int k = 0; k < 8; ++k)
    s[k] = v[k] + v[k + 8];
  for (int k = 0; k < 4; ++k)
    s[k] += s[k + 4];
  return (s[0] + s[2]) + (s[1] + s[3]);
}

// Adds m r/|r|³, 3 m r r/|r|⁵, 15/2 m r r r/|r|⁷, 35/2 m r r r r/|r|⁹, with r from the centre to the cell: each term is
// the previous one times e = r/|r|² and a factor. Adds the quadrupole's contributions to the field and its gradient.
void far_cells(LocalTerms& sums, const FarCells& cells, std::size_t count) {
  Sixteen sum1[3]{}, sum2[6]{}, sum3[10]{}, sum4[15]{};
  for (std::size_t k = 0; k < count; k += FarCells::lanes) {
    const Sixteen x = load16(cells.x + k), y = load16(cells.y + k), z = load16(cells.z + k);
    Sixteen root;
    inverse_root<float, SixteenInts>(x * x + y * y + z * z, root);
    const Sixteen root2 = root * root, root3 = root * root2, root5 = root3 * root2;
    const Sixteen ex = root2 * x, ey = root2 * y, ez = root2 * z;
    const Sixteen xx = load16(cells.xx + k), yy = load16(cells.yy + k), zz = load16(cells.zz + k);
    const Sixteen xy = load16(cells.xy + k), xz = load16(cells.xz + k), yz = load16(cells.yz + k);
    const Sixteen qx = root5 * (xx * x + xy * y + xz * z);
    const Sixteen qy = root5 * (xy * x + yy * y + yz * z);
    const Sixteen qz = root5 * (xz * x + yz * y + zz * z);
    const Sixteen rqr = qx * ex + qy * ey + qz * ez;
    const Sixteen weight = load16(cells.mass + k) * root3;
    const Sixteen gx = weight * x, gy = weight * y, gz = weight * z;

    const Sixteen along1 = 2.5F * rqr;
    sum1[0] += gx + (along1 * x - qx);
    sum1[1] += gy + (along1 * y - qy);
    sum1[2] += gz + (along1 * z - qz);

    // the mass's part of rank 2, and 35/2 (r·Qr) r r/|r|⁹ − 5 (Qr r + r Qr)/|r|⁷ + Q/|r|⁵
    const Sixteen hx = 3.0F * gx, hy = 3.0F * gy, hz = 3.0F * gz;
    const Sixteen along2 = 17.5F * rqr;
    const Sixteen px = along2 * x - 5.0F * qx, py = along2 * y - 5.0F * qy, pz = along2 * z - 5.0F * qz;
    const Sixteen mass2[6] = {ex * hx, ex * hy, ex * hz, ey * hy, ey * hz, ez * hz};
    sum2[0] += mass2[0] + (px * ex - 5.0F * qx * ex + root5 * xx);
    sum2[1] += mass2[1] + (px * ey - 5.0F * qy * ex + root5 * xy);
    sum2[2] += mass2[2] + (px * ez - 5.0F * qz * ex + root5 * xz);
    sum2[3] += mass2[3] + (py * ey - 5.0F * qy * ey + root5 * yy);
    sum2[4] += mass2[4] + (py * ez - 5.0F * qz * ey + root5 * yz);
    sum2[5] += mass2[5] + (pz * ez - 5.0F * qz * ez + root5 * zz);

    const Sixteen fx = 2.5F * ex, fy = 2.5F * ey, fz = 2.5F * ez;
    const Sixteen mass3[10] = {fx * mass2[0], fy * mass2[0], fz * mass2[0], fx * mass2[3], fx * mass2[4],
                               fx * mass2[5], fy * mass2[3], fz * mass2[3], fy * mass2[5], fz * mass2[5]};
    for (int i = 0; i < 10; ++i)
      sum3[i] += mass3[i];

    const Sixteen kx = (7.0F / 3.0F) * ex, ky = (7.0F / 3.0F) * ey, kz = (7.0F / 3.0F) * ez;
    const Sixteen mass4[15] = {kx * mass3[0], ky * mass3[0], kz * mass3[0], kx * mass3[3], kx * mass3[4],
                               kx * mass3[5], kx * mass3[6], kx * mass3[7], kx * mass3[8], kx * mass3[9],
                               ky * mass3[6], kz * mass3[6], ky * mass3[8], ky * mass3[9], kz * mass3[9]};
    for (int i = 0; i < 15; ++i)
      sum4[i] += mass4[i];
  }
  for (int i = 0; i < 3; ++i)
    sums.rank1[i] += sum_of(sum1[i]);
  for (int i = 0; i < 6; ++i)
    sums.rank2[i] += sum_of(sum2[i]);
  for (int i = 0; i < 10; ++i)
    sums.rank3[i] += sum_of(sum3[i]);
  for (int i = 0; i < 15; ++i)
    sums.rank4[i] += sum_of(sum4[i]);
}

// Adds rank1 + (rank2 + (rank3 + rank4 · t) · t) · t.
void local(SingleTargetBlock& t, std::size_t target_count, const LocalTerms& terms) {
  for (std::size_t b = 0; b < target_count; b += float_lanes) {
    const Floats x = load(t.from_x + b), y = load(t.from_y + b), z = load(t.from_z + b);
    const float* const c4 = terms.rank4;
    // entries of rank 4 for each entry of rank 3 and x, y, z: xxx → xxxx xxxy xxxz, xxy → xxxy xxyy xxyz, …
    const auto third = [&](int i, int ix, int iy, int iz) {
      return terms.rank3[i] + (c4[ix] * x + c4[iy] * y + c4[iz] * z);
    };
    const Floats xxx = third(0, 0, 1, 2), xxy = third(1, 1, 3, 4), xxz = third(2, 2, 4, 5), xyy = third(3, 3, 6, 7);
    const Floats xyz = third(4, 4, 7, 8), xzz = third(5, 5, 8, 9), yyy = third(6, 6, 10, 11);
    const Floats yyz = third(7, 7, 11, 12), yzz = third(8, 8, 12, 13), zzz = third(9, 9, 13, 14);
    const Floats xx = terms.rank2[0] + (xxx * x + xxy * y + xxz * z);
    const Floats xy = terms.rank2[1] + (xxy * x + xyy * y + xyz * z);
    const Floats xz = terms.rank2[2] + (xxz * x + xyz * y + xzz * z);
    const Floats yy = terms.rank2[3] + (xyy * x + yyy * y + yyz * z);
    const Floats yz = terms.rank2[4] + (xyz * x + yyz * y + yzz * z);
    const Floats zz = terms.rank2[5] + (xzz * x + yzz * y + zzz * z);
    Floats ax = terms.rank1[0] + (xx * x + xy * y + xz * z);
    Floats ay = terms.rank1[1] + (xy * x + yy * y + yz * z);
    Floats az = terms.rank1[2] + (xz * x + yz * y + zz * z);
    flush(ax, t.ax + b);
    flush(ay, t.ay + b);
    flush(az, t.az + b);
  }
}

} // namespace

extern const AttractionKernels kernels;
const AttractionKernels kernels = {points, points_single, cells, far_cells, local};

} // namespace keeler::gravity::KEELER_KERNEL_SPACE
