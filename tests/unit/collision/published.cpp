// The finders of the paper, held to what it and its public code show.
#include <keeler/collision/finders.hpp>
#include <keeler/collision/search/published.hpp>

#include "unit/collision/grid_pairs.hpp"

#include <keeler/cells/overlap.hpp>

#include <doctest/doctest.h>

using namespace keeler;

