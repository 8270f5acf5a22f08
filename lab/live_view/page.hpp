// The page itself: one file with all scripts in it.
#pragma once

#include <string>

namespace keeler::live_view {

struct Page {
  std::string html;
  std::string policy; ///< its Content-Security-Policy
};

/// Makes the page for a title of any origin. Scripts run only with `nonce`, a random text.
Page make_page(const std::string& title, const std::string& nonce);

} // namespace keeler::live_view
