#include "check_numbers.hpp"

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

namespace unit = quantities::unit;
using quantities::Quantity, quantities::QuantityRow, quantities::Record, quantities::Shape, quantities::Unknown,
    quantities::Value, quantities::of_digits, quantities::word;
using Checked = const CheckedScene&;

bool particles_known(Checked c) {
  return c.derived.particles_known;
}

// True if particles attract each other in pairs, so that contacts at rest can occur.
bool may_rest(Checked c) {
  return c.scene.gravity && c.scene.gravity->by_pairs();
}

bool has_estimate(Checked c) {
  return c.cost.has_value();
}

// Returns the number, or "unknown" if the particles come from a start file.
Value known(Checked c, double number) {
  return particles_known(c) ? Value(number) : Value(Unknown{"only the start file has it"});
}

std::string resting_word(Checked c) {
  return c.scene.gravity->carries() ? "carried" : "bounced";
}

// Returns the reason of the default, and which one it is if the scene has chosen otherwise.
std::string resting_reason(Checked c) {
  const scene::RestingChoice choice = choose_resting_contacts(c.start, c.scene.planet);
  if (choice.carried == c.scene.gravity->carries())
    return choice.reason;
  return (choice.carried ? "by default they are carried: " : "by default they bounce: ") + choice.reason;
}

// Returns the entry of a body: first id and number of its particles, radius, mass, Hill radius.
Record body(std::size_t first, std::size_t count, double radius, double mass, Checked c) {
  assert(count > 0 && radius > 0.0 && mass > 0.0);
  const double g = newton_g(c.scene.planet.orbital_frequency);
  return {{{{"first_id", unit::none, "id"}, std::uint64_t{first}},
           {{"count", unit::none, "particles"}, std::uint64_t{count}},
           {{"radius", unit::metres, "radius"}, radius},
           {{"mass_kg", unit::unnamed("kg"), "mass"}, mass},
           {of_digits(3, {"hill_radius", unit::metres, "Hill radius"}), std::cbrt(g * mass / 3.0)}},
          {}};
}

Value aggregates(Checked c) {
  std::vector<Record> all;
  for (const scene::AggregateSettings& a : c.scene.particles.aggregates)
    all.push_back(body(a.first, a.count, a.radius, a.mass, c));
  return all;
}

Value moonlets(Checked c) {
  std::vector<Record> all;
  for (const scene::MoonletSettings& m : c.scene.moonlets)
    all.push_back(body(c.scene.particles.count + all.size(), 1, m.radius, m.mass, c));
  return all;
}

std::vector<QuantityRow<CheckedScene>> patch_rows() {
  return {
      {word("title", "scene", "its title"), [](Checked c) { return c.scene.title; }},
      {word("from", "box and particles from", "the start file"), [](Checked c) { return *c.scene.start_from; },
       [](Checked c) { return c.scene.start_from.has_value(); }},
      {{"particle_count", unit::none, "particles", "N"},
       [](Checked c) { return particles_known(c) ? Value(std::uint64_t{c.derived.particle_count}) : known(c, 0.0); }},
      {{"optical_depth", unit::none, "optical depth", "Σ π r² over the area"},
       [](Checked c) { return particles_known(c) ? c.derived.optical_depth : c.start.optical_depth; }},
      {{"surface_density", unit::unnamed("kg/m²"), "surface density", "Σ m over the area"},
       [](Checked c) { return known(c, c.derived.surface_density); }},
      {{"lambda_cr", unit::metres, "critical wavelength", "λ_cr = 4π² G Σ/κ² (Toomre 1964)"},
       [](Checked c) { return known(c, c.derived.lambda_cr); }},
      {of_digits(3, {"toomre_q", unit::none, "Toomre Q at the start", "κ c_x/(3.36 G Σ)"}),
       [](Checked c) { return known(c, c.derived.toomre_q); }},
      {of_digits(3, {"hill_parameter", unit::none, "Hill parameter r_h",
                     "mutual Hill radius of two equal particles over the sum of their radii"}),
       [](Checked c) {
         return particles_known(c) ? c.derived.hill_parameter
                                   : scene::hill_parameter(c.start.density, distance_from_saturn(c.scene.planet));
       }},
      {of_digits(3, {"midplane_filling", unit::none, "mid-plane filling at the start",
                     "fraction of the plane z = 0 inside spheres, where streamlines are closest; at most 0.55"}),
       [](Checked c) { return known(c, c.derived.midplane_filling); }},
      {of_shape({"box", unit::metres, "box", "sides along the radius and the orbit"}, Shape::other),
       [](Checked c) {
         return particles_known(c) ? Value(std::vector{c.scene.size_x, c.scene.size_y})
                                   : Value(Unknown{"only the start file has it"});
       }},
      {of_shape(of_digits(3, {"box_wavelengths", unit::unnamed("λ_cr"), "  in critical wavelengths",
                              "these sides over λ_cr"}),
                Shape::other),
       [](Checked c) {
         return std::vector{c.scene.size_x / c.derived.lambda_cr, c.scene.size_y / c.derived.lambda_cr};
       },
       particles_known},
      {word("aggregates", "aggregate", "bodies of many particles"), aggregates},
      {word("moonlets", "moonlet", "bodies of one large particle"), moonlets}};
}

std::vector<QuantityRow<CheckedScene>> course_rows() {
  return {
      {{"steps", unit::none, "steps", "length of the run; with an automatic step in shortest steps"},
       [](Checked c) { return static_cast<std::uint64_t>(c.derived.steps); }},
      {{"step", unit::orbits, "a step", "its length; null if it is automatic"},
       [](Checked c) -> Value {
         return c.scene.time.automatic
                    ? Value(Unknown{fmt::format("it is automatic, from 1/{} to 1/{} orbits",
                                                scene::TimeSettings::ticks_per_orbit,
                                                scene::TimeSettings::ticks_per_orbit / scene::TimeSettings::longest)})
                    : Value(c.scene.time.step);
       }},
      {{"kick_interval", unit::orbits, "from kick to kick", "with a fixed step and self-gravity, otherwise null"},
       [](Checked c) -> Value {
         if (!c.scene.gravity)
           return Unknown{};
         return c.scene.time.automatic ? Value(Unknown{"it is automatic, as the step"})
                                       : Value(c.scene.time.step * static_cast<double>(c.scene.gravity->kick_every));
       }},
      {word("gravity", "gravity", "solver and settings of self-gravity, or \"none\""),
       [](Checked c) {
         if (!c.scene.gravity)
           return std::string("none");
         return advice::in_words(particles_known(c) ? chosen_for(c.derived.particle_count, *c.scene.gravity)
                                                    : *c.scene.gravity);
       }},
      {word("resting_contacts", "contacts at rest",
            "treatment of contacts at rest: \"carried\" or \"bounced\"; null without self-gravity between particles"),
       [](Checked c) { return may_rest(c) ? Value(resting_word(c)) : Value(Unknown{}); }},
      {word("resting_reason", "  why", "reason of the default"), [](Checked c) { return resting_reason(c); },
       may_rest}};
}

std::vector<QuantityRow<CheckedScene>> cost_rows() {
  return {
      {of_digits(2, {"memory", unit::megabytes, "memory, an estimate", "largest use, 10⁶ bytes"}),
       [](Checked c) { return known(c, c.derived.memory_mb); }},
      {of_digits(2, {"estimated", unit::seconds, "time on one thread, an estimate",
                     "processor time of `keeler run` on this machine"}),
       [](Checked c) { return c.cost ? Value(c.cost->total()) : Value(Unknown{}); }},
      {word("estimate", "", "null if the particles come from a start file"), [](Checked) { return Unknown{}; },
       [](Checked c) { return !has_estimate(c); }},
      {of_digits(2, {"estimate.start", unit::seconds, "  start", "making the initial state"}),
       [](Checked c) { return c.cost->start; }, has_estimate},
      {of_digits(2, {"estimate.drift", unit::seconds, "  drift", "moving particles, finding and resolving contacts"}),
       [](Checked c) { return c.cost->drift; }, has_estimate},
      {of_digits(2, {"estimate.gravity", unit::seconds, "  gravity", "solves and kicks"}),
       [](Checked c) { return c.cost->gravity; }, has_estimate},
      {of_digits(2, {"estimate.output", unit::seconds, "  output", "files, rows of the series, checks"}),
       [](Checked c) { return c.cost->output; }, has_estimate},
      {word("estimate.dominates", "  most of it", "the largest part"),
       [](Checked c) { return std::string(c.cost->dominating()); }, has_estimate},
      {{"estimate.contacts_per_particle_orbit", unit::none, "", "contacts that the estimate assumes"},
       [](Checked c) { return scene_contacts(c.scene).wakes.all(); },
       has_estimate},
      {{"estimate.grains_in_piles", unit::none, "", "particles at rest on large bodies that the estimate assumes"},
       [](Checked c) {
         return advice::GrainPiles(c.scene).grains(static_cast<double>(c.scene.time.end_step) * c.scene.time.step);
       },
       has_estimate},
      {word("notices", "note", "rounded or dropped settings, one text each"),
       [](Checked c) { return c.scene.notices; }},
      {word("doubts", "note", "unusual settings, and results that this patch cannot resolve, one text each"),
       [](Checked c) { return c.warnings; }},
      {word("costs", "note", "settings that multiply the cost by five or more, one text each"), [](Checked c) {
         return particles_known(c) ? advice::expensive_settings(c.scene) : std::vector<std::string>();
       }}};
}

std::vector<QuantityRow<CheckedScene>> all_rows() {
  return joined(joined(patch_rows(), course_rows()), cost_rows());
}

} // namespace

Record record_of(const CheckedScene& checked) {
  return {entries_of(all_rows(), checked), {}};
}

std::vector<Quantity> check_quantities() {
  return quantities_of(all_rows());
}

} // namespace keeler::cli
