#include <keeler/collision/drift.hpp>
#include <keeler/core/field_table.hpp>

#include "drift_engine.hpp"

namespace keeler::collision {

void CollisionTally::list_fields(FieldTable& table) {
  table.scalar("collisions_fast", fast, "1", "collisions faster than v_cut");
  table.scalar("collisions_slow", slow, "1", "contacts slower than v_cut, bounced elastically");
  table.scalar("collisions_unresolved", unresolved, "1", "contacts slower than a kick of the pair's own gravity");
  table.scalar("finder_gave_up", gave_up, "1", "searches abandoned by the finder");
  table.scalar("collision_energy_lost", energy_lost, "kg m^2 rad^-2", "energy dissipated in collisions");
  table.scalar("collision_momentum_flux", momentum_flux, "kg m^2 rad^-1", "sum of (x_j - x_i) p_y gained by j");
  table.scalar("collision_azimuthal_gain", azimuthal_gain, "kg m^2 rad^-2", "sum of m c_y^2 gained by collisions");
}

DriftPhase::DriftPhase(const CollisionSettings& settings, const Frequencies& frequencies, double orbital_frequency,
                       double step)
    : engine_(std::make_unique<DriftEngine>(settings, frequencies, orbital_frequency, step)) {}

DriftPhase::~DriftPhase() = default;
DriftPhase::DriftPhase(DriftPhase&& other) noexcept = default;
DriftPhase& DriftPhase::operator=(DriftPhase&& other) noexcept = default;

void DriftPhase::set_step(double step, double kick_pull, double rest_pull) {
  engine_->set_step(step, kick_pull, rest_pull);
}

std::span<const SlowPair> DriftPhase::slow_pairs() const {
  return engine_->slow_pairs();
}

void DriftPhase::collide(Particles& particles, const ShearingBox& box, double offset, CollisionTally& tally,
                         bool undisturbed, const KickInterval& gravity) {
  engine_->collide(particles, box, offset, tally, undisturbed, gravity);
}

bool DriftPhase::collide_distributed(Particles& particles, decomposition::GhostLayer& ghosts, const Communicator& ranks,
                                     const ShearingBox& box, double offset, CollisionTally& tally,
                                     const KickInterval& gravity) {
  return engine_->collide_distributed(particles, ghosts, ranks, box, offset, tally, gravity);
}

double DriftPhase::kick_work() const {
  return engine_->kick_work();
}

const finders::Finder& DriftPhase::finder() const {
  return engine_->finder();
}

DriftCosts DriftPhase::costs() const {
  return engine_->costs();
}

void DriftPhase::release_contacts() {
  engine_->release_contacts();
}

void DriftPhase::release() {
  engine_->release();
}

void DriftPhase::observe(DriftObserver* observer) {
  engine_->observe(observer);
}

void DriftPhase::audit(NeighbourAudit* audit) {
  engine_->audit(audit);
}

double DriftPhase::reached() const {
  return engine_->reached();
}

} // namespace keeler::collision
