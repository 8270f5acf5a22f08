// The demo's program (scripts/demo) has the commands that the demo runs. The others say here how to build them.
#include "commands.hpp"
#include "number_tables.hpp"

namespace keeler::cli {

std::vector<NumberTable> further_number_tables() {
  return {};
}

void add_check(CLI::App& program, Action& action) {
  leave_out(program, action, "check");
}

void add_generate(CLI::App& program, Action& action, const std::vector<std::string>&) {
  leave_out(program, action, "generate");
}

void add_complete(CLI::App&, Action&) {} // not listed anywhere

void add_info(CLI::App& program, Action& action) {
  leave_out(program, action, "info");
}

void add_convert(CLI::App& program, Action& action) {
  leave_out(program, action, "convert");
}

void add_occultation(CLI::App& program, Action& action) {
  leave_out(program, action, "occultation");
}

void add_photometry(CLI::App& program, Action& action) {
  leave_out(program, action, "photometry");
}

void add_new(CLI::App& program, Action& action) {
  leave_out(program, action, "new");
}

void add_bench(CLI::App& program, Action& action, const Communicator&) {
  leave_out(program, action, "bench");
}

void add_study(CLI::App& program, Action& action, const std::vector<std::string>&) {
  leave_out(program, action, "study");
}

void add_sweep(CLI::App& program, Action& action) {
  leave_out(program, action, "sweep");
}

void add_tile(CLI::App& program, Action& action, const std::vector<std::string>&) {
  leave_out(program, action, "tile");
}

void add_tune(CLI::App& program, Action& action) {
  leave_out(program, action, "tune");
}

void add_view(CLI::App& program, Action& action, const std::vector<std::string>&) {
  leave_out(program, action, "view");
}

void add_watch(CLI::App& program, Action& action) {
  leave_out(program, action, "watch");
}

} // namespace keeler::cli
