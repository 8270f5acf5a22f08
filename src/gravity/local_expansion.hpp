// The field of distant cells around a place, as a polynomial of third order: the kernel far_cells sums symmetric
// tensors over the cells, and `complete` makes them those of a field without sources.
//
// With the cell at r and a target at t, 1/|r − t| = Σ_n (2n − 1)!!/n! STF(r … r)·t … t / |r|^(2n + 1), where STF takes
// the traces out of a symmetric tensor. That is linear, so it is done once, after the sum over cells. Of the cells'
// quadrupoles the field and its gradient are kept: what is left out is of fourth order in (sizes / distance).
#pragma once

#include "kernels.hpp"

namespace keeler {

/// Takes the traces out of the tensors of rank 2, 3 and 4.
void complete(LocalTerms& terms);

} // namespace keeler
