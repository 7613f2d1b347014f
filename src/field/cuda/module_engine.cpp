
#include <dlfcn.h>
#include <atomic>
#include <cstdlib>
#include <filesystem>
#include <string>
#include <vector>

#include "field/cuda/module_engine.hpp"

#include "blum/core/error.hpp"

namespace blum::cuda {
namespace {

/// Returns the folder of the program or library that contains this function; empty if the system does not report it.
std::filesystem::path own_folder() {
  Dl_info info{};
  if (dladdr(reinterpret_cast<const void*>(&own_folder), &info) == 0 || info.dli_fname == nullptr) return {};
  const std::filesystem::path name = info.dli_fname;
  // A program has the path with which it was called. A path without a folder was found through PATH.
  std::error_code error;
  const std::filesystem::path file =
      std::filesystem::canonical(name.has_parent_path() ? name : "/proc/self/exe", error);
  return error ? std::filesystem::path{} : file.parent_path();
}

std::vector<std::string> places() {
  if (const char* named = std::getenv("BLUM_CUDA_MODULE"); named != nullptr && *named != '\0') return {named};
  std::vector<std::string> result;
  if (const std::filesystem::path folder = own_folder(); !folder.empty()) {
    // Programs are installed in bin, next to lib. In the Python package they are one folder below the library.
    for (const char* where : {".", "../lib", ".."}) {
      result.push_back((folder / where / module_file).lexically_normal().string());
    }
  }
  result.emplace_back(module_file);
  return result;
}

/// Collects the reasons why each candidate for the module could not be loaded.
class Reasons {
 public:
  void missing(const std::string& place) { missing_ += (missing_.empty() ? "" : ", ") + place; }
  void unusable(const std::string& why) { unusable_ += (unusable_.empty() ? "" : "; ") + why; }
  [[nodiscard]] std::string text() const {
    const std::string looked = missing_.empty() ? "" : "not found: " + missing_;
    return "no CUDA module: set BLUM_CUDA_MODULE to its file, or build it, see docs/guide/devices.md (" + looked +
           (looked.empty() || unusable_.empty() ? "" : "; ") + unusable_ + ")";
  }

 private:
  std::string missing_, unusable_;
};

std::atomic<const Module*> replacement{nullptr};

const Module& find_module() {
  Reasons reasons;
  for (const std::string& place : places()) {
    std::error_code error;
    const bool is_path = place.find('/') != std::string::npos;
    if (is_path && !std::filesystem::exists(place, error)) {
      reasons.missing(place);
      continue;
    }
    // The library stays loaded until the process ends, because the CUDA runtime in it requires that.
    void* library = dlopen(place.c_str(), RTLD_NOW | RTLD_LOCAL);
    if (library == nullptr) {
      const char* why = dlerror();
      is_path ? reasons.unusable(why != nullptr ? why : place) : reasons.missing("in the system's library path");
      continue;
    }
    const auto function = reinterpret_cast<ModuleFunction>(dlsym(library, module_symbol));
    if (function == nullptr) {
      reasons.unusable(place + ": is not a CUDA module of Blum");
      continue;
    }
    const Module* module = function();
    if (module != nullptr && module->version == module_version) return *module;
    reasons.unusable(place + ": belongs to another version of Blum");
  }
  throw DeviceError(reasons.text());
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

Call call_of(const Context& context) {
  Call call;
  call.context = &context;
  call.is_cancelled = [](const void* of) { return static_cast<const Context*>(of)->cancel.stop_requested(); };
  call.report = [](const void* of, double fraction) {
    const auto& progress = static_cast<const Context*>(of)->progress;
    if (progress) progress(fraction, "field");
  };
  return call;
}

void check(Status status, const Call& call) {
  switch (status) {
    case Status::done:
      return;
    case Status::out_of_memory:
      throw OutOfMemory(call.message);
    case Status::invalid_mesh:
      throw InvalidMesh(call.message);
    case Status::invalid_grid:
      throw InvalidGrid(call.message);
    case Status::invalid_option:
      throw InvalidOption(call.message);
    case Status::cancelled:
      throw Cancelled();
    case Status::device_error:
      break;
  }
  throw DeviceError(call.message);
}

}  // namespace blum::cuda
