// Progress on standard error: on a terminal one line that is redrawn and fits its width, otherwise one line every ten
// seconds.
#pragma once

#include "talk.hpp"

#include <keeler/core/progress.hpp>
#include <keeler/initial_conditions/clumped.hpp>
#include <keeler/runs/run.hpp>

#include <optional>
#include <string>
#include <vector>

namespace keeler::cli {

class ProgressLine {
public:
  /// The parts of a line, the most important first.
  using Parts = std::vector<std::string>;

  explicit ProgressLine(const TalkOption& talk = {});
  ~ProgressLine();
  void show(const initial_conditions::StartProgress& progress);
  void show(const runs::RunProgress& progress);
  void show(const initial_conditions::ClumpingProgress& progress);
  void show(const Progress& progress);
  /// Shows progress only if the work takes longer than quiet_s().
  void show_if_long(const Progress& progress);

  /// Prints a note on a separate line.
  void note(const std::string& text);

private:
  double quiet_s() const; // duration of work that shows no progress
  void begin_phase(const std::string& phase, double elapsed_s);
  // Returns true when the next line is due.
  bool due(double elapsed_s, bool last);
  void print(std::optional<double> fraction, const Parts& parts);

  bool terminal_;
  TalkOption talk_;
  std::string phase_; // last announced phase
  double next_s_ = 0.0;
  bool open_ = false; // the terminal shows a line without a line end
};

} // namespace keeler::cli
