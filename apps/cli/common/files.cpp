#include "common/files.hpp"

#include <unistd.h>

#include <algorithm>
#include <fstream>
#include <limits>
#include <map>
#include <optional>
#include <sstream>
#include <string>
#include <system_error>
#include <vector>

#include "blum/core/error.hpp"
#include "common/options.hpp"
#include "common/summary.hpp"

namespace blum::cli {
namespace {

namespace fs = std::filesystem;

/// Returns the last `parts` components of a path.
std::string tail_of(const fs::path& path, std::size_t parts) {
  const std::vector<fs::path> all(path.begin(), path.end());
  fs::path out;
  for (std::size_t k = all.size() - std::min(parts, all.size()); k < all.size(); ++k) out /= all[k];
  return out.string();
}

fs::path resolved(const fs::path& path) {
  std::error_code error;
  fs::path whole = fs::weakly_canonical(path, error);
  return error ? fs::absolute(path, error).lexically_normal() : whole;
}

bool same_file(const fs::path& a, const fs::path& b) {
  std::error_code error;
  return fs::equivalent(a, b, error) || resolved(a) == resolved(b);
}

void check_writable(const fs::path& path) {
  std::error_code error;
  if (fs::is_directory(path, error)) throw FileError("'" + path.string() + "' is a folder; give the name of a file");
  const fs::path target = resolved(path);
  const fs::path folder = target.has_parent_path() ? target.parent_path() : fs::path(".");
  if (!fs::is_directory(folder, error)) {
    throw FileError("'" + path.string() + "' cannot be written: there is no folder '" + folder.string() + "'");
  }
  const bool replaced_in_folder = !fs::exists(target, error) || fs::is_regular_file(target, error);
  if (replaced_in_folder && access(folder.c_str(), W_OK) != 0) {
    throw FileError("'" + path.string() + "' cannot be written: no permission to write in '" + folder.string() + "'");
  }
}

/// Reads a number from a file. It is the number after `key`, in lines like "MemAvailable: 123 kB". If the key is empty,
/// it is the first number.
std::optional<double> number_in(const char* file, std::string_view key) {
  std::ifstream stream(file);
  std::string line;
  while (std::getline(stream, line)) {
    if (!line.starts_with(key)) continue;
    std::istringstream rest(line.substr(key.size()));
    double value = 0;
    if (rest >> value) return value;
  }
  return std::nullopt;
}

}  // namespace

double available_memory() {
  double bytes = std::numeric_limits<double>::infinity();
  if (const auto kib = number_in("/proc/meminfo", "MemAvailable:")) {
    bytes = (*kib + number_in("/proc/meminfo", "SwapFree:").value_or(0)) * 1024;
  }
  const auto limit = number_in("/sys/fs/cgroup/memory.max", "");
  return limit ? std::min(bytes, *limit) : bytes;
}

InputKind input_kind(const fs::path& path) {
  switch (content_of(path)) {
    case FileContent::mesh:
      return InputKind::mesh;
    case FileContent::image:
      return InputKind::image;
    case FileContent::field:
      return InputKind::field;
    default:
      break;
  }
  throw FileError("'" + path.string() +
                  "' is a medial axis; a mesh, an image or a field is needed here (`blum info`, `blum verify` and "
                  "`blum reconstruct` read axes)");
}

void check_may_be_field(const fs::path& path) {
  const InputKind kind = input_kind(path);
  if (may_hold_field(path)) return;
  throw FileError("'" + path.string() + "' is " + (kind == InputKind::mesh ? "a mesh" : "an image") +
                  ", not a field; compute its field with `blum field` first");
}

std::string extensions_help(const std::vector<FileContent>& contents, FileAccess access) {
  std::string out;
  for (const FileContent content : contents) {
    out += (out.empty() ? "" : " or ") + std::string(to_string(content)) + " (" + extension_list(content, access) + ")";
  }
  if (!out.empty()) out[0] = static_cast<char>(out[0] - 'a' + 'A');
  return out;
}

fs::path with_label(const fs::path& path, std::int64_t label) {
  fs::path name = path.parent_path() / path.stem();
  name += "-label" + std::to_string(label);
  name += path.extension();
  return name;
}

void check_outputs(const std::vector<fs::path>& outputs, const std::vector<fs::path>& inputs) {
  for (std::size_t i = 0; i < outputs.size(); ++i) {
    for (const fs::path& input : inputs) {
      if (same_file(outputs[i], input)) {
        throw UsageError("the output '" + outputs[i].string() + "' is also the input; choose another name for it");
      }
    }
    for (std::size_t j = 0; j < i; ++j) {
      if (resolved(outputs[i]) == resolved(outputs[j])) {
        throw UsageError("two outputs have the name '" + outputs[i].string() + "'; choose different names");
      }
    }
  }
  for (std::size_t i = 0; i < inputs.size(); ++i) {
    std::error_code error;
    if (!fs::is_fifo(inputs[i], error)) continue;
    for (std::size_t j = 0; j < i; ++j) {
      if (!same_file(inputs[i], inputs[j])) continue;
      throw UsageError("'" + inputs[i].string() +
                       "' is a pipe and is given twice, but it can be read only once; write it to a file");
    }
  }
  for (const fs::path& output : outputs) check_writable(output);
}

void check_extension(std::string_view option, const fs::path& path, const std::vector<std::string>& known) {
  if (path.empty()) throw UsageError(std::string(option) + " needs a file name");
  if (std::find(known.begin(), known.end(), file_extension(path)) != known.end()) return;
  std::error_code error;
  const bool is_input = !option.starts_with("--");
  throw UsageError(std::string(option) + " '" + path.string() + "': the extension must be " + join_words(known, "or") +
                   (is_input && (path == "-" || fs::is_fifo(path, error))
                        ? "; for standard input, give a link to /dev/stdin with this extension"
                        : ""));
}

void check_memory(double bytes, std::string_view what, std::string_view advice) {
  const double there = available_memory();
  if (bytes <= there) return;
  throw OutOfMemory(std::string(what) + " needs " + bytes_text(bytes) + " of memory, but only " + bytes_text(there) +
                    " are free; " + std::string(advice));
}

std::vector<std::string> distinct_names(const std::vector<std::string>& files) {
  std::vector<std::size_t> parts(files.size(), 1);
  std::vector<std::string> names(files.size());
  for (bool is_longer = true; is_longer;) {
    is_longer = false;
    std::map<std::string, std::vector<std::size_t>> of_name;
    for (std::size_t k = 0; k < files.size(); ++k) {
      names[k] = tail_of(files[k], parts[k]);
      of_name[names[k]].push_back(k);
    }
    for (const auto& same : of_name) {
      const auto is_other = [&](std::size_t k) { return files[k] != files[same.second.front()]; };
      if (std::none_of(same.second.begin(), same.second.end(), is_other)) continue;
      for (const std::size_t k : same.second) {
        if (names[k] == fs::path(files[k]).string()) continue;  // the name is already the whole path
        ++parts[k];
        is_longer = true;
      }
    }
  }
  return names;
}

}  // namespace blum::cli
