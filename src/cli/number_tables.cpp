#include "number_tables.hpp"

#include "bench_numbers.hpp"
#include "check_numbers.hpp"

#include <keeler/light/occultation_record.hpp>
#include <keeler/light/photometry_record.hpp>

namespace keeler::cli {

std::vector<NumberTable> further_number_tables() {
  return {{"keeler photometry: a sight", light::photometry_quantities()},
          {"keeler occultation: a line of sight", light::occultation_quantities()},
          {"keeler occultation: the model of wakes", light::wake_model_quantities()},
          {"keeler check", check_quantities()},
          {"keeler bench step", step_bench_quantities()},
          {"keeler bench drift", drift_bench_quantities()},
          {"keeler bench light", light_bench_quantities()}};
}

} // namespace keeler::cli
