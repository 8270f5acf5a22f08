// Statistics of time series: the error of the mean of correlated values, and the detection of a steady part.
#pragma once

#include <keeler/statistics/measured.hpp>

#include <cstddef>
#include <span>

namespace keeler::statistics {

/// Returns the mean of values at equal intervals, and its error by blocks (Flyvbjerg & Petersen 1989, J. Chem. Phys.
/// 91, 461): blocks of 1, 2, 4 … values are averaged until they are independent. That length B is the smallest with B³
/// > 2 n (σ_B/σ_1)⁴, σ_B the error from blocks of B (Lee et al. 2011, Phys. Rev. E 83, 066706). If it would leave fewer
/// than four blocks, the largest error found is used; for fewer than four values the error is NaN. Precondition:
/// `values` is not empty.
Estimate block_mean(std::span<const double> values);

/// Returns the statistical inefficiency g ≥ 1, the number of values per independent one: 1 + 2 Σ of the
/// autocorrelations before the first that is not positive. 1 for fewer than four values or equal ones.
double statistical_inefficiency(std::span<const double> values);

/// Returns the index k from which the mean is best known: values from k on have the largest number of independent
/// values, (n − k)/g (Chodera 2016, J. Chem. Theory Comput. 12, 1799). At least a third of the values is kept: g of a
/// short rest is uncertain, and the largest of many uncertain numbers wins by chance. Long series are averaged into 256
/// bins first.
std::size_t steady_start(std::span<const double> values);

/// Returns true if the means of the two halves agree within three errors and, if steady_start() is beyond the first
/// third, the mean before it agrees with the rest within three errors from the scatter of the rest. False for fewer
/// than eight values.
bool is_steady(std::span<const double> values);

} // namespace keeler::statistics
