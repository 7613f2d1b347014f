// Measures peak memory beyond the input and output arrays. Each case runs in its own process (see peak_memory.cpp).
#include <sys/wait.h>

#include <array>
#include <cstdio>
#include <filesystem>
#include <map>

#include "support/measure.hpp"

namespace blum::bench {
namespace {

/// Runs peak_memory, which prints lines "name value". Returns an empty map if it fails.
std::map<std::string, double> probe(const std::string& arguments) {
  const auto program = std::filesystem::read_symlink("/proc/self/exe").parent_path() / "peak_memory";
  std::map<std::string, double> figures;
  FILE* const pipe = popen(("'" + program.string() + "' " + arguments).c_str(), "r");
  if (pipe == nullptr) return figures;
  std::array<char, 64> name{};
  double value = 0;
  while (std::fscanf(pipe, "%63s %lf", name.data(), &value) == 2) figures[name.data()] = value;
  if (pclose(pipe) != 0) figures.clear();
  return figures;
}

void memory_case(benchmark::State& state, const std::string& name, int n, const std::string& mode) {
  const auto figures = probe(name + " " + std::to_string(n) + " " + mode);
  if (figures.empty()) {
    state.SkipWithError("peak_memory failed");
    return;
  }
  state.SetIterationTime(figures.at("wall_s"));
  for (const auto& [key, value] : figures) state.counters[key] = value;
  state.counters["load"] = machine_load();
}

const bool registered = [] {
  for (const std::string name : {"bunny", "fandisk", "noisy-1.6M"}) {
    for (const std::string mode : {"none", "winding", "normals"}) {
      if (name == "bunny" && mode == "normals") continue;  // an open mesh
      add("memory/" + name + "/512/" + mode, [=](benchmark::State& state) { memory_case(state, name, 512, mode); });
    }
  }
  add("memory/image/512/shell", [](benchmark::State& state) { memory_case(state, "image", 512, "unsigned"); });
  return true;
}();

}  // namespace
}  // namespace blum::bench
