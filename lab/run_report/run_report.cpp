#include <keeler/run_report/run_report.hpp>

#include "assets.hpp"
#include "number_tables.hpp"
#include "particle_view.hpp"
#include "series_plots.hpp"

#include <keeler/advice/warnings.hpp>
#include <keeler/core/format.hpp>
#include <keeler/core/json_of_files.hpp>
#include <keeler/core/phase_progress.hpp>
#include <keeler/core/version.hpp>
#include <keeler/initial_conditions/initial.hpp>
#include <keeler/initial_conditions/possible.hpp>
#include <keeler/io/series.hpp>
#include <keeler/io/snapshot.hpp>
#include <keeler/light/photometry.hpp>
#include <keeler/render/patch_picture.hpp>
#include <keeler/report/html.hpp>
#include <keeler/runs/measured_part.hpp>
#include <keeler/runs/measurement.hpp>
#include <keeler/runs/patch_units.hpp>
#include <keeler/runs/run_view.hpp>
#include <keeler/runs/summary.hpp>
#include <keeler/scene/load.hpp>
#include <keeler/scene/patch_scale.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <utility>
#include <vector>

namespace keeler::run_report {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

// Limits that keep a page small: number of pictures, their widths (pixels) and sizes (bytes).
constexpr std::size_t max_pictures = 4;
constexpr int picture_width = 1200, lit_picture_width = 900, earlier_picture_width = 600, min_embedded_width = 300;
constexpr std::size_t picture_bytes = 1'250'000, lit_picture_bytes = 450'000, earlier_picture_bytes = 430'000;

// Particles measured, over all snapshots: limits the time that a page of large patches takes.
constexpr std::size_t max_measured_particles = 3'000'000, max_singly_measured_particles = 1'000'000;

// Returns at most `max_count` indices out of `count`, evenly spaced, with the first and the last.
std::vector<std::size_t> evenly(std::size_t count, std::size_t max_count) {
  std::vector<std::size_t> indices;
  const std::size_t n = std::min(count, std::max<std::size_t>(max_count, 1));
  for (std::size_t k = 0; k < n; ++k)
    indices.push_back(n == 1 ? count - 1 : k * (count - 1) / (n - 1));
  return indices;
}

bool contains(const std::vector<std::size_t>& indices, std::size_t index) {
  return std::find(indices.begin(), indices.end(), index) != indices.end();
}

// Returns a script element with JSON. "</" is escaped, so that a title cannot end the element.
std::string data_element(const std::string& id, const Json& json) {
  std::string text = json_text(json);
  for (std::size_t at = text.find("</"); at != std::string::npos; at = text.find("</", at + 3))
    text.insert(at + 1, "\\");
  return fmt::format("<script type=\"application/json\" id=\"{}\">{}</script>\n", id, text);
}

std::string section(const std::string& id, const std::string& title, const std::string& content) {
  return fmt::format("<section id=\"{}\">\n<h2>{}</h2>\n{}</section>\n", id, title, content);
}

std::string folded(const std::string& title, const std::string& content) {
  return fmt::format("<details><summary>{}</summary>\n{}</details>\n", title, content);
}

std::string note(const std::string& text) {
  return "<p>" + report::html_inline(text) + "</p>\n";
}

bool has_view() {
  return !asset("three.min.js").empty() && !asset("OrbitControls.js").empty();
}

bool has_plots() {
  return !asset("dygraph.min.js").empty();
}

// Draws a patch, reducing look.width until the picture has at most `bytes` bytes or the minimum width.
std::vector<std::byte> picture_within(std::size_t bytes, const Patch& patch, render::PictureOptions& look) {
  for (;;) {
    std::vector<std::byte> png = patch_png(patch, look);
    if (png.size() <= bytes || look.width <= min_embedded_width)
      return png;
    const double factor = 0.95 * std::sqrt(static_cast<double>(bytes) / static_cast<double>(png.size()));
    look.width = std::max(min_embedded_width, static_cast<int>(factor * look.width));
  }
}

// Keeps as many patches as the limit allows, always the newest. Precondition: `patches` is not empty.
void thin_out(std::vector<Patch>& patches) {
  assert(!patches.empty() && patches.back().size() > 0);
  const std::size_t max_count = std::max<std::size_t>(1, max_measured_particles / patches.back().size());
  std::vector<Patch> some;
  for (const std::size_t k : evenly(patches.size(), max_count))
    some.push_back(std::move(patches[k]));
  patches = std::move(some);
}

std::string figure(const Patch& patch, const std::vector<std::byte>& png, const char* how = "") {
  return fmt::format("<figure><img alt=\"the patch at orbit {0}{2}\" src=\"data:image/png;base64,{1}\">"
                     "<figcaption>orbit {0}{2}</figcaption></figure>\n",
                     format_number(patch.time_orbits, 4), report::base64(png), how);
}

class RunPage {
public:
  RunPage(const fs::path& folder, const RunReportOptions& options)
      : folder_(folder), max_snapshots_(options.snapshots), units_(options.units), progress_(options.progress),
        run_(runs::view_run(folder)), files_(runs::snapshots_in(folder)) {}

  std::string html();

private:
  void read_snapshots();
  std::string pictures();
  std::string lit_picture(render::PictureOptions look) const;
  std::string view() const;
  std::string plots(const runs::TransportReport& transport) const;
  std::string measured(runs::MeasuredPart part);
  std::string accuracy() const;
  std::string scene_section() const;
  std::string provenance() const;
  std::string head() const;
  std::string facts() const;

  fs::path folder_;
  std::size_t max_snapshots_; // in the view
  std::optional<quantities::UnitSystem> units_;
  PhaseProgress progress_;
  runs::RunView run_;
  std::vector<fs::path> files_;
  ParticleView particles_{max_particles_in_view};
  std::vector<Patch> pictured_;
  std::vector<quantities::Record> measured_; // some of the viewed snapshots, one by one
  io::SnapshotMeta meta_;                    // of the newest snapshot
  std::optional<Scene> scene_;
  std::optional<quantities::Record> summary_; // none while the run is in progress, or after it was killed
};

void RunPage::read_snapshots() {
  const std::vector<std::size_t> viewed = evenly(files_.size(), max_snapshots_);
  const std::vector<std::size_t> drawn = evenly(viewed.size(), max_pictures);
  std::vector<std::size_t> measured;
  progress_.begin("snapshots", static_cast<double>(viewed.size()));
  for (std::size_t k = 0; k < viewed.size(); ++k) {
    const fs::path& file = files_[viewed[k]];
    io::Snapshot snapshot = io::read_snapshot(file);
    initial_conditions::require_possible(snapshot.patch, file.string());
    particles_.add(snapshot.patch, file.filename().string());
    meta_ = std::move(snapshot.meta);
    if (k == 0)
      measured = evenly(viewed.size(), max_singly_measured_particles / snapshot.patch.size());
    if (measured.size() > 1 && contains(measured, k))
      measured_.push_back(record_of(runs::measure({&snapshot.patch, 1}, {})));
    if (contains(drawn, k))
      pictured_.push_back(std::move(snapshot.patch));
    progress_.add(1.0);
  }
  scene_ = scene::parse_stored_scene(meta_.scene, files_.back().string());
}

// Draws the newest snapshot large and earlier ones small, all at one scale. Precondition: read_snapshots() was called.
std::string RunPage::pictures() {
  assert(!pictured_.empty() && scene_);
  render::PictureOptions look;
  look.title = scene_->title.empty() ? "Ring patch" : scene_->title;
  for (const Patch& patch : pictured_) {
    const render::PictureScale scale = picture_scale(patch, look.colour);
    if (look.scale)
      look.scale->include(scale);
    else
      look.scale = scale;
  }
  progress_.begin("pictures", static_cast<double>(pictured_.size()));
  look.width = earlier_picture_width;
  std::string earlier;
  for (std::size_t k = 0; k + 1 < pictured_.size(); ++k) {
    earlier += figure(pictured_[k], picture_within(earlier_picture_bytes, pictured_[k], look));
    progress_.add(1.0);
  }
  look.width = picture_width;
  const std::string last = figure(pictured_.back(), picture_within(picture_bytes, pictured_.back(), look));
  progress_.add(1.0);
  return section("pictures", "The patch",
                 last + lit_picture(look) + "<div class=\"earlier\">\n" + earlier + "</div>\n");
}

// Draws the newest snapshot in sunlight, as keeler render --lit does by default; nothing in a Keeler without Embree.
std::string RunPage::lit_picture(render::PictureOptions look) const {
  if (!light::can_trace())
    return {};
  look.width = lit_picture_width;
  look.lit = render::usual_lit_look();
  return figure(pictured_.back(), picture_within(lit_picture_bytes, pictured_.back(), look), ", in sunlight");
}

std::string RunPage::view() const {
  if (!has_view())
    return section("view", "In three dimensions",
                   note("This program was built without the library three.js, so the view is not available."));
  return section("view", "In three dimensions", std::string(asset("view.html"))) +
         data_element("view-data", particles_.json());
}

std::string RunPage::plots(const runs::TransportReport& report) const {
  if (run_.series.rows() < 2)
    return section("series", "Through time", note("The series has fewer than two rows."));
  if (!has_plots())
    return section("series", "Through time",
                   note("This program was built without the library dygraphs, so the series is not drawn here."));
  const std::optional<runs::Transport> steady = steady_part(report);
  std::string words = "No steady part of the run was detected, so no means are given.";
  if (steady)
    words = fmt::format(
        "Means are over orbits {} to {} (shaded), {}; their errors are by blocks, since consecutive rows "
        "are correlated.",
        format_number(steady->since_orbit, 3), format_number(steady->until_orbit, 4),
        steady->steady ? "where the run is steady" : "the best available part, though the run is not steady yet");
  if (steady && steady->waves)
    words += fmt::format(" Axisymmetric waves as long as the box hold {}.", describe(*steady->waves));
  words +=
      " Curves are means over consecutive rows, bands their standard errors where a mean is over several "
      "rows. Drag along an axis to zoom, double-click to see all. In the last plot any quantity may be on either axis: "
      "the curves, and the numbers of keeler analyze of single snapshots.";
  const runs::RingScale scale =
      runs::RingScale::of(pictured_.back(), !scene_->external_forces.empty(), scene_->gravity.has_value());
  const DrawnUnits units{units_.value_or(quantities::UnitSystem::si), runs::units_of(pictured_.back())};
  return section("series", "Through time", note(words) + "<div id=\"plots\"></div>\n") +
         data_element("series-data",
                      json_of(series_plots(run_.series, scale, steady, units), number_curves(measured_, units)));
}

std::string RunPage::measured(runs::MeasuredPart part) {
  thin_out(part.stored.patches);
  progress_.begin("measuring", 2.0 * static_cast<double>(part.stored.patches.size()));
  const quantities::Record numbers =
      record_of(measure(part.stored.patches, part.transport, {}, [this] { progress_.add(2.0); }));
  return section(
      "measured", "Measured",
      note(fmt::format("The numbers of `keeler analyze`: structure from {}; viscosities and the balance over the "
                       "orbits of the means above.",
                       pluralize(part.stored.patches.size(), "snapshot"))) +
          measured_table(numbers, units_) + folded("All numbers, by their names in JSON", all_numbers(numbers)));
}

std::string RunPage::accuracy() const {
  if (!summary_)
    return section("accuracy", "Accuracy and cost",
                   note("The run has not ended, so costs and errors are not known yet (summary.json is missing)."));
  std::string speed;
  const auto number = [&](const char* name) { return number_in(*summary_, name).value_or(0.0); };
  for (const char* const part : {"drift", "gravity", "series"})
    speed += fmt::format("{}{} {} ns", speed.empty() ? "" : ", ", part,
                         format_number(number(fmt::format("ns_per_particle_step.{}", part).c_str()), 3));
  return section(
      "accuracy", "Accuracy and cost",
      accuracy_table(*scene_, *summary_) + "<h3>Time</h3>\n" + timing_table(*summary_) +
          note(fmt::format("{}, {} s of processor time, {} MB at most. Per particle and step: {}.",
                           pluralize(static_cast<std::uint64_t>(number("threads")), "thread"),
                           format_number(number("cpu"), 4), format_number(number("peak_memory"), 4), speed)));
}

std::string RunPage::scene_section() const {
  const Patch& last = pictured_.back();
  std::string words;
  for (const std::string& notice : scene_->notices)
    words += note("Note: " + notice);
  scene::PatchScale scale = initial_conditions::scale_of(last);
  scale.start = {}; // the warnings on initial states do not apply to a later state
  for (const std::string& warning : advice::warnings(*scene_, scale))
    words += note("Note: " + warning);
  return section("scene", "The scene",
                 derived_table(*scene_, last) + words +
                     folded("The resolved scene, all keys", "<pre>" + report::html_text(meta_.scene) + "</pre>\n"));
}

std::string RunPage::provenance() const {
  std::vector<std::vector<std::string>> rows = {{"the newest snapshot was made by", ""}};
  for (const auto& [name, value] : meta_.provenance)
    rows.push_back({name, value});
  if (const quantities::Value* const hash = summary_ ? find_value(*summary_, "state_hash") : nullptr)
    if (const auto* const text = std::get_if<std::string>(hash))
      rows.push_back({"state hash", *text});
  rows.push_back({"this page by", "keeler " + program_version()});
  if (has_view())
    rows.push_back({"with three.js", "© 2010–2019 the three.js authors, MIT licence, threejs.org"});
  if (has_plots())
    rows.push_back({"with dygraphs", "© Dan Vanderkam and others, MIT licence, dygraphs.com"});
  return section("provenance", "Provenance", report::html_table(rows));
}

std::string RunPage::facts() const {
  const quantities::Value* const value = summary_ ? find_value(*summary_, "finished") : nullptr;
  const bool* const finished = value ? std::get_if<bool>(value) : nullptr;
  const std::string state = run_.running            ? "in progress"
                            : !summary_             ? "interrupted"
                            : finished && *finished ? "finished"
                                                    : "stopped before the end";
  return note(fmt::format("{} particles, {} of {} orbits, {}.", pictured_.back().size(), format_number(run_.orbits, 4),
                          format_number(run_.end_orbits, 4), state));
}

std::string RunPage::head() const {
  std::string styles;
  for (const char* name : {"page.css", "dygraph.min.css"})
    styles += asset(name);
  return fmt::format("<!DOCTYPE html>\n<html lang=\"en\"><head><meta charset=\"utf-8\">\n<meta name=\"viewport\" "
                     "content=\"width=device-width\">\n<title>{}</title>\n<style>\n{}</style></head>\n",
                     report::html_text(scene_->title.empty() ? folder_.string() : scene_->title), styles);
}

std::string scripts() {
  std::string all;
  for (const char* name : {"three.min.js", "OrbitControls.js", "dygraph.min.js", "plots.js", "stage.js", "view.js"})
    all += fmt::format("<script>\n{}\n</script>\n", asset(name));
  return all;
}

std::string RunPage::html() {
  read_snapshots();
  if (fs::exists(folder_ / "summary.json"))
    summary_ = runs::read_summary(folder_);
  runs::MeasuredPart part = runs::measured_part(folder_, {});
  const std::string title = scene_->title.empty() ? folder_.filename().string() : scene_->title;
  std::string page = head() + "<body>\n<h1>" + report::html_text(title) + "</h1>\n" + facts();
  page += pictures();
  page += view() + plots(part.transport);
  page += measured(std::move(part));
  page += accuracy() + scene_section() + provenance();
  return page + scripts() + "</body></html>\n";
}

} // namespace

std::string run_report(const fs::path& folder, const RunReportOptions& options) {
  return RunPage(folder, options).html();
}

} // namespace keeler::run_report
