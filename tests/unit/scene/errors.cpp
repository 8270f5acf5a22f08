#include "scenes.hpp"

#include <keeler/config/schema.hpp>
#include <keeler/scene/keys.hpp>
#include <keeler/scene/load.hpp>

#include <doctest/doctest.h>

namespace errors_test {

using namespace keeler;
using namespace keeler::scene;
using namespace keeler::test;

namespace {

std::string with(const std::string& part, const std::string& by) {
  return fault(changed(least, part, by));
}

} // namespace

TEST_CASE("unknown names are reported with a suggestion") {
  CHECK(with("density", "densty") ==
        "s.toml:7:1: unknown key particles.densty (no scene has it); did you mean \"density\"?");
  CHECK(with("density", "dnesity") ==
        "s.toml:7:1: unknown key particles.dnesity (no scene has it); did you mean \"density\"?");
  CHECK(with("[particles]", "[particle]") ==
        "s.toml:5:2: unknown table particle (no scene has it); did you mean \"particles\"?");
  CHECK(with("radius", "raduis") ==
        "s.toml:8:26: unknown key particles.sizes.raduis (no scene has it); did you mean \"radius\"?");
  CHECK(with("end = 2", "end = 2\nsolver = \"tree\"") ==
        "s.toml:11:1: unknown key time.solver (no scene has it); did you mean \"gravity.solver\"?");
  CHECK(with("end = 2", "end = 2\nwibble = 1") ==
        "s.toml:11:1: unknown key time.wibble (no scene has it); \"keeler check --defaults\" lists every key");
  CHECK(with("[planet]", "\"box.size\" = 1\n[planet]") ==
        "s.toml:1:1: unknown key \"box.size\" (no scene has it); did you mean \"box.size\"?");
}

TEST_CASE("wrong types are reported with the type that is needed") {
  CHECK(with("900", "\"900\"") ==
        "s.toml:7:11: particles.density is a string, but must be a number from 0.01 to 30000 (density of the "
        "particles' material, in kg/m^3); write for example density = 600.0");
  CHECK(with("300", "300.5") ==
        "s.toml:6:9: particles.count is a number with a fraction, but must be a whole number from "
        "1 to 1e9 (number of particles); write for example count = 10000");
  CHECK(with("[100, 50.0]", "[100]") ==
        "s.toml:4:8: box.size is a list of 1 number, but must be two numbers above 0 and at most 1e7 (radial and "
        "azimuthal size of the patch, in m); write for example size = [245.0, 245.0]");
  CHECK(with("{ law = \"equal\", radius = 1.0 }", "1.0") ==
        "s.toml:8:9: particles.sizes is a number with a fraction, but must be a table (it holds several keys); write "
        "[particles.sizes] and its keys below");
  CHECK(with("[time]", "[[time]]").rfind("s.toml:9:1: time is a list of tables, but must be a table", 0) == 0);
  CHECK(with("end = 2", "end = 2021-01-01").rfind("s.toml:10:7: time.end is a date or time, but must be", 0) == 0);
  CHECK(with("300", "{ a = 1 }").rfind("s.toml:6:9: particles.count is a table, but must be", 0) == 0);
}

TEST_CASE("whole numbers may have an exponent; too large ones are reported as such") {
  for (const char* const three_hundred : {"3e2", "300.0", "3.0e+2", "300"})
    CHECK(parse_scene(changed(least, "300", three_hundred), "s.toml").particles.count == 300);
  CHECK(parse_scene(least, "s.toml", {"particles.count=3e2"}).resolved == parse_scene(least, "s.toml").resolved);
  CHECK(with("count = 300", "count = 1e300").find("particles.count is 1e+300, but must be a whole number") !=
        std::string::npos);
  CHECK(with("count = 300", "count = 300\nseed = 18446744073709551615")
            .ends_with(
                "the number is too large (whole numbers end at 9223372036854775807, others at 1.8e308); lower it"));
  CHECK(with("900", "1e400").find("the number is too large") != std::string::npos);
  CHECK(
      fault(least, {"particles.seed=18446744073709551615"}) ==
      "--set particles.seed=18446744073709551615: particles.seed is 1.8446744073709552e+19, but must be a whole number "
      "from 0 to 9.22337e18 (seed of all random numbers); write for example seed = 1");
  CHECK(fault(least, {"particles.density=1e400"}).find("is a number too large or too small to compute with") !=
        std::string::npos);
  CHECK(parse_scene(least, "s.toml", {"particles.sizes.radius=.5"}).particles.sizes.largest == 0.5);
  CHECK(parse_scene(least, "s.toml", {"title=.5"}).title == ".5");
  CHECK(parse_scene(least, "s.toml", {"particles.seed=9223372036854775807"}).particles.seed == 9223372036854775807U);
}

TEST_CASE("nesting depth and number of entries of a scene are bounded") {
  const auto repeated = [](const std::string& part, std::size_t count) {
    std::string text;
    for (std::size_t k = 0; k < count; ++k)
      text += part;
    return text;
  };
  const std::string dots = repeated("a.", 100000), open = repeated("[", 100000), braces = repeated("{a=", 100000);
  CHECK(fault(dots + "b = 1\n").rfind("s.toml:1:32: a name of more than 16 parts", 0) == 0);
  CHECK(fault("[" + dots + "b]\n").rfind("s.toml:1:33: a name of more than 16 parts", 0) == 0);
  CHECK(fault("a = " + open + "\n").rfind("s.toml:1:21: lists or tables inside each other, more than 16 deep", 0) == 0);
  CHECK(fault("a = " + braces + "\n").find("more than 16 deep") != std::string::npos);
  CHECK(fault(least, {dots + "b=1"}).find("unknown key (it has more than 16 parts") != std::string::npos);
  CHECK(fault(least, {"a=" + open}).find("more than 16 deep") != std::string::npos);
  CHECK(fault(least, {"title=../../../../../../../../../../../../a"}) == "");
  CHECK(fault("[a.\"" + repeated("x", 1000000) + "\"]\n" + repeated("b", 1000000) + " = 1\n")
            .rfind("s.toml:1:2: unknown table a ", 0) == 0);
  CHECK(fault(least + repeated("[[moonlet]]\nradius = 1.0\ndensity = 900.0\n", 20000))
            .find("20000 tables [[moonlet]] are too many (at most 1000") != std::string::npos);
  CHECK(fault(least + "[particles.modes]\noutward = [" + repeated("[1, 1e-6, 0.0],", 200000) + "]\n")
            .find("[particles.modes] has 200000 modes (at most 1000") != std::string::npos);
  CHECK(fault(least, {"moonlet=[" + repeated("{radius=1.0,density=900.0},", 20000) + "]"}).size() < 1000);
}

TEST_CASE("values out of range are reported with the range") {
  CHECK(with("radius = 1.0", "radius = -1.0") ==
        "s.toml:8:35: particles.sizes.radius is -1.0, but must be a number from 1e-6 to 1000000 (radius of every "
        "particle, in m); write for example radius = 1.0");
  CHECK(with("radius = 1.0", "radius = nan").find("radius is nan, but must be a number from 1e-6") !=
        std::string::npos);
  CHECK(with("radius = 1.0", "radius = inf").find("radius is inf, but must be") != std::string::npos);
  CHECK(with("[100, 50.0]", "[100, -50.0]").find("box.size is [100.0, -50.0], but must be") != std::string::npos);
  CHECK(with("2e-4", "2e-4\nepicyclic_ratio = 2").find("must be a number above 0.1 and below 2") != std::string::npos);
  CHECK(with("end = 2", "end = 2\nstep = 0.3").empty());
  const auto oscillating = [](const char* step) {
    return fault(changed(changed(least, "2e-4", "2e-4\nvertical_ratio = 100"), "end = 2",
                         "end = 2\nstep = " + std::string(step)));
  };
  CHECK(oscillating("1e-3").empty());
  CHECK(oscillating("\"auto\"").empty());
  CHECK(
      oscillating("0.02") ==
      "s.toml:12:8: time.step = 0.02 is 2 vertical oscillations of 100 Omega (above 1.5 the searches for contacts take "
      "too long); lower it to at most 0.005 orbits");
  CHECK(with("end = 2", "end = 2\nstep = 0.31") ==
        "s.toml:11:8: time.step is 0.31, but must be a number from 1e-9 to 0.3, or \"auto\" (length of a step; "
        "\"auto\" adapts it to the state, in orbits); write for example step = 1e-3");
  CHECK(fault(least + "[gravity]\nsolver = \"trea\"\n") ==
        "s.toml:12:10: gravity.solver is \"trea\", but must be one of \"direct\", \"tree\", \"fft\", "
        "\"mesh\", \"axisymmetric\", \"auto\" (how accelerations are computed); did you mean \"tree\"?");
  CHECK(fault(least + "[gravity]\nsolver = \"quantum\"\n") ==
        "s.toml:12:10: gravity.solver is \"quantum\", but must be one of \"direct\", \"tree\", \"fft\", "
        "\"mesh\", \"axisymmetric\", \"auto\" (how accelerations are computed); write for example solver = \"tree\"");
  CHECK(fault(least + "[start]\nfrom = \"\"\n").find("must be the path of a file") != std::string::npos);
}

TEST_CASE("missing keys are reported with an example") {
  CHECK(with("[time]\nend = 2\n", "") ==
        "s.toml:1:1: [time] is missing (it sets the length of the run); add a table [time]");
  CHECK(with("end = 2\n", "") ==
        "s.toml:9:2: time.end is missing (length of the run, rounded to whole kicks, in orbits); "
        "add for example end = 3.0");
  CHECK(with("count = 300\n", "") ==
        "s.toml:5:2: particles.optical_depth is missing (geometric optical depth, which sets the number of particles); "
        "add for example optical_depth = 0.5 or surface_density or count");
  CHECK(with("law = \"equal\", radius = 1.0", "").find("particles.sizes.law is missing") != std::string::npos);
  CHECK(with("law = \"equal\", ", "").find("or give particles.sizes.law = \"equal\"") != std::string::npos);
  CHECK(with("law = \"equal\", radius = 1.0", "law = \"power\", exponent = 3, min = 1")
            .find("particles.sizes.max is missing") != std::string::npos);
  CHECK(with("sizes = { law = \"equal\", radius = 1.0 }\n", "") ==
        "s.toml:5:2: [particles.sizes] is missing (it sets the sizes of the particles); add a table [particles.sizes]");
  CHECK(fault("") == "s.toml:1:1: [planet] is missing (it sets the orbit of the patch); add a table [planet]");
  CHECK(with("count = 300", "count = 300\nstreamlines = { waves = 2 }").find("streamlines.bunching is missing") !=
        std::string::npos);
  CHECK(fault(least + "[collisions]\nrestitution = { law = \"constant\" }\n").find("restitution.value is missing") !=
        std::string::npos);
}

TEST_CASE("contradictions are reported") {
  CHECK(with("count = 300", "count = 300\noptical_depth = 0.5") ==
        "s.toml:7:1: particles.optical_depth cannot be combined with particles.count (each determines the other); keep "
        "one of "
        "the two");
  CHECK(with("orbital_frequency = 2e-4", "preset = \"saturn-a-ring\"\nvertical_ratio = 3.6") ==
        "s.toml:3:1: planet.vertical_ratio does not apply here (it needs planet.orbital_frequency); remove it or "
        "give planet.orbital_frequency");
  CHECK(with("radius = 1.0", "radius = 1.0, min = 0.1") ==
        "s.toml:8:40: particles.sizes.min does not apply here (it needs particles.sizes.law = \"power\"); remove it "
        "or give particles.sizes.law = \"power\"");
  CHECK(fault(least + "[start]\nfrom = \"wakes.hdf\"\n") == "s.toml:3:2: [box] cannot be combined with start.from (the "
                                                            "start file holds the box and its particles); remove one "
                                                            "of the two");
}

TEST_CASE("impossible requests are reported") {
  CHECK(
      with("[100, 50.0]", "[100, 1.5]") ==
      "s.toml:4:8: the box of 100 m x 1.5 m is smaller than a particle (the largest is 2 m across); enlarge the box or "
      "lower the radius");
  CHECK(with("size = ", "size_in_wavelengths = ") ==
        "s.toml:4:23: box.size_in_wavelengths cannot be combined with particles.count (the wavelength follows from the "
        "surface density, and with a count this follows from the box); give box.size or particles.optical_depth");
  // H² = (0.65 × 2)² + 1.7 × 3.6 = 7.81, (4/3) 3.6 / (√(2π) H) = 0.685; 0.62 needs H² = 9.54, so c_x = 2.845, rounded
  // up, or τ = 3.06: (4/3) 3.06 / (√(2π) √(1.69 + 1.7 × 3.06))
  CHECK(with("count = 300", "optical_depth = 3.6") ==
        "s.toml:6:17: too dense (the mid-plane filling factor would be 0.69, and at most 0.62 can be placed "
        "without overlap); raise velocity_dispersion to at least 2.85 or lower the optical depth from 3.6 to at most "
        "3.05");
  CHECK(with("count = 300", "optical_depth = 3.6\nvelocity_dispersion = 2.85") == "");
  CHECK(with("count = 300", "optical_depth = 3.05") == "");
  // 1.8 bunched by q = 0.5 is 3.6 where streamlines are closest
  CHECK(with("count = 300", "optical_depth = 1.8\nstreamlines = { waves = 1, bunching = 0.5 }") ==
        "s.toml:6:17: too dense (the mid-plane filling factor would be 0.69, and at most 0.62 can be placed "
        "without overlap); raise velocity_dispersion to at least 2.85 or lower the optical depth from 1.8 to at most "
        "1.52 or lower the bunching");
  CHECK(with("count = 300", "optical_depth = 1e-6").find("makes 0 particles") != std::string::npos);
  CHECK(with("count = 300", "optical_depth = 0.1\nseed = 3").empty());
  CHECK(
      with("[100, 50.0]\n[particles]\ncount = 300", "[1e7, 1e7]\n[particles]\noptical_depth = 0.1") ==
      "s.toml:6:17: particles.optical_depth with this box makes 3.18e+12 particles (a run takes 1 to 1e9); change the "
      "box or particles.optical_depth");
  CHECK(with("law = \"equal\", radius = 1.0", "law = \"power\", exponent = 3, min = 2, max = 1")
            .find("particles.sizes: min = 2 is not below max = 1") != std::string::npos);
  CHECK(with("[100, 50.0]\n[particles]\ncount = 300", "[2000, 1]\n[particles]\ncount = 300")
            .find("times as long as wide") != std::string::npos);
  CHECK(with("end = 2", "end = 1e300").find("time.end is 1e+300, but must be a number above 0 and at most 1e12") !=
        std::string::npos);
  CHECK(with("end = 2", "end = 1e12\nstep = 1e-9").find("time.end = 1000000000000 is too long") != std::string::npos);
}

TEST_CASE("modes that do not fit the box, or would make streamlines cross, are refused") {
  const auto modes = [](const std::string& keys) { return fault(least + "[particles.modes]\n" + keys + "\n"); };
  CHECK(modes("outward = [[1, 0.1, 0]]").empty());
  CHECK(modes("outward = [[1, 0.1, 0], [0, 0.1, 0]]") ==
        "s.toml:12:11: row 2 of particles.modes.outward has waves: 0 (it must be from 1 to 1000); correct it");
  CHECK(modes("inward = [[1.5, 0.1, 0]]") ==
        "s.toml:12:10: row 1 of particles.modes.inward has 1.5 waves (the box is periodic); give a whole number");
  CHECK(modes("standing = [[1, 1.2, 0]]") ==
        "s.toml:12:12: row 1 of particles.modes.standing has the amplitude 1.2 (it must be above 0 and at most 0.9: at "
        "1 streamlines cross); correct it");
  CHECK(modes("standing = [[1, 0.2, 400]]") ==
        "s.toml:12:12: row 1 of particles.modes.standing has the phase 400 (it must be from -360 to 360 degrees); "
        "correct it");
  CHECK(modes("outward = [[1, 0.5, 0]]\ninward = [[2, 0.5, 0]]") ==
        "s.toml:11:1: the amplitudes of [particles.modes] sum up to 1 (at 1 streamlines cross); lower them to 0.9 in "
        "all");
  CHECK(modes("outward = [[1, 0.1]]").find("rows in place: waves in the box, amplitude") != std::string::npos);
  CHECK(modes("") == "s.toml:11:1: [particles.modes] has no modes; add for example outward = [[1, 0.1, 0.0]]");
  CHECK(modes("outward = []").find("has no modes") != std::string::npos);
  CHECK(modes("outwards = [[1, 0.1, 0]]").find("did you mean \"outward\"?") != std::string::npos);
  CHECK(fault(changed(least, "count = 300", "count = 300\nstreamlines = { waves = 1, bunching = 0.1 }") +
              "[particles.modes]\noutward = [[1, 0.1, 0]]\n") ==
        "s.toml:12:1: [particles.modes] cannot be combined with [particles.streamlines] (each sets the mean motion at "
        "the start); keep one of the two");
  CHECK(fault("planet.preset = \"saturn-b-ring\"\ntime.end = 1\nstart.from = \"w.hdf\"\n"
              "[particles.modes]\noutward = [[1, 0.1, 0]]\n")
            .find("cannot be combined with start.from") != std::string::npos);
  CHECK(fault(changed(least, "count = 300", "optical_depth = 1.8") + "[particles.modes]\noutward = [[1, 0.5, 0]]\n")
            .find("to at most 1.52 or lower the amplitudes of the modes") != std::string::npos);
}

TEST_CASE("waves at the start are longer than particles are across") {
  const auto streamlines = [](const std::string& keys) {
    return with("count = 300", "count = 300\nstreamlines = { " + keys + " }");
  };
  CHECK(streamlines("waves = 50, bunching = 0.1").empty()); // in a box of 100 m, particles of 2 m
  CHECK(streamlines("waves = 1000, bunching = 0.0, inclination = 1.0").empty());
  CHECK(streamlines("waves = 51, bunching = 0.1")
            .find("particles.streamlines has waves of 1.961 m, shorter than the largest particle (2 m across); give at "
                  "most 50 in the box") != std::string::npos);
  for (const std::string direction : {"outward", "inward", "standing"})
    CHECK(fault(least + "[particles.modes]\n" + direction + " = [[2, 0.1, 0], [51, 0.1, 0]]\n")
              .find("particles.modes." + direction + " has waves of 1.961 m") != std::string::npos);
}

TEST_CASE("values that follow from other keys are checked for their range") {
  CHECK(
      with("size = [100, 50.0]\n[particles]\ncount = 300",
           "size_in_wavelengths = [9000, 9000]\n[particles]\nsurface_density = 1e5") ==
      "s.toml:4:23: box.size_in_wavelengths makes box.size 5.93e7, but it must be two numbers above 0 and at most 1e7 "
      "(radial and azimuthal size of the patch, in m); change box.size_in_wavelengths");
  CHECK(with("[100, 50.0]\n[particles]\ncount = 300\ndensity = 900\nsizes = { law = \"equal\", radius = 1.0 }",
             "[1e7, 1e6]\n[particles]\ncount = 4\ndensity = 30000\nsizes = { law = \"equal\", radius = 4e5 }")
            .find("particles.count makes particles.surface_density 3.22e9") != std::string::npos);
}

TEST_CASE("texts that are not TOML and absent files are refused") {
  CHECK(with("size = [100, 50.0]", "size = [100, 50.0").rfind("s.toml:5:", 0) == 0);
  CHECK(with("size = [100, 50.0]", "size = [100, 50.0").find("not TOML (") != std::string::npos);
  CHECK(with("density = 900", "density 900").rfind("s.toml:7:9: not TOML (", 0) == 0);
  CHECK(with("count = 300", "count = 300\ncount = 301").find("not TOML (") != std::string::npos);
  CHECK_THROWS_WITH_AS(load_scene("absent/s.toml"),
                       "absent/s.toml: cannot be read (No such file or directory); check the path and its permissions",
                       UsageError);
  CHECK_THROWS_AS(load_scene("."), UsageError);
}

TEST_CASE("the first fault of the file is reported") {
  CHECK(fault("[time]\nend = \"x\"\n[box]\nsiz = 1\n").rfind("s.toml:2:7: time.end", 0) == 0);
  CHECK(fault("[box]\nsiz = 1\n[time]\nend = \"x\"\n").rfind("s.toml:2:1: unknown key box.siz", 0) == 0);
}

TEST_CASE("every key refuses every wrong type, with one line that names the key") {
  const std::vector<std::pair<KeyType, std::string>> samples = {
      {KeyType::text, "\"word\""},    {KeyType::number, "0.5"},       {KeyType::integer, "5"},
      {KeyType::pair, "[1.0, 2.0]"},  {KeyType::choice, "true"},      {KeyType::choice, "[[1, 2], 3]"},
      {KeyType::choice, "[1, 2, 3]"}, {KeyType::choice, "{ x = 1 }"}, {KeyType::choice, "1979-05-27"},
  };
  for (const Key& key : scene_keys())
    for (const auto& [type, sample] : samples) {
      const bool is_text = key.type == KeyType::text || key.type == KeyType::path || key.type == KeyType::choice ||
                           key.type == KeyType::rows;
      const bool fits = (type == KeyType::text && is_text) ||
                        (type == KeyType::number && key.type == KeyType::number) ||
                        (type == KeyType::integer && (key.type == KeyType::number || key.type == KeyType::integer)) ||
                        (type == KeyType::pair && key.type == KeyType::pair) ||
                        (sample == "[1, 2, 3]" && key.type == KeyType::triple);
      if (fits)
        continue;
      CAPTURE(key.path);
      const config::Section* const section = find_section(key.section());
      const bool in_list = section && section->repeated;
      const std::string name = in_list ? section->path + "[1]." + key.name() : key.path;
      const std::string message = fault(in_list ? section->path + " = [{ " + key.name() + " = " + sample + " }]\n"
                                                : key.path + " = " + sample + "\n");
      CHECK(message.rfind("s.toml:1:", 0) == 0);
      CHECK(message.find(": " + name + " is ") != std::string::npos);
      CHECK(message.find('\n') == std::string::npos);
    }
}

TEST_CASE("damaged scenes are refused or read, with no other outcome") {
  // every prefix of a text, and every text with one character changed: parse_scene may throw nothing but UsageError
  for (std::size_t k = 0; k < least.size(); ++k) {
    CHECK(fault(least.substr(0, k)).find('\n') == std::string::npos);
    for (const char c : {'=', '[', '"', '\n', '\0', '.', '9'}) {
      std::string text = least;
      text[k] = c;
      CHECK(fault(text).find('\n') == std::string::npos);
    }
  }
}

TEST_CASE("a stored scene with a force or a law of another program is refused by its name") {
  const auto stored = [](const std::string& text) -> std::string {
    try {
      parse_stored_scene(text, "run/checkpoint_000003.h5");
    } catch (const UsageError& error) {
      return error.what();
    }
    return "";
  };
  CHECK(stored(least) == "");
  CHECK(stored(std::string(least) + "[gas_drag]\nrate = 0.5\n") ==
        "the scene of 'run/checkpoint_000003.h5' has gas_drag, which this program does not know; continue in the "
        "program that made it");
  CHECK(stored(changed(least, "\"equal\"", "\"lognormal\""))
            .find("has particles.sizes.law = \"lognormal\", which this program does not know") != std::string::npos);
}

} // namespace errors_test
