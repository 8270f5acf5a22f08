// Scene texts that the tests share.
#pragma once

#include <keeler/core/error.hpp>
#include <keeler/scene/load.hpp>

#include <string>
#include <vector>

namespace keeler::test {

/// A scene with only the needed keys; the line numbers are part of the expected messages.
inline const std::string least = "[planet]\n"                                  // 1
                                 "orbital_frequency = 2e-4\n"                  // 2
                                 "[box]\n"                                     // 3
                                 "size = [100, 50.0]\n"                        // 4
                                 "[particles]\n"                               // 5
                                 "count = 300\n"                               // 6
                                 "density = 900\n"                             // 7
                                 "sizes = { law = \"equal\", radius = 1.0 }\n" // 8
                                 "[time]\n"                                    // 9
                                 "end = 2\n";                                  // 10

/// Returns the text with the first occurrence of a part changed. Precondition: the part is there.
inline std::string changed(std::string text, const std::string& part, const std::string& by) {
  return text.replace(text.find(part), part.size(), by); // throws out_of_range when absent
}

/// Returns the message for the user, or "" if the scene is accepted.
inline std::string fault(const std::string& text, const std::vector<std::string>& overrides = {}) {
  try {
    parse_scene(text, "s.toml", overrides);
  } catch (const UsageError& error) {
    return error.what();
  }
  return "";
}

} // namespace keeler::test
