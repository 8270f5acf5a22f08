// Progress on standard error: one line that redraws itself on a terminal and fits its width, one line every ten seconds
// elsewhere.
#pragma once

#include "talk.hpp"

#include <keeler/core/progress.hpp>
#include <keeler/initial_conditions/clumped.hpp>
#include <keeler/runs/run.hpp>

#include <optional>
#include <string>
#include <vector>

namespace keeler {

class ProgressLine {
public:
  /// What a line says, the most important first.
  using Parts = std::vector<std::string>;

  explicit ProgressLine(const TalkOption& talk = {});
  ~ProgressLine();
  void show(const StartProgress& progress);
  void show(const RunProgress& progress);
  void show(const ClumpingProgress& progress);
  void show(const Progress& progress);
  /// The same of work that is mostly over before anybody looks: nothing is shown then.
  void show_if_long(const Progress& progress);

  /// A note, on a line of its own.
  void note(const std::string& text);

private:
  double patience_s() const;
  void begin_phase(const std::string& phase, double elapsed_s);
  // Whether it is time for the next line.
  bool due(double elapsed_s, bool last);
  void print(std::optional<double> share, const Parts& parts);

  bool terminal_;
  TalkOption talk_;
  std::string phase_; // that was said to have begun
  double next_s_ = 0.0;
  bool open_ = false; // a line without its end is on the terminal
};

} // namespace keeler
