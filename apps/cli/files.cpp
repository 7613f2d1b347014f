#include "files.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <fstream>
#include <limits>
#include <random>
#include <sstream>
#include <system_error>

#include "blum/core/error.hpp"
#include "blum/io/image_io.hpp"
#include "options.hpp"
#include "summary.hpp"

namespace blum::cli {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t head_size = 8192;

std::string read_head(const fs::path& path) {
  std::error_code ignored;
  if (fs::is_directory(path, ignored)) throw FileError("'" + path.string() + "' is a folder, not a file");
  errno = 0;
  std::ifstream file(path, std::ios::binary);
  if (!file) throw FileError("'" + path.string() + "' cannot be opened: " + std::strerror(errno));
  std::string head(head_size, '\0');
  file.read(head.data(), static_cast<std::streamsize>(head.size()));
  head.resize(static_cast<std::size_t>(std::max<std::streamsize>(file.gcount(), 0)));
  return head;
}

/// The last bytes of a file: of a zip archive, where it tells what is in it.
std::string read_tail(const fs::path& path) {
  std::ifstream file(path, std::ios::binary | std::ios::ate);
  const std::streamoff size = file ? static_cast<std::streamoff>(file.tellg()) : 0;
  std::string tail(std::min(head_size, static_cast<std::size_t>(std::max<std::streamoff>(size, 0))), '\0');
  file.seekg(size - static_cast<std::streamoff>(tail.size()));
  file.read(tail.data(), static_cast<std::streamsize>(tail.size()));
  return tail;
}

std::vector<std::byte> read_all(const fs::path& path) {
  std::ifstream file(path, std::ios::binary | std::ios::ate);
  const std::streamoff size = file ? static_cast<std::streamoff>(file.tellg()) : -1;
  if (size < 0) throw FileError("'" + path.string() + "' cannot be read");
  std::vector<std::byte> bytes(static_cast<std::size_t>(size));
  file.seekg(0);
  file.read(reinterpret_cast<char*>(bytes.data()), size);
  if (!file && size > 0) throw FileError("'" + path.string() + "' cannot be read");
  return bytes;
}

std::optional<ImageFormat> image_format(const fs::path& path) {
  const std::string end = extension(path);
  if (end == ".nrrd" || end == ".nhdr") return ImageFormat::nrrd;
  if (end == ".nii" || end == ".nii.gz" || end == ".hdr" || end == ".hdr.gz" || end == ".img" || end == ".img.gz") {
    return ImageFormat::nifti;
  }
  if (end == ".npy") return ImageFormat::npy;
  if (end == ".vol") return ImageFormat::vol;
  return std::nullopt;
}

bool starts_with(std::string_view text, std::string_view start) {
  return text.substr(0, start.size()) == start;
}

std::optional<MeshFormat> mesh_format_of_bytes(std::string_view head) {
  if (starts_with(head, "ply\n") || starts_with(head, "ply\r")) return MeshFormat::ply;
  if (starts_with(head, "OFF") || starts_with(head, "COFF") || starts_with(head, "NOFF")) return MeshFormat::off;
  if (starts_with(head, "solid ") && head.find("facet") != std::string_view::npos) return MeshFormat::stl;
  if (starts_with(head, "v ") || head.find("\nv ") != std::string_view::npos) return MeshFormat::obj;
  return std::nullopt;
}

std::optional<ImageFormat> image_format_of_bytes(std::string_view head) {
  if (starts_with(head, "NRRD000")) return ImageFormat::nrrd;
  if (starts_with(head, "\x93NUMPY")) return ImageFormat::npy;
  if (head.size() >= 348 && (head.substr(344, 3) == "n+1" || head.substr(4, 3) == "n+2")) return ImageFormat::nifti;
  if (starts_with(head, "X: ") || starts_with(head, "Center-X:")) return ImageFormat::vol;
  return std::nullopt;
}

bool is_field_header(std::string_view head) {
  const std::string_view header = head.substr(0, head.find("\n\n"));
  return header.find("sign_rule:=") != std::string_view::npos;
}

/// Whether a NRRD header says that the values are floating-point numbers.
bool holds_floats(std::string_view head) {
  std::istringstream lines{std::string(head.substr(0, head.find("\n\n")))};
  for (std::string line; std::getline(lines, line);) {
    if (!starts_with(line, "type:")) continue;
    std::istringstream rest(line.substr(5));
    std::string type;
    rest >> type;
    return type == "float" || type == "double";
  }
  return false;
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
  if (fs::is_directory(path, error)) throw FileError("'" + path.string() + "' is a folder; name a file");
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

/// The number behind `key` in a file of lines such as "MemAvailable:  123 kB", or in a file that holds one number.
std::optional<double> number_in(const char* file, std::string_view key) {
  std::ifstream stream(file);
  std::string line;
  while (std::getline(stream, line)) {
    if (!starts_with(line, key)) continue;
    std::istringstream rest(line.substr(key.size()));
    double value = 0;
    if (rest >> value) return value;
  }
  return std::nullopt;
}

/// Bytes that this process may still take, as far as the system says.
double available_memory() {
  double bytes = std::numeric_limits<double>::infinity();
  if (const auto kib = number_in("/proc/meminfo", "MemAvailable:")) {
    bytes = (*kib + number_in("/proc/meminfo", "SwapFree:").value_or(0)) * 1024;
  }
  const auto limit = number_in("/sys/fs/cgroup/memory.max", "");
  return limit ? std::min(bytes, *limit) : bytes;
}

}  // namespace

std::string extension(const fs::path& path) {
  const auto lower = [](std::string text) {
    std::transform(text.begin(), text.end(), text.begin(),
                   [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; });
    return text;
  };
  std::string last = lower(path.extension().string());
  if (last != ".gz") return last;
  const std::string inner = lower(path.stem().extension().string());
  return inner == ".nii" || inner == ".hdr" || inner == ".img" ? inner + last : last;
}

InputKind input_kind(const fs::path& path) {
  const std::string head = read_head(path);
  const std::string end = extension(path);
  if (end == ".npz" || end == ".vti") return InputKind::field;
  if (end == ".vtp" || end == ".ma") {
    throw FileError("'" + path.string() +
                    "' is a medial axis; a mesh, an image or a field is needed here (`blum info`, `blum verify` and "
                    "`blum reconstruct` take axes)");
  }
  if (mesh_format(path)) return InputKind::mesh;
  if (image_format(path) == ImageFormat::nrrd || image_format_of_bytes(head) == ImageFormat::nrrd) {
    return is_field_header(head) ? InputKind::field : InputKind::image;
  }
  if (image_format(path) || image_format_of_bytes(head)) return InputKind::image;
  if (mesh_format_of_bytes(head)) return InputKind::mesh;
  throw FileError("'" + path.string() +
                  "' is of no known kind; meshes are .obj, .off, .stl and .ply files, images .nrrd, .nhdr, .nii, "
                  ".nii.gz, .npy and .vol");
}

bool is_axis(const fs::path& path) {
  const std::string head = read_head(path);
  const std::string end = extension(path);
  if (end == ".vtp" || end == ".ma") return true;
  if (end == ".npz") {
    const std::string tail = read_tail(path);
    return tail.find("vertices.npy") != std::string::npos && tail.find("distance.npy") == std::string::npos;
  }
  const std::string_view header = std::string_view(head).substr(0, head.find("end_header"));
  return end == ".ply" && header.find(R"(comment blum {"content": "medial axis"})") != std::string_view::npos;
}

void check_may_be_field(const fs::path& path) {
  const InputKind kind = input_kind(path);
  if (kind == InputKind::field) return;
  const bool distances_of_others = extension(path) == ".nrrd" && holds_floats(read_head(path));
  if (kind == InputKind::image && distances_of_others) return;
  throw FileError("'" + path.string() + "' is " + (kind == InputKind::mesh ? "a mesh" : "an image") +
                  ", not a field; make its field first, with `blum field`");
}

MeshFile load_mesh(const fs::path& path, const MeshReadOptions& options) {
  if (mesh_format(path)) return read_mesh_file(path, options);
  const std::optional<MeshFormat> format = mesh_format_of_bytes(read_head(path));
  if (!format) return read_mesh_file(path, options);  // for its message
  return read_mesh_file(read_all(path), *format, options, path.string());
}

VoxelImage load_image(const fs::path& path) {
  if (image_format(path)) return read_image(path);
  const std::optional<ImageFormat> format = image_format_of_bytes(read_head(path));
  if (!format) return read_image(path);
  return read_image(read_all(path), *format, path.string());
}

std::string image_format_name(const fs::path& path) {
  std::optional<ImageFormat> format = image_format(path);
  if (!format) format = image_format_of_bytes(read_head(path));
  if (!format) return "unknown";
  switch (*format) {
    case ImageFormat::nrrd:
      return "NRRD";
    case ImageFormat::nifti:
      return "NIfTI";
    case ImageFormat::npy:
      return "NPY";
    case ImageFormat::vol:
      return "Vol";
  }
  return "unknown";
}

std::vector<fs::path> field_files(const fs::path& path) {
  if (extension(path) != ".nrrd") return {path};
  fs::path sites = path;
  sites.replace_extension();
  sites += ".site";
  sites += path.extension();
  return {path, sites};
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
        throw UsageError("the output '" + outputs[i].string() + "' is the input; choose another name");
      }
    }
    for (std::size_t j = 0; j < i; ++j) {
      if (resolved(outputs[i]) == resolved(outputs[j])) {
        throw UsageError("two outputs would go to '" + outputs[i].string() + "'; choose different names");
      }
    }
  }
  for (const fs::path& output : outputs) check_writable(output);
}

fs::path make_draft(const fs::path& path) {
  constexpr int most_attempts = 100;
  constexpr std::size_t most_of_name = 100;
  const fs::path target = resolved(path);
  std::random_device random;
  for (int attempt = 0; attempt < most_attempts; ++attempt) {
    std::ostringstream name;
    name << "." << target.stem().string().substr(0, most_of_name) << "." << std::hex << random() << random() << ".draft"
         << target.extension().string();
    fs::path draft = target.parent_path() / name.str();
    const int file = open(draft.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
    if (file >= 0) {
      close(file);
      return draft;
    }
    if (errno != EEXIST) break;
  }
  throw FileError("'" + path.string() + "' cannot be written: " + std::strerror(errno));
}

void replace_by_draft(const fs::path& path, const fs::path& draft) {
  const fs::path target = resolved(path);
  std::error_code error;
  const fs::file_status old = fs::status(target, error);
  if (fs::is_regular_file(old)) fs::permissions(draft, old.permissions(), error);
  fs::rename(draft, target, error);
  if (error) throw FileError("'" + path.string() + "': " + error.message());
}

void check_extension(std::string_view option, const fs::path& path, const std::vector<std::string>& known) {
  if (path.empty()) throw UsageError(std::string(option) + " needs a file name");
  if (std::find(known.begin(), known.end(), extension(path)) != known.end()) return;
  throw UsageError(std::string(option) + " '" + path.string() + "': the extension must be " + join_words(known, "or"));
}

void check_memory(double bytes, std::string_view what, std::string_view advice) {
  const double there = available_memory();
  if (bytes <= there) return;
  throw OutOfMemory(std::string(what) + " needs " + bytes_text(bytes) + " of memory, and " + bytes_text(there) +
                    " are free; " + std::string(advice));
}

}  // namespace blum::cli
