#include <keeler/core/registry.hpp>

#include <keeler/core/error.hpp>

#include <doctest/doctest.h>

namespace registry_test {

using namespace keeler;

namespace {

struct Law {
  const char* name;
  std::vector<Key> keys{};
};

template<class Call> std::string fault_of(const Call& call) {
  try {
    call();
  } catch (const UsageError& error) {
    return error.what();
  }
  return "no fault";
}

Key key(const char* name) {
  return {.path = name, .type = KeyType::number, .fallback = "1.0"};
}

} // namespace

TEST_CASE("added entries come after Keeler's in the order of their names, and what a reader has seen stays") {
  Registry<Law> laws("law", &Law::name, {{"z"}, {"b"}});
  const auto names = [](const std::vector<Law>& list) {
    std::string all;
    for (const Law& law : list)
      all += std::string(law.name) + " ";
    return all;
  };
  laws.add({"d"});
  laws.add({"c2"});
  laws.add({"c"});
  const std::vector<Law>& before = laws.entries();
  const Law* const first = before.data();
  CHECK(names(before) == "z b c c2 d ");
  CHECK(&laws.entries() == &before);
  laws.add({"c1"});
  CHECK(names(laws.entries()) == "z b c c1 c2 d ");
  CHECK(names(before) == "z b c c2 d ");
  CHECK(before.data() == first);
}

TEST_CASE("an added entry can be replaced, with its keys, and one of Keeler's cannot") {
  Registry<Law> laws("law", &Law::name, {{"z", {key("scale")}}}, KeyTable::shared);
  laws.add({"a", {key("size")}});
  const std::vector<Law>& before = laws.entries();
  CHECK(fault_of([&] { laws.add({"a", {key("size")}}); }).starts_with("there is a law 'a' already"));
  laws.add({"a", {key("size"), key("width")}}, IfTaken::replace);
  laws.add({"c", {}}, IfTaken::replace); // nothing to replace
  CHECK(laws.entries().size() == 3);
  CHECK(laws.entries()[1].keys.size() == 2);
  CHECK(before[1].keys.size() == 1);
  CHECK(fault_of([&] { laws.add({"z"}, IfTaken::replace); }).starts_with("there is a law 'z' already"));
  CHECK(fault_of([&] {
          laws.add({"a", {key("scale")}}, IfTaken::replace);
        }).starts_with("the key 'scale' of the law 'a' is in its table already"));
  CHECK(laws.entries()[1].keys.size() == 2);
}

TEST_CASE("a name must be plain and its own") {
  Registry<Law> laws("law", &Law::name, {{"a"}});
  for (const char* name : {"", "A", "1a", "a b", "a.b", "ä", "_a", static_cast<const char*>(nullptr)})
    CHECK(fault_of([&] { laws.add({name}); }).starts_with("a law cannot be called '"));
  CHECK(fault_of([&] { laws.add({"a"}); }) == "there is a law 'a' already; give this law another name");
  laws.add({"b_2"});
  CHECK(fault_of([&] { laws.add({"b_2"}); }).starts_with("there is a law 'b_2' already"));
}

TEST_CASE("keys must be complete, and differ where laws share a table") {
  Registry<Law> laws("law", &Law::name, {{"a", {key("scale")}}}, KeyTable::shared),
      forces("force", &Law::name, {{"a", {key("scale")}}});
  forces.add({"b", {key("scale")}});
  CHECK(fault_of([&] {
          laws.add({"b", {key("scale")}});
        }) == "the key 'scale' of the law 'b' is in its table already; give it another name");
  CHECK(fault_of([&] { laws.add({"b", {key("law")}}); }).starts_with("the key 'law' of the law 'b' is in its table"));
  CHECK(fault_of([&] { laws.add({"b", {key("c"), key("c")}}); }).starts_with("the law 'b' has a key 'c'"));
  CHECK(fault_of([&] { laws.add({"b", {key("c.d")}}); }).starts_with("the law 'b' has a key 'c.d'"));
  Key conditional = key("c");
  conditional.only_with = {"d", {"on"}};
  CHECK(fault_of([&] { laws.add({"b", {conditional}}); }).starts_with("the key 'c' of the law 'b' depends on another"));
  Registry<Law> starts("start", &Law::name, {}, KeyTable::shared); // also the first entry has no key "law"
  CHECK(fault_of([&] {
          starts.add({"a", {key("law")}});
        }).starts_with("the key 'law' of the start 'a' is in its table"));
  Key bare = key("c"), choice = key("c"), rows = key("c");
  bare.fallback.clear();
  choice.type = KeyType::choice;
  rows.type = KeyType::rows;
  for (const Key& incomplete : {bare, choice, rows})
    CHECK(fault_of([&] { laws.add({"b", {incomplete}}); }).starts_with("the key 'c' of the law 'b' is incomplete"));
}

} // namespace registry_test
