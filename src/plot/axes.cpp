#include <keeler/plot/axes.hpp>

#include <algorithm>
#include <cassert>
#include <cmath>

namespace keeler::plot {
namespace {

constexpr double tick_length = 0.4, tick_width = 0.085, label_gap = 0.4, longest_word = 14.0; // sizes of the text
constexpr double step_along = 6.0, step_upward = 2.8; // the least between labels

// Returns the ticks of an axis with room for `most` steps between labels.
std::vector<Tick> ticks_on(const PlotAxis& axis, double most) {
  if (axis.words.empty())
    return ticks_of(axis.range, axis.log, most);
  std::vector<Tick> ticks;
  for (std::size_t k = 0; k < axis.words.size(); ++k)
    ticks.push_back({static_cast<double>(k), axis.words[k]});
  return ticks;
}

// Returns where a value is on an axis: 0 at the low end, 1 at the high one.
double fraction_of(double value, const PlotAxis& axis) {
  constexpr double far_below = -10.0;
  if (!axis.log)
    return (value - axis.range.low) / (axis.range.high - axis.range.low);
  return value > 0.0 ? std::log(value / axis.range.low) / std::log(axis.range.high / axis.range.low) : far_below;
}

double widest(Page& page, const std::vector<Tick>& ticks, const PlotLook& look) {
  double width = 0.0;
  for (const Tick& tick : ticks)
    width = std::max(width, page.text_width(tick.label, {look.text}));
  return width;
}

// True if words below a frame of this width must be vertical.
bool has_vertical_words(Page& page, const PlotAxis& axis, const PlotLook& look, double width) {
  return !axis.words.empty() &&
         widest(page, ticks_on(axis, 1.0), look) + look.text > width / (axis.range.high - axis.range.low);
}

} // namespace

PlotFrame::PlotFrame(const PageRectangle& place, const PlotAxis& x, const PlotAxis& y, const PlotLook& look)
    : place_(place), x_(x), y_(y), look_(look), x_ticks_(ticks_on(x, place.width / (step_along * look.text))),
      y_ticks_(ticks_on(y, place.height / (step_upward * look.text))) {
  assert(place.width > 0.0 && place.height > 0.0);
}

PagePoint PlotFrame::at(double x, double y) const {
  return {place_.left + place_.width * fraction_of(x, x_), place_.bottom() - place_.height * fraction_of(y, y_)};
}

double PlotFrame::space_left(Page& page, const PlotAxis& y, const PlotLook& look, double height) {
  return widest(page, ticks_on(y, height / (step_upward * look.text)), look) +
         look.text * (tick_length + label_gap + (y.label.empty() ? 0.0 : 1.6));
}

double PlotFrame::space_below(Page& page, const PlotAxis& x, const PlotLook& look, double width) {
  const double labels = has_vertical_words(page, x, look, width)
                            ? std::min(widest(page, ticks_on(x, 1.0), look), longest_word * look.text)
                            : look.text;
  return labels + look.text * (tick_length + label_gap + (x.label.empty() ? 0.0 : 1.6));
}

void PlotFrame::draw_grid(Page& page) const {
  const Colour colour = mix(look_.theme.page, look_.theme.faint_ink, 0.18);
  for (const Tick& tick : x_ticks_)
    if (!tick.label.empty())
      page.line({at(tick.value, 0).x, place_.top}, {at(tick.value, 0).x, place_.bottom()}, colour, 1.0);
  for (const Tick& tick : y_ticks_)
    if (!tick.label.empty())
      page.line({place_.left, at(0, tick.value).y}, {place_.right(), at(0, tick.value).y}, colour, 1.0);
}

void PlotFrame::draw_axes(Page& page) const {
  page.frame(place_.left, place_.top, place_.width, place_.height, line_colour());
  draw_below(page);
  draw_left(page);
}

void PlotFrame::draw_below(Page& page) const {
  const double length = tick_length * look_.text, base = place_.bottom() + length + label_gap * look_.text;
  const bool vertical = has_vertical_words(page, x_, look_, place_.width);
  const TextStyle style{look_.text, look_.theme.faint_ink, vertical ? Align::right : Align::centre};
  double free_from = -HUGE_VAL; // labels that would touch the one before are left out
  for (const Tick& tick : x_ticks_) {
    const double x = at(tick.value, 0).x, half = 0.5 * page.text_width(tick.label, style);
    page.line({x, place_.bottom()}, {x, place_.bottom() + (tick.label.empty() ? 0.5 : 1.0) * length}, line_colour(),
              tick_width * look_.text);
    if (vertical)
      page.text({x + 0.35 * look_.text, base}, page.shortened(tick.label, style, longest_word * look_.text), style,
                true);
    else if (!tick.label.empty() && x - half > free_from) {
      page.text({x, base + 0.75 * look_.text}, tick.label, style);
      free_from = x + half + 0.5 * look_.text;
    }
  }
  page.text({place_.left + 0.5 * place_.width,
             place_.bottom() + space_below(page, x_, look_, place_.width) - 0.15 * look_.text},
            x_.label, {look_.text, look_.theme.ink, Align::centre});
}

void PlotFrame::draw_left(Page& page) const {
  const double length = tick_length * look_.text;
  for (const Tick& tick : y_ticks_) {
    const double y = at(0, tick.value).y;
    page.line({place_.left - (tick.label.empty() ? 0.5 : 1.0) * length, y}, {place_.left, y}, line_colour(),
              tick_width * look_.text);
    page.text({place_.left - length - label_gap * look_.text, y + 0.36 * look_.text}, tick.label,
              {look_.text, look_.theme.faint_ink, Align::right});
  }
  if (!y_.label.empty())
    page.text({place_.left - space_left(page, y_, look_, place_.height) + look_.text, place_.top + 0.5 * place_.height},
              y_.label, {look_.text, look_.theme.ink, Align::centre}, true);
}

} // namespace keeler::plot
