// Runs the tests on every rank; all fail where one does.
#define DOCTEST_CONFIG_IMPLEMENT
#include <doctest/doctest.h>

#include "launched.hpp"

using namespace keeler;

namespace {
Ranks ranks;
}

const Ranks& keeler_test::launched() {
  return ranks;
}

int main(int argc, char** argv) {
  ranks = Ranks::launched();
  doctest::Context context(argc, argv);
  if (!ranks.is_first())
    context.setOption("minimal", true); // speaks of failures alone
  const bool failed = ranks.any(context.run() != 0);
  finish_ranks();
  return failed ? 1 : 0;
}
