#include "page.hpp"

#include "assets.hpp"

#include <keeler/render/colour_field.hpp>
#include <keeler/report/html.hpp>
#include <keeler/run_report/assets.hpp>

#include <fmt/format.h>

namespace keeler::live_view {
namespace {

std::string script(const std::string& nonce, std::string_view text) {
  return fmt::format("<script nonce=\"{}\">\n{}\n</script>\n", nonce, text);
}

// Returns the colours of the bar, as the stage wants them.
std::string colours() {
  std::string numbers;
  for (const auto& colour : render::bar_colours(256))
    for (const int channel : colour)
      numbers += fmt::format("{}{}", numbers.empty() ? "" : ",", channel);
  return fmt::format("<script type=\"application/json\" id=\"colours\">[{}]</script>\n", numbers);
}

} // namespace

// Style attributes are allowed, since dygraphs writes some. Only pages of this machine may frame the page, as a
// notebook does.
Page make_page(const std::string& title, const std::string& nonce) {
  Page page;
  page.policy = fmt::format(
      "default-src 'none'; script-src 'nonce-{}'; style-src 'unsafe-inline'; connect-src 'self'; img-src data:; "
      "base-uri 'none'; form-action 'none'; "
      "frame-ancestors http://127.0.0.1:* http://localhost:*",
      nonce);
  page.html = fmt::format("<!DOCTYPE html>\n<html lang=\"en\"><head><meta charset=\"utf-8\">\n<meta name=\"viewport\" "
                          "content=\"width=device-width\">\n<link rel=\"icon\" "
                          "href=\"data:,\">\n<title>{0}</title>\n<style>\n{1}{2}{3}</style></head>\n"
                          "<body>\n<h1>{0}</h1>\n{4}",
                          report::html_text(title), run_report::asset("page.css"), run_report::asset("dygraph.min.css"),
                          asset("live.css"), asset("live.html"));
  page.html += colours();
  for (const char* name : {"three.min.js", "OrbitControls.js", "dygraph.min.js", "plots.js", "stage.js"})
    page.html += script(nonce, run_report::asset(name));
  page.html += script(nonce, asset("live.js")) + "</body></html>\n";
  return page;
}

} // namespace keeler::live_view
