#include "scene_arguments.hpp"

namespace keeler::cli {

CLI::Option* SceneArguments::add_to(CLI::App& command, const std::string& name, const std::string& about) {
  command.add_option("--set", overrides, "override a key of the scene; can be repeated: --set particles.count=500")
      ->type_name("KEY=VALUE")
      ->allow_extra_args(false);
  return command.add_option(name, path, about)->type_name("");
}

} // namespace keeler::cli
