#include <keeler/batch/claims.hpp>

#include "unit/files/disk.hpp"

#include <doctest/doctest.h>

#include <memory>

namespace claims_test {

using namespace keeler;
using namespace keeler::batch;
using namespace keeler::test;

TEST_CASE("a name is claimed by one at a time, and free again when its claimant lets go or ends") {
  const TemporaryFolder work;
  Claims first(work / "claims");
  auto second = std::make_unique<Claims>(work / "claims");
  CHECK(first.take("a"));
  CHECK(first.take("a")); // already claimed by this object
  CHECK_FALSE(second->take("a"));
  CHECK(second->take("b"));
  CHECK_FALSE(first.take("b"));
  first.release("a");
  CHECK(second->take("a"));
  second.reset();
  CHECK(first.take("a"));
  first.wait_for("b");
  Claims third(work / "claims");
  CHECK_FALSE(third.take("b"));
}

} // namespace claims_test
