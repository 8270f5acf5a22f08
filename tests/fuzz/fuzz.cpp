// The fuzzer: fuzz --target=NAME [libFuzzer's options] [corpus]
#include "targets.hpp"

#include <keeler/core/threads.hpp>

#include <cstdint>
#include <cstdio>
#include <cstdlib>

namespace {

using keeler::fuzz::Target;

const Target* target = nullptr;
std::filesystem::path folder;

} // namespace

extern "C" int LLVMFuzzerInitialize(int* argc, char*** argv) {
  constexpr std::string_view option = "--target="; // libFuzzer passes over what begins with two dashes
  for (int k = 1; k < *argc; ++k)
    if (const std::string_view word = (*argv)[k]; word.starts_with(option))
      target = keeler::fuzz::find_target(word.substr(option.size()));
  if (!target) {
    std::fputs("fuzz: name a target: --target=NAME, one of", stderr);
    for (const Target& known : keeler::fuzz::targets)
      std::fprintf(stderr, " %s", known.name.data());
    std::fputs("\n", stderr);
    std::exit(2);
  }
  keeler::set_threads(1);
  folder = keeler::fuzz::make_folder();
  return 0;
}

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  keeler::fuzz::run(target->fuzzed, {reinterpret_cast<const char*>(data), size}, folder);
  return 0;
}
