#include <keeler/files/toml_bounds.hpp>

#include <keeler/core/error.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cassert>

namespace keeler::files {
namespace {

constexpr std::size_t max_bytes = std::size_t{64} << 20; // parsed, a text takes about 50 times its size

// Returns the text before the first control character, which TOML does not allow: the parser will report it.
std::string_view text_before_control(std::string_view text) {
  const auto is_control = [](char c) {
    return static_cast<unsigned char>(c) < 0x20 && c != '\t' && c != '\n' && c != '\r';
  };
  return text.substr(0, static_cast<std::size_t>(std::find_if(text.begin(), text.end(), is_control) - text.begin()));
}

// Counts the dots since the last end of a name, and the open brackets. Names and values are not distinguished: no value
// has more than one dot.
class Nesting {
public:
  explicit Nesting(std::string_view text) : text_(text) {}

  std::optional<TomlExcess> excess() {
    for (; at_ < text_.size(); ++at_) {
      if (is_too_deep(text_[at_]))
        return here();
      if (text_[at_] == '#')
        at_ = std::min(text_.find('\n', at_), text_.size()) - 1;
      else if (text_[at_] == '"' || text_[at_] == '\'')
        at_ = end_of_string() - 1;
    }
    return std::nullopt;
  }

private:
  bool is_too_deep(char c) {
    switch (c) {
    case '.':
      return ++dots_ >= max_toml_depth;
    case '[':
    case '{':
      dots_ = 0;
      return ++open_ > max_toml_depth;
    case ']':
    case '}':
      open_ -= open_ > 0 ? 1 : 0;
      [[fallthrough]];
    case '\n':
    case '=':
    case ',':
      dots_ = 0;
    }
    return false;
  }

  // Returns the position after the string that begins at at_.
  std::size_t end_of_string() const {
    const char quote = text_[at_];
    assert(quote == '"' || quote == '\'');
    const bool several_lines = text_.substr(at_).starts_with(std::string(3, quote));
    const std::string closing(several_lines ? 3 : 1, quote);
    std::size_t at = at_ + closing.size();
    while (at < text_.size() && !text_.substr(at).starts_with(closing)) {
      if (text_[at] == '\n' && !several_lines) // not TOML
        return at;
      at += text_[at] == '\\' && quote == '"' ? 2 : 1;
    }
    at += closing.size();
    while (several_lines && at < text_.size() && text_[at] == quote) // quotes before the closing ones
      ++at;
    return std::min(at, text_.size());
  }

  TomlExcess here() const {
    const std::string_view before = text_.substr(0, at_);
    const std::string_view line = before.substr(before.rfind('\n') + 1); // npos + 1 is 0
    const auto begins_character = [](char c) { return (static_cast<unsigned char>(c) & 0xc0) != 0x80; };
    return {static_cast<std::size_t>(std::count(before.begin(), before.end(), '\n')) + 1,
            static_cast<std::size_t>(std::count_if(line.begin(), line.end(), begins_character)) + 1,
            fmt::format("{} (valid input has only a few); shorten it",
                        dots_ > 0
                            ? fmt::format("a name of more than {} parts", max_toml_depth)
                            : fmt::format("lists or tables inside each other, more than {} deep", max_toml_depth))};
  }

  std::string_view text_;
  std::size_t at_ = 0, dots_ = 0, open_ = 0;
};

} // namespace

std::optional<TomlExcess> toml_excess(std::string_view text) {
  if (text.size() > max_bytes)
    return TomlExcess{1, 1,
                      fmt::format("the text has more than {} MB (tables of numbers belong in separate files); "
                                  "shorten it",
                                  max_bytes >> 20)};
  return Nesting(text_before_control(text)).excess();
}

void require_bounded_toml(std::string_view text, const std::string& name) {
  if (const std::optional<TomlExcess> excess = toml_excess(text))
    throw UsageError(fmt::format("{}:{}:{}: {}", name, excess->line, excess->column, excess->what));
}

std::string toml_fault(std::string_view description) {
  if (description.ends_with("is not representable in 64 bits") ||
      description.ends_with("could not be interpreted as a value"))
    return "the number is too large (whole numbers end at 9223372036854775807, others at 1.8e308); lower it";
  std::string reason(description);
  std::replace_if(
      reason.begin(), reason.end(), [](char c) { return static_cast<unsigned char>(c) < 0x20; }, ' ');
  return fmt::format("not TOML ({}); correct this line", reason);
}

} // namespace keeler::files
