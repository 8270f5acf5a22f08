// Local expansion: the field of distant cells around a centre, as a polynomial of third order. The kernel far_cells
// sums symmetric tensors over the cells, and `complete` makes them tensors of a source-free field.
//
// With the cell at r and a target at t, 1/|r − t| = Σ_n (2n − 1)!!/n! STF(r … r)·t … t / |r|^(2n + 1), where STF
// removes the traces of a symmetric tensor. That is linear, so it is done once, after the sum over cells. Of the cells'
// quadrupoles, the field and its gradient are kept: the remainder is of fourth order in (sizes / distance).
#pragma once

#include "kernels.hpp"

namespace keeler::gravity {

/// Removes the traces of the tensors of rank 2, 3 and 4. Idempotent up to rounding.
void complete(LocalTerms& terms);

} // namespace keeler::gravity
