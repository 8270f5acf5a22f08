// The kernel for any processor: one pair at a time.
#include "monotone_newton.hpp"

#define KEELER_KERNEL_SPACE monotone_newton_portable

namespace keeler::finders::KEELER_KERNEL_SPACE {
namespace {

constexpr std::size_t lanes = 1;
typedef double Reals;
typedef bool Masks;

struct PairElements {
  Reals guiding_x, guiding_y, e_cos, e_sin, i_sin, i_cos, radius_sum, start;
};

inline PairElements load(const MonotonePair* pair) {
  const double *low = pair->low, *high = pair->high, *query = pair->query;
  return {(high[0] + query[0]) - low[0],
          (high[1] + query[1]) - low[1],
          high[2] - low[2],
          high[3] - low[3],
          high[4] - low[4],
          high[5] - low[5],
          high[6] + low[6],
          query[2]};
}

inline Reals square_root(Reals a) {
  return __builtin_sqrt(a);
}
inline bool any(Masks mask) {
  return mask;
}
inline double lane(Reals values, std::size_t) {
  return values;
}

} // namespace
} // namespace keeler::finders::KEELER_KERNEL_SPACE

#include "monotone_newton.inl"
