#include "profile_file.hpp"

#include "results.hpp"

#include <keeler/diagnostics/dispersion.hpp>
#include <keeler/diagnostics/radial_profile.hpp>
#include <keeler/report/csv.hpp>

#include <cassert>

namespace keeler::cli {

void write_profiles(const std::filesystem::path& file, std::span<const Patch> patches, std::size_t bins) {
  assert(bins > 0);
  auto rows = nlohmann::ordered_json::array();
  for (const Patch& patch : patches)
    for (const diagnostics::RadialBin& bin : diagnostics::radial_profile(patch, bins)) {
      const auto motion = [&](const Vec3& velocity, int axis) {
        return bin.count > 0 ? nlohmann::ordered_json(diagnostics::velocity_si(patch, velocity)[axis])
                             : nlohmann::ordered_json("");
      };
      rows.push_back({{"time_orbits", patch.time_orbits},
                      {"x_m", bin.x},
                      {"count", bin.count},
                      {"surface_density_kg_m2", bin.surface_density},
                      {"optical_depth", bin.optical_depth},
                      {"velocity_x_m_s", motion(bin.velocity, 0)},
                      {"velocity_y_m_s", motion(bin.velocity, 1)},
                      {"dispersion_x_m_s", motion(bin.dispersion, 0)},
                      {"dispersion_y_m_s", motion(bin.dispersion, 1)},
                      {"dispersion_z_m_s", motion(bin.dispersion, 2)}});
    }
  write_table(file, report::csv_of(rows));
}

} // namespace keeler::cli
