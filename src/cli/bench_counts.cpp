#include "bench_counts.hpp"

#include "print.hpp"

#include <keeler/core/words.hpp>

#include <fmt/format.h>

namespace keeler {

void add_drift_counts(nlohmann::ordered_json& json, const TimedSteps& timed) {
  json["pairs_per_particle"] = timed.per_particle_step(timed.pairs_tested);
  json["survivors_per_particle"] = timed.per_particle_step(timed.survivors);
  json["contacts"] = timed.contacts;
  json["recontacts"] = timed.recontacts;
  json["lists_made"] = timed.lists_made;
  json["listed_anew"] = timed.listed_anew;
  json["deferred"] = timed.deferred;
  json["in_sequence"] = timed.in_sequence;
  json["rolled_back"] = timed.rolled_back;
  json["widest_list"] = timed.widest_list;
  json["bytes_per_particle"] = timed.bytes_per_particle;
  json["yardsticks"] = {{"line_ns", timed.yardsticks.line_ns}, {"pair_ns", timed.yardsticks.pair_ns}};
}

void print_over_yardsticks(double ns, const Yardsticks& yardsticks) {
  print("  over what the machine can do      {:.1f} times {:.2f} ns for a line of memory, {:.1f} times {:.2f} ns "
        "for a pair's |d|^2 and d.v\n",
        ns / yardsticks.line_ns, yardsticks.line_ns, ns / yardsticks.pair_ns, yardsticks.pair_ns);
}

void print_pairs(const TimedSteps& timed) {
  print("pairs per particle and step         {} tested, {} handed to the finder\n",
        figures(timed.per_particle_step(timed.pairs_tested), 3), figures(timed.per_particle_step(timed.survivors), 3));
}

} // namespace keeler
