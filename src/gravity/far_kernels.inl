// Source of the far images' kernels (far_kernels.hpp). Included like kernels.inl, with KEELER_KERNEL_SPACE and
// KEELER_LANES (of doubles) set. Several vectors of bodies are interleaved, to hide the latency of their chains.

namespace keeler::gravity::KEELER_KERNEL_SPACE {
namespace {

template<class Real> struct Wide {
  typedef Real Lanes __attribute__((vector_size(8 * KEELER_LANES), may_alias));
  static constexpr std::size_t lanes = 8 * KEELER_LANES / sizeof(Real);
};

constexpr int max_powers = 15;
constexpr std::size_t max_monomials = 700;

template<class Real> void pad(FarBlock<Real>& block, std::size_t bundle) {
  for (std::size_t k = block.count; k % bundle != 0; ++k)
    block.x[k] = block.y[k] = block.z[k] = block.mass[k] = 0;
}

// Body k adds to partial sum k % logical of each monomial, for any width of the registers.
template<class Real> void gather(FarBlock<Real>& block, const PolynomialShape& shape, double* moments) {
  using Lanes = typename Wide<Real>::Lanes;
  constexpr std::size_t logical = 64 / sizeof(Real), chains = 4, bundle = logical * chains;
  pad(block, bundle);
  for (std::size_t k = 0; k < shape.size; ++k)
    moments[k] = 0.0;
  for (std::size_t lane = 0; lane < logical; lane += Wide<Real>::lanes) {
    Lanes sums[max_monomials];
    for (std::size_t k = 0; k < shape.size; ++k)
      sums[k] = Lanes{};
    for (std::size_t first = lane; first < block.count; first += bundle) {
      const auto at = [&](const Real* from, std::size_t j) {
        return *reinterpret_cast<const Lanes*>(from + first + logical * j);
      };
      Lanes powers[max_powers][chains], at_height[chains];
      for (std::size_t j = 0; j < chains; ++j) {
        powers[0][j] = Lanes{} + 1;
        for (int a = 1; a <= shape.degree; ++a)
          powers[a][j] = powers[a - 1][j] * at(block.x, j);
        at_height[j] = at(block.mass, j);
      }
      Lanes* sum = sums;
      for (int c = 0; c <= shape.height_degree; ++c) {
        Lanes weight[chains];
        for (std::size_t j = 0; j < chains; ++j)
          weight[j] = at_height[j];
        for (int b = 0; b <= shape.degree - c; ++b) {
          for (int a = 0; a <= shape.degree - c - b; ++a, ++sum)
            *sum += (weight[0] * powers[a][0] + weight[1] * powers[a][1]) +
                    (weight[2] * powers[a][2] + weight[3] * powers[a][3]);
          for (std::size_t j = 0; j < chains; ++j)
            weight[j] *= at(block.y, j);
        }
        for (std::size_t j = 0; j < chains; ++j)
          at_height[j] *= at(block.z, j);
      }
    }
    for (std::size_t k = 0; k < shape.size; ++k)
      for (std::size_t l = 0; l < Wide<Real>::lanes; ++l)
        moments[k] += static_cast<double>(sums[k][l]);
  }
}

// Horner's rule from the highest powers down: x in the inner loop, then y, then z.
template<class Real> void slopes(FarBlock<Real>& block, const PolynomialShape& shape, const Real* coefficients) {
  using Lanes = typename Wide<Real>::Lanes;
  constexpr std::size_t chains = KEELER_LANES == 8 ? 4 : 2, bundle = Wide<Real>::lanes * chains;
  pad(block, bundle);
  const Real* const end = coefficients + shape.size;
  for (std::size_t first = 0; first < block.count; first += bundle) {
    const auto at = [&](Real* from, std::size_t j) -> Lanes& {
      return *reinterpret_cast<Lanes*>(from + first + Wide<Real>::lanes * j);
    };
    Lanes x[chains], y[chains], z[chains];
    Lanes value[chains] = {}, along_x[chains] = {}, along_y[chains] = {}, along_z[chains] = {};
    for (std::size_t j = 0; j < chains; ++j) {
      x[j] = at(block.x, j);
      y[j] = at(block.y, j);
      z[j] = at(block.z, j);
    }
    const Real* next = end;
    for (int c = shape.height_degree; c >= 0; --c) {
      Lanes plane[chains] = {}, plane_x[chains] = {}, plane_y[chains] = {};
      for (int b = shape.degree - c; b >= 0; --b) {
        Lanes line[chains] = {}, line_x[chains] = {};
        for (int a = shape.degree - c - b; a >= 0; --a) {
          const Real coefficient = *--next;
          for (std::size_t j = 0; j < chains; ++j) {
            line_x[j] = line_x[j] * x[j] + line[j];
            line[j] = line[j] * x[j] + coefficient;
          }
        }
        for (std::size_t j = 0; j < chains; ++j) {
          plane_y[j] = plane_y[j] * y[j] + plane[j];
          plane[j] = plane[j] * y[j] + line[j];
          plane_x[j] = plane_x[j] * y[j] + line_x[j];
        }
      }
      for (std::size_t j = 0; j < chains; ++j) {
        along_z[j] = along_z[j] * z[j] + value[j];
        value[j] = value[j] * z[j] + plane[j];
        along_x[j] = along_x[j] * z[j] + plane_x[j];
        along_y[j] = along_y[j] * z[j] + plane_y[j];
      }
    }
    for (std::size_t j = 0; j < chains; ++j) {
      at(block.x, j) = along_x[j];
      at(block.y, j) = along_y[j];
      at(block.z, j) = along_z[j];
    }
  }
}

} // namespace

extern const FarKernels<float> far_single;
const FarKernels<float> far_single = {gather<float>, slopes<float>};
extern const FarKernels<double> far_double;
const FarKernels<double> far_double = {gather<double>, slopes<double>};

} // namespace keeler::gravity::KEELER_KERNEL_SPACE
