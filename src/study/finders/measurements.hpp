// The single measurements of the finder study, each a JSON object.
#pragma once

#include "job_list.hpp"
#include "perturbed_ring/perturbed_ring.hpp"
#include "states.hpp"

namespace keeler {

/// The paper's five, in its order.
inline const std::vector<std::string> paper_finders = {"original", "newton-full", "newton-cubic", "linear-full",
                                                       "linear-cubic"};

/// Those and the certified one, which the graphs show.
std::vector<std::string> shown_finders();

/// All names of finder_table().
std::vector<std::string> all_finders();

constexpr double study_orbits = 0.1; // length of a run, as in the paper

/// A run with every grid candidate handed to the finder: cpu_s, and ns_per_call on the pairs of its first step.
Json timed_run(const StudyState& state, double step, const std::string& finder);

/// The same run, each call held against the certified finder: counts, verdict, histograms, the overlap at the end.
Json audited_run(const StudyState& state, double step, const std::string& finder);

/// Runs with the finder and, on recorded answers, without: what share of the time is the finder's.
Json finder_fraction(const StudyState& state, double step, const std::string& finder, int repeats);

/// What the time of a call leaves out: the start of a step for finders that keep something (ns a particle); and the
/// certified search without its rejection (ns a call).
Json call_details(const StudyState& state, double step, int repeats);

/// The first step's pairs: the certified finder against a dense scan.
Json scan_check(const StudyState& state, double step);

/// Runs with the drift's own rejection in front of every finder, interleaved, and what it leaves of the pairs.
Json rejection(const StudyState& state, double step, int repeats);

/// Cost and truth of each finder when a share of the particles has changed its velocity earlier in the step.
Json local_times(const StudyState& state, double step, double share, int repeats);

/// Figure 1: how far the means of a perturbed ring drift on a path.
Json drift_of_means(const PerturbedRing& ring, const std::string& path);

} // namespace keeler
