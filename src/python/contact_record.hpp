// Records contacts of a running simulation for Python.
#pragma once

#include <keeler/core/units.hpp>
#include <keeler/simulation/simulation.hpp>

#include <cassert>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace keeler::python {

/// One row of Simulation.contacts(), in SI.
struct ContactRecord {
  double time_orbits;
  std::uint64_t low_id, high_id;
  double x_m, y_m, z_m; ///< point of contact, at the image of the particle with the lower id
  double normal_speed_m_s, tangential_speed_m_s;
  double energy_lost_j;
};

/// Records contacts with a normal speed of at least `minimum_speed` (m/s).
class ContactRecorder : public collision::DriftObserver {
public:
  ContactRecorder(double minimum_speed, double orbital_frequency)
      : minimum_speed_(minimum_speed), omega_(orbital_frequency) {
    assert(minimum_speed >= 0.0 && orbital_frequency > 0.0);
  }

  /// Observes this simulation from now on.
  void watch(Simulation& simulation) {
    simulation_ = &simulation;
    simulation.drift().observe(this);
  }

  bool wants_events() const override { return false; }
  bool wants_records() const override { return true; }
  void recorded(std::span<const collision::CollisionRecord> records) override {
    assert(simulation_ && "watch() was called");
    const simulation::SimulationState& state = simulation_->state();
    const double middle = simulation_->orbits() + 0.5 * state.step_length / two_pi;
    for (const collision::CollisionRecord& c : records)
      if (c.normal_speed * omega_ >= minimum_speed_)
        rows_.push_back({middle + c.time / two_pi, c.low_id, c.high_id, c.contact_point.x(), c.contact_point.y(),
                         c.contact_point.z(), c.normal_speed * omega_, c.tangential_speed * omega_,
                         c.energy_lost * omega_ * omega_});
  }

  const std::vector<ContactRecord>& rows() const { return rows_; }
  void clear() { rows_.clear(); }
  /// Drops all rows except the first `count`. Precondition: there are that many.
  void keep_first(std::size_t count) {
    assert(count <= rows_.size());
    rows_.erase(rows_.begin() + static_cast<std::ptrdiff_t>(count), rows_.end());
  }

private:
  double minimum_speed_, omega_;
  const Simulation* simulation_ = nullptr;
  std::vector<ContactRecord> rows_;
};

} // namespace keeler::python
