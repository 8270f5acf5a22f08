// Statistics of numbers that follow each other in time: the error of their mean where neighbours are correlated, and
// from where on they are steady.
#pragma once

#include <cstddef>
#include <span>

namespace keeler {

/// A mean and its standard error.
struct Estimate {
  double value = 0.0;
  double error = 0.0; ///< NaN where there are too few values for one
};

/// Mean of values at equal intervals, and its error by blocks (Flyvbjerg & Petersen 1989, J. Chem. Phys. 91, 461):
/// means over 1, 2, 4 … values, until blocks are so long that they are independent. That length B is the least one with
/// B³ > 2 n (σ_B/σ_1)⁴, σ_B the error from blocks of B (Lee et al. 2011, Phys. Rev. E 83, 066706); where four blocks
/// are not enough for it the longest of the errors so far counts. Fewer than four values have no error.
Estimate block_mean(std::span<const double> values);

/// g ≥ 1: as many values as count for one independent one, 1 + 2 Σ of the autocorrelations up to the first that is not
/// positive. 1 for fewer than four values or equal ones.
double statistical_inefficiency(std::span<const double> values);

/// The place from which on the mean is best known: it leaves the largest number of independent values, (n − place)/g of
/// the rest (Chodera 2016, J. Chem. Theory Comput. 12, 1799). At least a third is left: the g of a short rest is a
/// guess, and the largest of many guesses wins by chance. Long series are looked at in 256 bins.
std::size_t steady_start(std::span<const double> values);

/// Whether the two halves have the same mean within three of their errors, and what stands before steady_start(), where
/// that is beyond the first third, the same as the rest within three errors of the rest's scatter. At least eight
/// values, or they are not called steady.
bool is_steady(std::span<const double> values);

} // namespace keeler
