// What a source of the folder `orbit` may not include: a folder that stands above it.
#include <keeler/hill/elements.hpp>
#include <keeler/particles/store.hpp>
