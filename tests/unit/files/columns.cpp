#include <keeler/files/columns.hpp>

#include <keeler/core/error.hpp>

#include <doctest/doctest.h>

#include <cmath>
#include <string>
#include <vector>

namespace columns_test {

using namespace keeler;
using namespace keeler::files;

namespace {

std::string fault(std::string_view text) {
  try {
    parse_columns(text, "t.csv");
  } catch (const UsageError& error) {
    return error.what();
  }
  return {};
}

} // namespace

TEST_CASE("tables as spreadsheets, numpy and pandas write them") {
  const std::string with_byte_order_mark = std::string("\xef\xbb\xbf") + "a,b\n1,-2500\n3,4\n";
  for (const std::string& text : std::vector<std::string>{
           "a,b\n1,-2.5e3\n+3,4\n", "\"a\" , \"b\"\r\n1, -2.5e3\r\n 3,4", "a;b\n1;-2500\n\n3;4\n",
           "# made by hand\na b\n1   -2500\n# more\n3\t4\n", "# a,b\n1,-2500\n3,4\n", with_byte_order_mark}) {
    CAPTURE(text);
    const Columns columns = parse_columns(text, "t.csv");
    CHECK(columns.names == std::vector<std::string>{"a", "b"});
    CHECK(columns.values == std::vector<std::vector<double>>{{1.0, 3.0}, {-2500.0, 4.0}});
  }
  for (const std::string comments : {"# a,b\n# made by me, and you\n", "# of, two\n#a,b\n", "#a,b\n#\n"})
    CHECK(parse_columns(comments + "1,2\n", "t.csv").names == std::vector<std::string>{"a", "b"});
  const Columns lines = parse_columns("# of me\n\na,b\n1,2\n\n# pause\n3,nan\n", "t.csv");
  CHECK(lines.header_line == 3);
  CHECK(lines.lines == std::vector<std::size_t>{4, 7});
  CHECK(std::isnan(lines.values[1][1]));
  CHECK(parse_columns("", "t.csv").names.empty());
  CHECK(parse_columns("a,b\n", "t.csv").lines.empty());
  CHECK(parse_columns("x\n0.1\n", "t.csv").values[0][0] == 0.1); // the nearest double
}

TEST_CASE("a table that is not a text is reported as such") {
  CHECK(fault(std::string("\xff\xfex\0,\0", 6)) ==
        "t.csv: is a text in UTF-16 (its byte order mark says so); save it as UTF-8");
  CHECK(fault("a,b\n" + std::string(2, '\0') + ",2\n") ==
        "t.csv:2: a is '?\?' (it must be a number); correct it or remove the row");
}

TEST_CASE("an irregular row is an error that names it") {
  CHECK(fault("a,b\n1,2\n3\n") ==
        "t.csv:3: the row has 1 of 2 values (line 1 names the columns); correct or remove it");
  CHECK(fault("a,b\n1,2,3\n").find("t.csv:2: the row has 3 of 2 values") == 0);
  CHECK(fault("a b\n1 2 3\n").find("t.csv:2: the row has 3 of 2 values") == 0);
  CHECK(fault("a,b\n1,two\n") == "t.csv:2: b is 'two' (it must be a number); correct it or remove the row");
  CHECK(fault("a,b\n1,1e999\n").find("b is '1e999'") != std::string::npos);
  CHECK(fault("a,b\n1,2 3\n").find("b is '2 3'") != std::string::npos);
  CHECK(fault("a,b\n,2\n") == "t.csv:2: a has no value (every row needs all columns); fill it in or remove the row");
  CHECK(fault("1,2\n") ==
        "t.csv:1: the first row has numbers (it must name the columns); put a line of names above it");
  CHECK(fault("a,b,\n1,2,\n") == "t.csv:1: the last column has no name (the line ends with a ','); remove it here and "
                                 "at the ends of the rows");
  CHECK(fault("# a;b;\n1;2;\n").find("t.csv:1: the last column has no name (the line ends with a ';')") == 0);
  CHECK(fault(",a,b\n0,1,2\n") ==
        "t.csv:1: the first column has no name (pandas writes its index so); write the table with "
        "index=False, or remove the column");
  CHECK(fault("\"\",\"a\"\n0,1\n").find("t.csv:1: the first column has no name") == 0);
  CHECK(fault("a,,b\n0,1,2\n") == "t.csv:1: column 2 has no name; name it or remove it");
  CHECK(fault("a,b\n1,2,\n") ==
        "t.csv:2: the row ends with a ',' (line 1 names 2 columns, and does not); remove that ','");
}

} // namespace columns_test
