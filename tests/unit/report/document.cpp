#include <keeler/report/document.hpp>

#include "unit/files/disk.hpp"

#include <doctest/doctest.h>

namespace document_test {

using namespace keeler;
using namespace keeler::report;
using namespace keeler::test;

TEST_CASE("a document says the same in both forms") {
  const TemporaryFolder folder;
  Document document("A < B");
  document.heading("Numbers");
  document.paragraph("Run `keeler` with **care** & N > 1.");
  document.table({{"a", "b"}, {"1", "<2>"}});
  files::write_text(folder / "dot.png", "Man"); // "TWFu" in base64
  document.figure(folder.path(), "dot", "A dot.");
  CHECK(document.markdown().find("## Numbers") != std::string::npos);
  CHECK(document.markdown().find("| a | b |\n|---|---|\n| 1 | <2> |") != std::string::npos);
  const std::string html = document.html();
  CHECK(html.find("<h1>A &lt; B</h1>") != std::string::npos);
  CHECK(html.find("<code>keeler</code> with <b>care</b> &amp; N &gt; 1.") != std::string::npos);
  CHECK(html.find("<td>&lt;2&gt;</td>") != std::string::npos);
  CHECK(html.find("data:image/png;base64,TWFu\"") != std::string::npos);
}

} // namespace document_test
