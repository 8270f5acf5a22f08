// The single measurements of the finder study. Each returns one JSON object.
#pragma once

#include "job_list.hpp"
#include "perturbed_ring/perturbed_ring.hpp"
#include "states.hpp"

namespace keeler::study {

/// The paper's five, in its order.
inline const std::vector<std::string> paper_finders = {"original", "newton-full", "newton-cubic", "linear-full",
                                                       "linear-cubic"};

/// Returns the finders that the graphs show: the paper's five and the certified one.
std::vector<std::string> shown_finders();

/// Returns all names of finder_table().
std::vector<std::string> all_finders();

constexpr double study_orbits = 0.1; // length of a run, as in the paper

/// Times a run with every grid candidate passed to the finder: cpu_s, and ns_per_call on the pairs of its first step.
Json timed_run(const StudyState& state, double step, const std::string& finder);

/// Repeats that run untimed with a FinderAudit: counts, verdict, histograms, and the overlap at the end.
Json audited_run(const StudyState& state, double step, const std::string& finder);

/// Times runs with the finder (cpu_s) and with its recorded answers replayed (cpu_s_without_finder).
Json finder_fraction(const StudyState& state, double step, const std::string& finder, int repeats);

/// Measures costs that the time per call leaves out: the start of a step for finders that store data per particle (ns
/// per particle), and the certified search without its rejection (ns per call).
Json call_details(const StudyState& state, double step, int repeats);

/// Compares the certified finder with a dense scan on the pairs of the first step.
Json scan_check(const StudyState& state, double step);

/// Times interleaved runs without and with the drift's rejection before every finder, and counts the pairs that remain.
Json rejection(const StudyState& state, double step, int repeats);

/// Measures cost and errors of each finder after a fraction of the particles has changed velocity within the step.
Json local_times(const StudyState& state, double step, double moved_fraction, int repeats);

/// Measures how far the means of a perturbed ring drift on a path (Figure 1).
Json drift_of_means(const PerturbedRing& ring, const std::string& path);

} // namespace keeler::study
