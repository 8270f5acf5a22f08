#include <keeler/core/simd.hpp>

#include <keeler/core/error.hpp>
#include <keeler/gravity/solver.hpp>

#include <doctest/doctest.h>

#include <cstdlib>

namespace simd_test {

using namespace keeler;
using namespace keeler::gravity;

namespace {

// Sets KEELER_SIMD for one scope and restores its value.
class Environment {
public:
  explicit Environment(const char* value) {
    const char* old = std::getenv("KEELER_SIMD");
    had_ = old != nullptr;
    old_ = had_ ? old : "";
    setenv("KEELER_SIMD", value, 1);
  }
  ~Environment() {
    if (had_)
      setenv("KEELER_SIMD", old_.c_str(), 1);
    else
      unsetenv("KEELER_SIMD");
  }

private:
  bool had_;
  std::string old_;
};

} // namespace

TEST_CASE("KEELER_SIMD names the instruction set, and a wrong name is a usage error") {
  for (const InstructionSet set : {InstructionSet::portable, InstructionSet::avx2, InstructionSet::avx512}) {
    const Environment environment(instruction_set_name(set));
    if (supports(set)) {
      CHECK(choose_instruction_set() == set);
      CHECK_NOTHROW(make_gravity_solver({}, std::vector<double>(100, 1.0), 1e4));
    } else {
      CHECK_THROWS_AS(choose_instruction_set(), UsageError);
    }
  }
  {
    const Environment environment("sse9");
    CHECK_THROWS_WITH_AS(make_gravity_solver({}, std::vector<double>(100, 1.0), 1e4),
                         "KEELER_SIMD=sse9 is not a known instruction set; use portable, avx2 or avx512, or unset it",
                         UsageError);
  }
  const Environment environment("");
  CHECK(supports(choose_instruction_set()));
}

TEST_CASE("the portable kernels run everywhere") {
  CHECK(supports(InstructionSet::portable));
}

} // namespace simd_test
