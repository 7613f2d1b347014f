#include <zlib.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstddef>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>
#include <system_error>
#include <utility>
#include <variant>

#include "blum/core/error.hpp"
#include "blum/core/exact_text.hpp"
#include "blum/io/atomic_file.hpp"
#include "blum/io/path_io.hpp"
#include "io/bytes/byte_source.hpp"
#include "io/format_table.hpp"
#include "io/text/json.hpp"

namespace blum {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

constexpr std::string_view format_name = "blum-path";
constexpr int format_version = 1;

// Writing. Numbers have as many digits as are needed to read the same doubles again.

template <class Range, class Text>
std::string list_of(const Range& items, const Text& text, std::string_view separator = ", ") {
  std::string out = "[";
  for (const auto& item : items) {
    if (out.size() > 1) out += separator;
    out += text(item);
  }
  return out + "]";
}

std::string text_of(const PathMesh& mesh) {
  return "{\"file\": " + volume_io::json_text(mesh.file) + ", \"bytes\": " + std::to_string(mesh.bytes) +
         ", \"crc32\": " + volume_io::json_text(mesh.crc32) + "}";
}

std::string text_of(const PathFile& file) {
  const auto number = [](double value) { return exact_text(value); };
  const auto mesh = [](const PathMesh& one) { return text_of(one); };
  const auto pose = [&](const PoseNumbers& one) { return list_of(one, number); };
  std::string out =
      "{\"format\": \"" + std::string(format_name) + "\", \"version\": " + std::to_string(format_version) +
      ",\n\"bodies\": " + list_of(file.bodies, mesh, ",\n  ") +
      ",\n\"obstacles\": " + list_of(file.obstacles, mesh, ",\n  ") + ",\n\"centres\": " +
      list_of(file.centres, [&](const Vec3d& c) { return list_of(std::array{c.x, c.y, c.z}, number); }) +
      ",\n\"poses\": " + list_of(file.poses, [&](const auto& poses) { return list_of(poses, pose); }, ",\n  ");
  if (file.clearance) out += ",\n\"clearance\": " + exact_text(*file.clearance);
  if (!file.intervals.empty()) {
    const auto interval = [&](const PathInterval& one) {
      return "[" + std::to_string(one.edge) + ", " + exact_text(one.from) + ", " + exact_text(one.to) + ", " +
             exact_text(one.clearance) + "]";
    };
    out += ",\n\"intervals\": " + list_of(file.intervals, interval, ",\n  ");
  }
  return out + "}\n";
}

// Reading.

/// Reader of the members of a JSON file, with errors that contain their place.
class JsonPath {
 public:
  JsonPath(const json& root, std::string name) : root_(root), name_(std::move(name)) {}

  [[noreturn]] void fail(const std::string& reason) const { throw FormatError(name_ + ": " + reason); }

  PathFile read() const {
    if (!root_.is_object() || root_.value("format", json()) != format_name) {
      fail("this is not a path file: it has no member \"format\" with the value \"blum-path\"");
    }
    if (root_.value("version", json()) != format_version) {
      fail("the version of the path file is " + root_.value("version", json()).dump() + ", but must be " +
           std::to_string(format_version));
    }
    PathFile out;
    for (const json& mesh : list(root_, "bodies")) out.bodies.push_back(mesh_of(mesh, "bodies"));
    for (const json& mesh : list(root_, "obstacles")) out.obstacles.push_back(mesh_of(mesh, "obstacles"));
    for (const json& centre : list(root_, "centres")) {
      const auto [x, y, z] = numbers<3>(centre, "centres");
      out.centres.push_back({x, y, z});
    }
    for (const json& waypoint : list(root_, "poses")) {
      if (!waypoint.is_array()) fail("a waypoint in \"poses\" is not a list of poses");
      std::vector<PoseNumbers>& poses = out.poses.emplace_back();
      for (const json& pose : waypoint) poses.push_back(numbers<7>(pose, "poses"));
    }
    if (root_.contains("clearance")) out.clearance = number(root_["clearance"], "clearance");
    if (root_.contains("intervals")) {
      for (const json& interval : list(root_, "intervals")) out.intervals.push_back(interval_of(interval));
    }
    check(out);
    return out;
  }

 private:
  const json& list(const json& from, const char* member) const {
    const auto found = from.find(member);
    if (found == from.end()) fail("the member \"" + std::string(member) + "\" is missing");
    if (!found->is_array()) fail("the member \"" + std::string(member) + "\" is not a list");
    return *found;
  }
  double number(const json& value, const char* member) const {
    if (value.is_number()) return value.get<double>();
    fail("\"" + std::string(member) + "\" contains a value that is not a number: " + shortened(value));
  }
  template <std::size_t count>
  std::array<double, count> numbers(const json& value, const char* member) const {
    if (!value.is_array() || value.size() != count) {
      fail("\"" + std::string(member) + "\" contains " + shortened(value) + ", but needs lists of " +
           std::to_string(count) + " numbers");
    }
    std::array<double, count> out{};
    for (std::size_t k = 0; k < count; ++k) out[k] = number(value[k], member);
    return out;
  }
  static std::string shortened(const json& value) {
    constexpr std::size_t most = 60;
    const std::string text = value.dump(-1, ' ', true, json::error_handler_t::replace);
    return text.size() <= most ? text : text.substr(0, most) + "...";
  }
  PathMesh mesh_of(const json& mesh, const char* member) const {
    const bool is_mesh = mesh.is_object() && mesh.value("file", json()).is_string() &&
                         mesh.value("bytes", json()).is_number_unsigned() && mesh.value("crc32", json()).is_string();
    if (!is_mesh) fail("\"" + std::string(member) + "\" contains a mesh without \"file\", \"bytes\" and \"crc32\"");
    return {mesh["file"].get<std::string>(), mesh["bytes"].get<std::uint64_t>(), mesh["crc32"].get<std::string>()};
  }
  PathInterval interval_of(const json& interval) const {
    const auto [edge, from, to, clearance] = numbers<4>(interval, "intervals");
    if (!(edge >= 0 && edge < 0x1p32 && std::floor(edge) == edge)) {
      fail("\"intervals\" contains the motion " + exact_text(edge) + ", which is not a number of a motion");
    }
    return {.edge = static_cast<std::uint32_t>(edge), .from = from, .to = to, .clearance = clearance};
  }
  void check(const PathFile& file) const {
    if (file.poses.empty()) fail("there are no poses; a path needs at least one waypoint");
    const std::size_t bodies = file.poses.front().size();
    if (bodies == 0) fail("the first waypoint has no pose");
    for (std::size_t k = 0; k < file.poses.size(); ++k) {
      if (file.poses[k].size() == bodies) continue;
      fail("waypoint " + std::to_string(k) + " has " + std::to_string(file.poses[k].size()) +
           " poses, but waypoint 0 has " + std::to_string(bodies));
    }
    if (file.bodies.size() != bodies || file.centres.size() != bodies) {
      fail("there are " + std::to_string(file.bodies.size()) + " bodies and " + std::to_string(file.centres.size()) +
           " centres, but " + std::to_string(bodies) + " poses at each waypoint; their numbers must be equal");
    }
  }

  const json& root_;
  std::string name_;
};

PathFile read_json(std::string_view text, const std::string& name) {
  json root;
  try {
    root = json::parse(text.begin(), text.end());
  } catch (const json::exception& error) {
    throw FormatError(name + ": this is not JSON: " + error.what());
  }
  return JsonPath(root, name).read();
}

/// Returns the numbers of a line, separated by commas; nothing if a field is not a number.
std::optional<std::vector<double>> numbers_of(std::string_view line) {
  std::vector<double> out;
  while (true) {
    const std::size_t comma = std::min(line.find(','), line.size());
    std::string_view field = line.substr(0, comma);
    const auto is_blank = [](char c) { return c == ' ' || c == '\t'; };
    while (!field.empty() && is_blank(field.front())) field.remove_prefix(1);
    while (!field.empty() && is_blank(field.back())) field.remove_suffix(1);
    if (field.starts_with('+')) field.remove_prefix(1);
    double value = 0;
    const auto [end, error] = std::from_chars(field.data(), field.data() + field.size(), value);
    if (error != std::errc() || end != field.data() + field.size()) return std::nullopt;
    out.push_back(value);
    if (comma == line.size()) return out;
    line.remove_prefix(comma + 1);
  }
}

PathFile read_csv(std::string_view text, const std::string& name) {
  PathFile out;
  if (text.starts_with("\xEF\xBB\xBF")) text.remove_prefix(3);
  for (std::size_t row = 1; !text.empty(); ++row) {
    const std::size_t end = std::min(text.find('\n'), text.size());
    std::string_view line = text.substr(0, end);
    text.remove_prefix(std::min(end + 1, text.size()));
    if (line.ends_with('\r')) line.remove_suffix(1);
    if (line.empty() || line.starts_with('#')) continue;
    const auto numbers = numbers_of(line);
    if (!numbers && out.poses.empty() && row == 1) continue;  // names of columns
    if (!numbers || numbers->size() != std::tuple_size_v<PoseNumbers>) {
      throw FormatError(name + ", line " + std::to_string(row) + ": found " +
                        (numbers ? std::to_string(numbers->size()) + " numbers" : std::string("text")) +
                        ", but a row must be x,y,z,qw,qx,qy,qz");
    }
    PoseNumbers pose{};
    std::copy(numbers->begin(), numbers->end(), pose.begin());
    out.poses.push_back({pose});
  }
  if (out.poses.empty()) throw FormatError(name + ": there are no rows x,y,z,qw,qx,qy,qz");
  return out;
}

/// Returns the functions of a format.
const formats::PathCode& code_of(PathFormat format) {
  return *std::get<const formats::PathCode*>(formats::table[format.row()].code);
}

}  // namespace

MotionPath PathFile::path(const std::vector<Vec3d>& default_centres) const {
  MotionPath out{.centres = centres.empty() ? default_centres : centres, .poses = {}};
  for (const std::vector<PoseNumbers>& waypoint : poses) {
    std::vector<RigidTransform>& to = out.poses.emplace_back();
    for (const PoseNumbers& pose : waypoint) to.push_back(pose_of(pose));
  }
  return out;
}

PathMesh describe_path_mesh(const fs::path& mesh, const fs::path& folder) {
  const FileBytes bytes = read_whole_file(mesh);
  const auto sum =
      static_cast<std::uint32_t>(crc32_z(0, reinterpret_cast<const Bytef*>(bytes.span().data()), bytes.span().size()));
  constexpr std::string_view digits = "0123456789abcdef";
  std::string hexadecimal;
  for (int shift = 28; shift >= 0; shift -= 4) hexadecimal += digits[sum >> shift & 0xfU];
  std::error_code error;
  const fs::path relative = fs::relative(mesh, folder.empty() ? fs::path(".") : folder, error);
  return {error || relative.empty() ? mesh.string() : relative.generic_string(), bytes.size, hexadecimal};
}

void write_path(const fs::path& path, const PathFile& file, const Context& context) {
  const PathFormat format = PathFormat::of(path, FileAccess::write);
  throw_if_cancelled(context);
  AtomicFile out(path);
  out.write(code_of(format).text_of(file));
  out.commit();
}

PathFile read_path(const fs::path& path) {
  const PathFormat format = PathFormat::of(path);
  const FileBytes bytes = read_whole_file(path);
  const std::string_view text(reinterpret_cast<const char*>(bytes.span().data()), bytes.size);
  return code_of(format).read(text, "'" + path.string() + "'");
}

PathFile read_path(std::span<const std::byte> bytes, PathFormat format) {
  return code_of(format).read({reinterpret_cast<const char*>(bytes.data()), bytes.size()}, "path");
}

namespace formats {

constinit const PathCode path_json{read_json, text_of};
constinit const PathCode path_csv{read_csv, nullptr};

}  // namespace formats

}  // namespace blum
