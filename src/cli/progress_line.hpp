// Progress on standard error: one line that redraws itself on a terminal, one line every ten seconds elsewhere.
#pragma once

#include <keeler/runs/run.hpp>

namespace keeler {

class ProgressLine {
public:
  ProgressLine();
  ~ProgressLine();
  void show(const RunProgress& progress);

private:
  bool terminal_;
  double next_s_ = 0.0;
  bool open_ = false; // a line without its end is on the terminal
};

} // namespace keeler
