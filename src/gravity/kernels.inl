// Text of the kernels; see kernels.hpp. The including file sets KEELER_KERNEL_SPACE and KEELER_LANES and defines
// square_root(Lanes). Everything here has internal linkage except `kernels`.

namespace keeler::KEELER_KERNEL_SPACE {
namespace {

inline Lanes load(const double* from) {
  return *reinterpret_cast<const Lanes*>(from);
}

inline void store(double* to, const Lanes& value) {
  *reinterpret_cast<Lanes*>(to) = value;
}

void points(TargetBlock& t, std::size_t target_count, const PointSource* sources, std::size_t count) {
  for (std::size_t b = 0; b < target_count; b += KEELER_LANES) {
    const Lanes x = load(t.x + b), y = load(t.y + b), z = load(t.z + b);
    Lanes ax = load(t.ax + b), ay = load(t.ay + b), az = load(t.az + b);
    for (const PointSource* s = sources; s != sources + count; ++s) {
      const Lanes dx = s->x - x, dy = s->y - y, dz = s->z - z;
      const Lanes d2 = dx * dx + dy * dy + dz * dz;
      const Lanes weight = d2 > same_place_squared ? s->mass / (d2 * square_root(d2)) : Lanes{};
      ax += weight * dx;
      ay += weight * dy;
      az += weight * dz;
    }
    store(t.ax + b, ax);
    store(t.ay + b, ay);
    store(t.az + b, az);
  }
}

void cells(TargetBlock& t, std::size_t target_count, const CellSource* sources, std::size_t count) {
  for (std::size_t b = 0; b < target_count; b += KEELER_LANES) {
    const Lanes x = load(t.x + b), y = load(t.y + b), z = load(t.z + b);
    Lanes ax = load(t.ax + b), ay = load(t.ay + b), az = load(t.az + b);
    for (const CellSource* s = sources; s != sources + count; ++s) {
      const Lanes dx = s->x - x, dy = s->y - y, dz = s->z - z;
      const Lanes inverse2 = 1.0 / (dx * dx + dy * dy + dz * dz);
      const Lanes inverse3 = inverse2 * square_root(inverse2);
      const Lanes inverse5 = inverse3 * inverse2;
      const Lanes qx = s->xx * dx + s->xy * dy + s->xz * dz;
      const Lanes qy = s->xy * dx + s->yy * dy + s->yz * dz;
      const Lanes qz = s->xz * dx + s->yz * dy + s->zz * dz;
      const Lanes dqd = qx * dx + qy * dy + qz * dz;
      const Lanes along = s->mass * inverse3 + 2.5 * dqd * (inverse5 * inverse2);
      ax += along * dx - qx * inverse5;
      ay += along * dy - qy * inverse5;
      az += along * dz - qz * inverse5;
    }
    store(t.ax + b, ax);
    store(t.ay + b, ay);
    store(t.az + b, az);
  }
}

} // namespace

extern const AttractionKernels kernels;
const AttractionKernels kernels = {points, cells};

} // namespace keeler::KEELER_KERNEL_SPACE
