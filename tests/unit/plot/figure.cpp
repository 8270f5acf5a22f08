#include <keeler/plot/figure.hpp>

#include <doctest/doctest.h>

#include <cmath>
#include <string>

namespace figure_test {

using namespace keeler;
using namespace keeler::plot;

namespace {

Figure figure() {
  Panel panel{.title = "Cost < gain",
              .x = {.label = "step (orbits)", .log = true},
              .y = {.label = "error", .log = true},
              .shaded = AxisRange{0.01, 0.1}};
  panel.curves.push_back({.name = "tree\x1b", .points = {{0.01, 1e-4, 2e-4, "first"}, {0.1, 1e-2}}, .marks = true});
  panel.curves.push_back(
      {.name = "fft", .points = {{0.1, NAN}, {0.0, 1.0}, {0.2, 0.1, 0.01}}, .colour = 1, .band = true});
  panel.curves.push_back({.points = {{1.0, 5.0}}, .colour = std::nullopt, .columns = true});
  Panel words{.x = {.range = {-0.5, 1.5}, .words = {"certified", std::string(200, 'w')}}, .curves = {{}}};
  return {.title = "Errors", .note = "as of now", .panels = {panel, words}, .columns = 2, .width = 800};
}

std::string text_of(const Figure& figure, PageFormat format, double scale = 1.0) {
  const std::vector<std::byte> bytes = figure_bytes(figure, format, scale);
  return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

} // namespace

TEST_CASE("a figure is a file of each format") {
  const std::string svg = text_of(figure(), PageFormat::svg), png = text_of(figure(), PageFormat::png, 2.0);
  CHECK(svg.starts_with("<svg "));
  CHECK(svg.find("width=\"800px\"") != std::string::npos);
  CHECK(svg.ends_with("</svg>\n"));
  CHECK(png.starts_with("\x89PNG\r\n"));
  CHECK(png.substr(16, 4) == std::string("\0\0\x06\x40", 4)); // 1600 pixels wide
  CHECK(text_of(figure(), PageFormat::pdf).starts_with("%PDF-"));
  CHECK(svg == text_of(figure(), PageFormat::svg));
}

TEST_CASE("the description of an SVG has all its labels") {
  const std::string svg = text_of(figure(), PageFormat::svg);
  for (const char* const label : {"Errors", "as of now", "Cost &lt; gain", "step (orbits)", "error", "tree?", "fft",
                                  "first", "10^{-3}", "certified"})
    CHECK_MESSAGE(svg.find(std::string("\n") + label + "\n") != std::string::npos, label);
  CHECK(svg.find("www…\n") != std::string::npos);
}

TEST_CASE("the format is chosen by the extension") {
  CHECK(page_format("a.svg") == PageFormat::svg);
  CHECK(page_format("b.png") == PageFormat::png);
  CHECK(page_format("c.pdf") == PageFormat::pdf);
  CHECK(!page_format("d.jpg"));
  CHECK(!page_format("svg"));
}

} // namespace figure_test
