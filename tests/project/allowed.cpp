// What a source of the folder `orbit` may include: its own headers and those of the folder below.
#include <keeler/core/units.hpp>
#include <keeler/hill/elements.hpp>
