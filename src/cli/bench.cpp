// keeler bench: times the program's kernels on this machine.
#include "bench.hpp"

namespace keeler::cli {

void add_bench(CLI::App& program, Action& action, const Communicator& ranks) {
  CLI::App& command = *program.add_subcommand("bench", "time a kernel on this machine");
  command.require_subcommand(1);
  add_bench_drift(command, action);
  add_bench_gravity(command, action);
  add_bench_step(command, action, ranks);
  add_bench_light(command, action);
}

} // namespace keeler::cli
