// keeler study step, kicks, mesh, box, sizes: studies of a user's scene.
#pragma once

#include "command.hpp"

#include <string>
#include <vector>

namespace keeler {

/// Adds these five subcommands to `keeler study`.
void add_scene_studies(CLI::App& study, Action& action, const std::vector<std::string>& arguments);

} // namespace keeler
