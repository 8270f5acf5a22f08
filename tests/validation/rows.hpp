// Keeler held against exact solutions, conservation laws and the literature: the rows of docs/validation.md.
#pragma once

#include "rows/rows.hpp"

#include <keeler/io/series.hpp>
#include <keeler/particles/patch.hpp>
#include <keeler/runs/transport.hpp>

#include <functional>
#include <string>
#include <vector>

namespace keeler::validation {

/// One number against another.
struct Row {
  std::string what;
  double measured = 0.0, error = 0.0; ///< 0: no statistical error
  double expected = 0.0, tolerance = 0.0;
  std::string tolerance_is; ///< what the tolerance stands for
  std::string source;
  std::string command; ///< what makes the run, with its seed, box and length

  std::string known_difference{}; ///< why a row that does not hold is no fault of Keeler's; empty: it would be one

  bool holds() const;
};

/// What is measured together.
struct Subject {
  std::string name;    ///< for --only
  std::string section; ///< of the page
  bool quick = false;  ///< a minute or less: CI runs it too
  std::function<std::vector<Row>()> measure;
};

std::vector<Subject> exact_subjects();
std::vector<Subject> two_body_subjects();
std::vector<Subject> balance_subjects();
std::vector<Subject> literature_subjects();
std::vector<Subject> overstability_subjects();
std::vector<Subject> fluid_wave_subjects();
std::vector<Subject> particle_subjects();
std::vector<Subject> satellite_subjects();
std::vector<Subject> moonlet_subjects();
std::vector<Subject> light_subjects();
std::vector<Subject> light_of_rings_subjects();

/// A run of a scene of examples/, by its folder or its file, with some keys set, in a folder that is gone afterwards.
struct Ran {
  std::string command; ///< that does the same
  io::SeriesTable series;
  io::SeriesTable moonlets; ///< empty in a scene that has none
  std::vector<Patch> snapshots;
};
Ran run_example(const std::string& example, const std::vector<std::string>& overrides);

/// Keys for self-gravity wakes at a Hill parameter r_h: equal spheres of 1 m in the A ring, in a box of so many
/// critical wavelengths radially, and 8 along the orbit.
std::vector<std::string> wakes(double hill, int seed, double orbits, int width = 8);

/// Mean of a column of the series from an orbit on, with its error by blocks.
Estimate mean_since(const Ran& ran, const char* column, double orbit);

/// Mean of independent values, one per seed for example, with its standard error.
Estimate mean_of(const std::vector<double>& values);

/// Viscosities and balance from an orbit on.
runs::Transport transport_since(const Ran& ran, double orbit);

} // namespace keeler::validation
