// All ranks throw an error together and go on, as when they write a broken state; then one of them fails alone.
#include <keeler/comm/communicator.hpp>

int main() {
  const keeler::Communicator ranks = keeler::Communicator::launched();
  try {
    ranks.together([] { throw keeler::InvariantError("of all ranks"); });
  } catch (const keeler::Error&) {
    if (!keeler::comm::take_common_error())
      return 1;
  }
  if (ranks.rank() == 1)
    keeler::comm::fail_ranks(keeler::ExitCode::invariant);
  ranks.sum(1);
  return 0;
}
