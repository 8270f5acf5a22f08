// The kernels for any processor, with four lanes.
#include "kernels.hpp"

#define KEELER_KERNEL_SPACE kernels_portable

namespace keeler::collision::KEELER_KERNEL_SPACE {
namespace {

constexpr std::size_t lanes = 4;
typedef float Floats __attribute__((vector_size(16)));
typedef std::int32_t Integers __attribute__((vector_size(16)));
typedef std::uint32_t Unsigned __attribute__((vector_size(16)));

struct Fields {
  Integers x, y;
  Floats z, u, v, w, size;
};

template<class LineAt> inline Fields load(const LineAt& line_at) {
  Fields f;
  for (std::size_t k = 0; k < lanes; ++k) {
    const Line& line = *line_at(k);
    f.x[k] = line.x, f.y[k] = line.y, f.z[k] = line.z;
    f.u[k] = line.u, f.v[k] = line.v, f.w[k] = line.w;
    f.size[k] = line.size;
  }
  return f;
}

inline unsigned nonzero(const Integers& mask) {
  unsigned bits = 0;
  for (std::size_t k = 0; k < lanes; ++k)
    bits |= static_cast<unsigned>(mask[k] != 0) << k;
  return bits;
}

constexpr std::size_t halves = 2;
typedef double Doubles __attribute__((vector_size(16)));
typedef std::int64_t Longs __attribute__((vector_size(16)));
typedef float Singles __attribute__((vector_size(8)));
typedef std::int32_t Words __attribute__((vector_size(8)));

inline unsigned nonzero(const Longs& mask) {
  unsigned bits = 0;
  for (std::size_t k = 0; k < halves; ++k)
    bits |= static_cast<unsigned>(mask[k] != 0) << k;
  return bits;
}

inline void load_bodies(const double* rows, Doubles fields[8]) {
  for (int k = 0; k < 8; ++k) {
    Doubles field{};
    for (std::size_t n = 0; n < halves; ++n)
      field[n] = rows[8 * n + static_cast<std::size_t>(k)];
    fields[k] = field;
  }
}

struct HalfFields {
  Words x, y;
  Singles z, u, v, w, size;
};

inline HalfFields load_half(const Line* lines) {
  HalfFields f;
  for (std::size_t n = 0; n < halves; ++n) {
    const Line& line = lines[n];
    f.x[n] = line.x, f.y[n] = line.y, f.z[n] = line.z;
    f.u[n] = line.u, f.v[n] = line.v, f.w[n] = line.w;
    f.size[n] = line.size;
  }
  return f;
}

inline void store_lines(Line* lines, const Words& x, const Words& y, const Singles& z, const Singles& u,
                        const Singles& v, const Singles& w, const Singles& size, const Words& tag) {
  for (std::size_t n = 0; n < halves; ++n) {
    Line& line = lines[n];
    line.x = x[n], line.y = y[n], line.z = z[n];
    line.u = u[n], line.v = v[n], line.w = w[n];
    line.size = size[n], line.tag = static_cast<std::uint32_t>(tag[n]);
  }
}

} // namespace
} // namespace keeler::collision::KEELER_KERNEL_SPACE

#include "kernels.inl"
