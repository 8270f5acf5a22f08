#include <keeler/particles/store.hpp>

#include <keeler/core/field_table.hpp>

namespace keeler::particles {

void Particles::list_fields(FieldTable& table) {
  table.particle_rows<double>("bodies", bodies, "m, kg", "X, Y, e cos, e sin, i sin, i cos at the epoch; radius; mass");
  table.particle_rows<std::uint64_t>("ids", ids, "1", "unique identity, kept for ever");
  if (rough)
    table.particle_rows<double>("spins", spins, "rad^-1",
                                "angular velocity against the stars, in Hill's frame at the epoch");
}

} // namespace keeler::particles
