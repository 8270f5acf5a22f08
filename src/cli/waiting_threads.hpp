#pragma once

namespace keeler::cli {

/// Makes threads of OpenMP sleep while they wait, unless the environment says how they wait. Threads that spin make a
/// run ten times slower on a busy machine. May start the program again with `argv`; if that fails it continues.
void let_threads_sleep(char** argv);

} // namespace keeler::cli
