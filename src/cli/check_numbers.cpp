#include "check_numbers.hpp"

#include <keeler/advice/estimate.hpp>
#include <keeler/advice/grain_piles.hpp>
#include <keeler/core/units.hpp>
#include <keeler/scene/contact_rates.hpp>
#include <keeler/scene/planet.hpp>
#include <keeler/scene/resting_choice.hpp>

#include <fmt/format.h>

#include <cassert>
#include <cmath>

namespace keeler::cli {
namespace {

using Checked = const CheckedScene&;

bool particles_known(Checked c) {
  return c.derived.particles_known;
}

bool has_kicks(Checked c) {
  return c.scene.gravity && !c.scene.time.automatic;
}

// True if particles attract each other in pairs, so that contacts at rest can occur.
bool may_rest(Checked c) {
  return c.scene.gravity && c.scene.gravity->by_pairs();
}

bool has_estimate(Checked c) {
  return c.cost.has_value();
}

// Returns the number, or "unknown" if the particles come from a start file.
quantities::Value known(Checked c, double number) {
  return particles_known(c) ? quantities::Value(number)
                            : quantities::Value(quantities::Unknown{"only the start file has it"});
}

std::string resting_word(Checked c) {
  return c.scene.gravity->carries() ? "carried" : "bounced";
}

// Returns the reason of the default, and which one it is if the scene has chosen otherwise.
std::string resting_reason(Checked c) {
  const scene::RestingChoice choice = choose_resting_contacts(c.start, c.scene);
  if (choice.carried == c.scene.gravity->carries())
    return choice.reason;
  return (choice.carried ? "by default they are carried: " : "by default they bounce: ") + choice.reason;
}

// Returns the entry of a body: first id and number of its particles, radius, mass, Hill radius.
quantities::Record body(std::size_t first, std::size_t count, double radius, double mass, Checked c) {
  assert(count > 0 && radius > 0.0 && mass > 0.0);
  const double g = newton_g(c.scene.planet.orbital_frequency);
  return {{{{"first_id", quantities::unit::none, "id"}, std::uint64_t{first}},
           {{"count", quantities::unit::none, "particles"}, std::uint64_t{count}},
           {{"radius", quantities::unit::metres, "radius"}, radius},
           {{"mass_kg", quantities::unit::unnamed("kg"), "mass"}, mass},
           {{"hill_radius", quantities::unit::metres, "Hill radius", "", quantities::Spread::none,
             quantities::Forms::si, 3},
            std::cbrt(g * mass / 3.0)}},
          {}};
}

quantities::Value aggregates(Checked c) {
  std::vector<quantities::Record> all;
  for (const scene::AggregateSettings& a : c.scene.particles.aggregates)
    all.push_back(body(a.first, a.count, a.radius, a.mass, c));
  return all;
}

quantities::Value moonlets(Checked c) {
  std::vector<quantities::Record> all;
  for (const scene::MoonletSettings& m : c.scene.moonlets)
    all.push_back(body(c.scene.particles.count + all.size(), 1, m.radius, m.mass, c));
  return all;
}

std::vector<quantities::QuantityRow<CheckedScene>> patch_rows() {
  return {
      {quantities::word("title", "scene", "its title"), [](Checked c) -> quantities::Value { return c.scene.title; }},
      {quantities::word("from", "box and particles from", "the start file"),
       [](Checked c) -> quantities::Value { return *c.scene.start_from; },
       [](Checked c) { return c.scene.start_from.has_value(); }},
      {{"particle_count", quantities::unit::none, "particles", "N"},
       [](Checked c) -> quantities::Value {
         return particles_known(c) ? quantities::Value(std::uint64_t{c.derived.particle_count}) : known(c, 0.0);
       }},
      {{"optical_depth", quantities::unit::none, "optical depth", "Σ π r² over the area"},
       [](Checked c) -> quantities::Value {
         return particles_known(c) ? c.derived.optical_depth : c.start.optical_depth;
       }},
      {{"surface_density", quantities::unit::unnamed("kg/m²"), "surface density", "Σ m over the area"},
       [](Checked c) { return known(c, c.derived.surface_density); }},
      {{"lambda_cr", quantities::unit::metres, "critical wavelength", "λ_cr = 4π² G Σ/κ² (Toomre 1964)"},
       [](Checked c) { return known(c, c.derived.lambda_cr); }},
      {{"toomre_q", quantities::unit::none, "Toomre Q at the start", "κ c_x/(3.36 G Σ)", quantities::Spread::none,
        quantities::Forms::si, 3},
       [](Checked c) { return known(c, c.derived.toomre_q); }},
      {{"hill_parameter", quantities::unit::none, "Hill parameter r_h",
        "mutual Hill radius of two equal particles over the sum of their radii", quantities::Spread::none,
        quantities::Forms::si, 3},
       [](Checked c) -> quantities::Value {
         return particles_known(c) ? c.derived.hill_parameter
                                   : scene::hill_parameter(c.start.density, distance_from_saturn(c.scene.planet));
       }},
      {{"midplane_filling", quantities::unit::none, "mid-plane filling at the start",
        "fraction of the plane z = 0 inside spheres, where streamlines are closest; at most 0.55",
        quantities::Spread::none, quantities::Forms::si, 3},
       [](Checked c) { return known(c, c.derived.midplane_filling); }},
      {{"box", quantities::unit::metres, "box", "sides along the radius and the orbit", quantities::Spread::none,
        quantities::Forms::si, 4, quantities::Shape::other},
       [](Checked c) -> quantities::Value {
         return particles_known(c) ? quantities::Value(std::vector{c.scene.size_x, c.scene.size_y})
                                   : quantities::Value(quantities::Unknown{"only the start file has it"});
       }},
      {{"box_wavelengths", quantities::unit::unnamed("λ_cr"), "  in critical wavelengths", "these sides over λ_cr",
        quantities::Spread::none, quantities::Forms::si, 3, quantities::Shape::other},
       [](Checked c) -> quantities::Value {
         return std::vector{c.scene.size_x / c.derived.lambda_cr, c.scene.size_y / c.derived.lambda_cr};
       },
       particles_known},
      {quantities::word("aggregates", "aggregate", "bodies of many particles"), aggregates},
      {quantities::word("moonlets", "moonlet", "bodies of one large particle"), moonlets}};
}

std::vector<quantities::QuantityRow<CheckedScene>> course_rows() {
  return {
      {{"steps", quantities::unit::none, "steps", "length of the run; with an automatic step in shortest steps"},
       [](Checked c) -> quantities::Value { return static_cast<std::uint64_t>(c.derived.steps); }},
      {{"step", quantities::unit::orbits, "a step", "its length; null if it is automatic"},
       [](Checked c) -> quantities::Value {
         return c.scene.time.automatic
                    ? quantities::Value(quantities::Unknown{
                          fmt::format("it is automatic, from 1/{} to 1/{} orbits", scene::TimeSettings::ticks_per_orbit,
                                      scene::TimeSettings::ticks_per_orbit / scene::TimeSettings::longest)})
                    : quantities::Value(c.scene.time.step);
       }},
      {{"kick_interval", quantities::unit::orbits, "from kick to kick",
        "with a fixed step and self-gravity, otherwise null"},
       [](Checked c) -> quantities::Value {
         return has_kicks(c) ? quantities::Value(c.scene.time.step * static_cast<double>(c.scene.gravity->kick_every))
                             : quantities::Value(quantities::Unknown{});
       }},
      {quantities::word("gravity", "gravity", "solver and settings of self-gravity"),
       [](Checked c) -> quantities::Value {
         return advice::in_words(particles_known(c) ? chosen_for(c.derived.particle_count, *c.scene.gravity)
                                                    : *c.scene.gravity);
       },
       [](Checked c) { return c.scene.gravity.has_value(); }},
      {quantities::word(
           "resting_contacts", "contacts at rest",
           "treatment of contacts at rest: \"carried\" or \"bounced\"; null without self-gravity between particles"),
       [](Checked c) -> quantities::Value {
         return may_rest(c) ? quantities::Value(resting_word(c)) : quantities::Value(quantities::Unknown{});
       }},
      {quantities::word("resting_reason", "  why", "reason of the default"),
       [](Checked c) -> quantities::Value { return resting_reason(c); }, may_rest}};
}

std::vector<quantities::QuantityRow<CheckedScene>> cost_rows() {
  return {{{"memory", quantities::unit::megabytes, "memory, an estimate", "largest use, 10⁶ bytes",
            quantities::Spread::none, quantities::Forms::si, 2},
           [](Checked c) { return known(c, c.derived.memory_mb); }},
          {{"estimated", quantities::unit::seconds, "time on one thread, an estimate",
            "processor time of `keeler run` on this machine", quantities::Spread::none, quantities::Forms::si, 2},
           [](Checked c) -> quantities::Value {
             return c.cost ? quantities::Value(c.cost->total()) : quantities::Value(quantities::Unknown{});
           }},
          {quantities::word("estimate", "", "null if the particles come from a start file"),
           [](Checked) -> quantities::Value { return quantities::Unknown{}; },
           [](Checked c) { return !has_estimate(c); }},
          {{"estimate.start", quantities::unit::seconds, "  start", "making the initial state",
            quantities::Spread::none, quantities::Forms::si, 2},
           [](Checked c) -> quantities::Value { return c.cost->start; },
           has_estimate},
          {{"estimate.drift", quantities::unit::seconds, "  drift", "moving particles, finding and resolving contacts",
            quantities::Spread::none, quantities::Forms::si, 2},
           [](Checked c) -> quantities::Value { return c.cost->drift; },
           has_estimate},
          {{"estimate.gravity", quantities::unit::seconds, "  gravity", "solves and kicks", quantities::Spread::none,
            quantities::Forms::si, 2},
           [](Checked c) -> quantities::Value { return c.cost->gravity; },
           has_estimate},
          {{"estimate.output", quantities::unit::seconds, "  output", "files, rows of the series, checks",
            quantities::Spread::none, quantities::Forms::si, 2},
           [](Checked c) -> quantities::Value { return c.cost->output; },
           has_estimate},
          {quantities::word("estimate.dominates", "  most of it", "the largest part"),
           [](Checked c) -> quantities::Value { return std::string(c.cost->dominating()); }, has_estimate},
          {{"estimate.contacts_per_particle_orbit", quantities::unit::none, "", "contacts that the estimate assumes"},
           [](Checked c) -> quantities::Value { return scene_contacts(c.scene).wakes.all(); },
           has_estimate},
          {{"estimate.grains_in_piles", quantities::unit::none, "",
            "particles at rest on large bodies that the estimate assumes"},
           [](Checked c) -> quantities::Value {
             return advice::GrainPiles(c.scene).grains(static_cast<double>(c.scene.time.end_step) * c.scene.time.step);
           },
           has_estimate},
          {quantities::word("notices", "note", "rounded or dropped settings, one text each"),
           [](Checked c) -> quantities::Value { return c.scene.notices; }},
          {quantities::word("doubts", "note",
                            "unusual settings, and results that this patch cannot resolve, one text each"),
           [](Checked c) -> quantities::Value { return c.warnings; }},
          {quantities::word("costs", "note", "settings that multiply the cost by five or more, one text each"),
           [](Checked c) -> quantities::Value {
             return particles_known(c) ? advice::expensive_settings(c.scene) : std::vector<std::string>();
           }}};
}

std::vector<quantities::QuantityRow<CheckedScene>> all_rows() {
  return joined(joined(patch_rows(), course_rows()), cost_rows());
}

} // namespace

quantities::Record record_of(const CheckedScene& checked) {
  return {entries_of(all_rows(), checked), {}};
}

std::vector<quantities::Quantity> check_quantities() {
  return quantities_of(all_rows());
}

} // namespace keeler::cli
