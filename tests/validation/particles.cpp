// What particles do one by one: how they spin, and whether they stay together.
#include "rows.hpp"

#include <keeler/cells/overlap.hpp>
#include <keeler/diagnostics/clusters.hpp>

#include <fmt/format.h>

namespace keeler::validation {
namespace {

// Between contacts the random velocities of a ring are an ellipsoid, 1 : 0.52 : 0.66 there. Contacts come as often as
// |v| and rub with ⟨|v|³⟩/⟨|v|⟩, which is 6 % more than in a sphere of the same energy.
std::vector<Row> spins() {
  std::vector<Row> rows;
  for (const double restitution : {0.5, 0.0}) {
    const Ran ran = run_example("papers/morishima-salo-2004",
                                {fmt::format("collisions.friction.tangential_restitution={}", restitution)});
    const double rough = 1.0 - restitution, expected = 2.0 * rough / (14.0 - 5.0 * rough);
    const Estimate ratio = mean_since(ran, "spin_energy_ratio", 30.0);
    rows.push_back(
        {.what = fmt::format("energy of spins over that of the random motion, eps_t {}", restitution),
         .measured = ratio.value,
         .error = ratio.error,
         .expected = expected,
         .tolerance = 0.1 * expected + 2.0 * ratio.error,
         .tolerance_is =
             "10 % and twice the error: the theory is of isotropic velocities, the ring's ellipsoid adds 6 %",
         .source = "2(1 - eps_t)/(14 - 5(1 - eps_t)), Morishima & Salo 2004",
         .command = ran.command});
  }
  return rows;
}

double largest_share(const Ran& ran) {
  return diagnostics::analyze_clusters(std::span(&ran.snapshots.back(), 1), diagnostics::default_cluster_gap)
      .largest_mass_fraction;
}

Row share_row(std::string what, const Ran& ran, double low, double high, const char* source) {
  return {.what = "largest cluster's share of the mass, " + std::move(what),
          .measured = largest_share(ran),
          .expected = 0.5 * (low + high),
          .tolerance = 0.5 * (high - low),
          .tolerance_is = fmt::format("from {} to {}", low, high),
          .source = source,
          .command = ran.command};
}

std::vector<Row> quaoar() {
  constexpr const char* source = "Morgado et al. 2023, Extended Data Fig. 4: models 1 and 4";
  return {share_row("Quaoar's ring, frost at 210 K: it accretes",
                    run_example("quaoar", {"collisions.restitution={ law = \"bridges\", scale = 0.3202 }"}), 0.5, 1.0,
                    source),
          share_row("Quaoar's ring, compacted frost at 123 K: it stays a ring", run_example("quaoar", {}), 0.0, 0.05,
                    source)};
}

std::vector<Row> aggregates() {
  constexpr const char* source = "aggregates above r_h 1.1 to 1.2, none below 0.7: Karjalainen & Salo 2004, Salo 1995";
  const auto ring = [](double density) {
    return run_example("aggregates", {"box.size=[125,125]", fmt::format("particles.density={}", density)});
  };
  return {share_row("r_h 1.25", ring(1151.6), 0.3, 1.0, source), share_row("r_h 0.65", ring(161.9), 0.0, 0.05, source)};
}

// A pile of 18 J that has settled by then.
Row rest_of_pile(const std::string& law) {
  const Ran ran = run_example("hard-spheres/one-pile.toml", {"collisions.restitution=" + law});
  const std::vector<double>&orbits = ran.series.of("time_orbits"), &lost = ran.series.of("energy_lost_j");
  std::size_t since = orbits.size() - 1;
  while (since > 0 && orbits[since] > orbits.back() - 0.1 + 1e-9)
    --since;
  return {.what = "lost by a bound pile at rest, J an orbit, restitution " + law,
          .measured = (lost.back() - lost[since]) / (orbits.back() - orbits[since]),
          .expected = 0.0,
          .tolerance = 0.18,
          .tolerance_is = "1 % of its binding energy, 18 J",
          .source = "what rests loses nothing",
          .command = ran.command};
}

std::vector<Row> contacts_at_rest() {
  const Ran ring = run_example("hard-spheres/ring.toml", {});
  const runs::Transport t = transport_since(ring, 1.5);
  std::vector<Row> rows{{.what = "loss over work of the shear, optical depth 1, r_h 1.1",
                         .measured = t.balance->value,
                         .error = t.balance->error,
                         .expected = 1.0,
                         .tolerance = 0.03,
                         .tolerance_is = "3 %",
                         .source = "energy is conserved in a steady state",
                         .command = ring.command},
                        {.what = "largest overlap in it, of a radius sum",
                         .measured = cells::largest_overlap(ring.snapshots.back()).depth,
                         .expected = 0.0,
                         .tolerance = 1e-11,
                         .tolerance_is = "rounding",
                         .source = "hard spheres",
                         .command = ring.command}};
  for (const char* const law : {R"({law="constant",value=0.5})", R"({law="bridges",scale=0.34})"})
    rows.push_back(rest_of_pile(law));
  return rows;
}

} // namespace

std::vector<Subject> particle_subjects() {
  return {{"spins", "Spins", false, spins},
          {"quaoar", "Aggregates", false, quaoar},
          {"aggregates", "Aggregates", false, aggregates},
          {"resting", "Contacts at rest", false, contacts_at_rest}};
}

} // namespace keeler::validation
