#include <keeler/core/format.hpp>

#include <keeler/core/printable.hpp>

#include <doctest/doctest.h>

namespace words_test {

using namespace keeler;

TEST_CASE("numbers of moderate size have no exponent") {
  CHECK(format_number(0.0, 3) == "0");
  CHECK(format_number(48.63, 3) == "48.6");
  CHECK(format_number(999.6, 3) == "1000");
  CHECK(format_number(1234.0, 3) == "1230");
  CHECK(format_number(-9999999.0, 7) == "-9999999");
  CHECK(format_number(1e7) == "1e7");
  CHECK(format_number(1.3e9, 2) == "1.3e9");
  CHECK(format_number(2e-8) == "2e-8");
  CHECK(format_number(0.00012, 2) == "0.00012");
}

TEST_CASE("counts have a plural") {
  CHECK(pluralize(1, "thread") == "1 thread");
  CHECK(pluralize(0, "check") == "0 checks");
  CHECK(pluralize(34, "particle") == "34 particles");
}

TEST_CASE("a line with foreign text becomes printable") {
  CHECK(printable_line("Ω of 'a b' is 1e-4 ± 2 %, 10⁵ 𝛀") == "Ω of 'a b' is 1e-4 ± 2 %, 10⁵ 𝛀");
  CHECK(printable_line("a\x1b[31m\n\r\tb\x7f") == "a?[31m???b?");
  CHECK(printable_line("\xff\xfe \xce \xc0\xaf \xe0\x80\xaf \xed\xa0\x80 \xf4\x90\x80\x80 \xc2\x85") ==
        "?? ? ?? ??? ??? ???? ??");
  CHECK(printable_line(std::string("a\0b", 3)) == "a?b");
  CHECK(printable_text("a\x1b]0;t\a\n\tΩ\xff\xc2\x9b") == "a?]0;t?\n\tΩ???");
  CHECK(is_utf8(std::string("a\0\x1b Ω 𝛀 \xc2\x85", 14)));
  for (const char* const bytes : {"\xff", "a\xce", "\xc0\xaf", "\xe0\x80\xaf", "\xed\xa0\x80", "\xf4\x90\x80\x80"})
    CHECK_FALSE(is_utf8(bytes));
  const std::string cut = printable_line("begin " + std::string(1'000'000, 'x') + " end");
  CHECK(cut.size() < 2010);
  CHECK(cut.starts_with("begin xxx"));
  CHECK(cut.ends_with("xxx end"));
  std::string many;
  for (int k = 0; k < 3000; ++k)
    many += "Ω";
  const std::string whole = printable_line(many);
  CHECK(whole.find('?') == std::string::npos);
  CHECK(printable_line(whole) == whole); // cut between characters
}

} // namespace words_test
