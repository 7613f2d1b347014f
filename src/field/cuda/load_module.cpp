#include "field/cuda/load_module.hpp"

#include <dlfcn.h>

#include <atomic>
#include <cstdlib>
#include <filesystem>
#include <string>
#include <vector>

#include "blum/core/error.hpp"

namespace blum::cuda {
namespace {

/// The folder of the program or library that this function is in; empty where the system does not say.
std::filesystem::path own_folder() {
  Dl_info info{};
  if (dladdr(reinterpret_cast<const void*>(&own_folder), &info) == 0 || info.dli_fname == nullptr) return {};
  std::error_code error;
  const std::filesystem::path file = std::filesystem::canonical(info.dli_fname, error);
  return error ? std::filesystem::path{} : file.parent_path();
}

std::vector<std::string> places() {
  if (const char* named = std::getenv("BLUM_CUDA_MODULE"); named != nullptr && *named != '\0') return {named};
  std::vector<std::string> result;
  if (const std::filesystem::path folder = own_folder(); !folder.empty()) {
    result.push_back((folder / module_file).string());
    // Programs lie in bin beside lib, and in Python's package one folder below the library.
    result.push_back((folder / ".." / "lib" / module_file).lexically_normal().string());
    result.push_back((folder / ".." / module_file).lexically_normal().string());
  }
  result.emplace_back(module_file);
  return result;
}

std::atomic<const Module*> replacement{nullptr};

const Module& find_module() {
  std::string reasons;
  for (const std::string& place : places()) {
    // Stays loaded until the process ends, as the CUDA runtime in it must.
    void* library = dlopen(place.c_str(), RTLD_NOW | RTLD_LOCAL);
    if (library == nullptr) {
      reasons += std::string(reasons.empty() ? "" : "; ") + dlerror();
      continue;
    }
    const auto function = reinterpret_cast<ModuleFunction>(dlsym(library, module_symbol));
    const Module* module = function != nullptr ? function() : nullptr;
    if (module != nullptr && module->version == module_version) return *module;
    reasons += (reasons.empty() ? "" : "; ") + place + ": belongs to another version of Blum";
  }
  throw DeviceError("no CUDA module: build Blum with BLUM_CUDA=ON, or name the file in BLUM_CUDA_MODULE (" + reasons +
                    ")");
}

}  // namespace

const Module& load_module() {
  if (const Module* module = replacement.load(); module != nullptr) return *module;
  static const Module& module = find_module();
  return module;
}

void replace_module(const Module* module) {
  replacement.store(module);
}

}  // namespace blum::cuda
