#include "view/pairs_file.hpp"

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <fstream>
#include <iterator>
#include <limits>
#include <nlohmann/json.hpp>
#include <system_error>
#include <utility>

#include "blum/core/error.hpp"
#include "blum/core/exact_text.hpp"
#include "common/files.hpp"
#include "common/options.hpp"

namespace blum::cli {
namespace {

using Read = nlohmann::ordered_json;

constexpr double farthest = 1e30;  // largest magnitude of a coordinate that browsers can draw

std::string text_of(const std::filesystem::path& path) {
  std::error_code error;
  const auto size = std::filesystem::is_directory(path, error) ? 0 : std::filesystem::file_size(path, error);
  std::ifstream file(path, std::ios::binary);
  if (error || !file || std::filesystem::is_directory(path, error)) {
    throw FileError("cannot read '" + path.string() + "': not found, not a regular file, or not readable");
  }
  constexpr double bytes_per_character = 6;  // estimate of the memory for parsed numbers and names
  check_memory(bytes_per_character * static_cast<double>(size), "reading '" + path.string() + "'",
               "give a file with fewer frames");
  std::string text(std::istreambuf_iterator<char>(file), {});
  if (file.bad()) throw FileError("cannot read '" + path.string() + "' completely");
  return text;
}

/// Value in the file, with its path for messages: "frames[3].pairs[2].kind".
class Value {
 public:
  Value(const Read& json, const std::string& file, std::string place)
      : json_(json), file_(file), place_(std::move(place)) {}

  [[noreturn]] void fail(const std::string& what) const {
    throw FormatError("'" + file_ + "': " + (place_.empty() ? "the file" : place_) + " " + what);
  }
  void check_object() const {
    if (!json_.is_object()) fail("must be an object");
  }
  /// Returns the member with this name; nullptr if the object has none.
  [[nodiscard]] const Read* find(const char* name) const {
    const auto found = json_.find(name);
    return found == json_.end() ? nullptr : &*found;
  }
  [[nodiscard]] Value of(const Read& member, const std::string& name) const {
    return {member, file_, place_.empty() ? name : place_ + "." + name};
  }
  [[nodiscard]] Value member(const char* name) const {
    const Read* found = find(name);
    if (found == nullptr) fail("has no \"" + std::string(name) + "\"");
    return of(*found, name);
  }
  [[nodiscard]] std::size_t array_size() const {
    if (!json_.is_array()) fail("must be an array");
    return json_.size();
  }
  [[nodiscard]] Value operator[](std::size_t i) const {
    return {json_[i], file_, place_ + "[" + std::to_string(i) + "]"};
  }
  [[nodiscard]] double number() const {
    if (!json_.is_number()) fail("must be a number");
    const auto value = json_.get<double>();
    if (!std::isfinite(value)) fail("must be finite");
    return value;
  }
  [[nodiscard]] const Read& json() const { return json_; }

 private:
  const Read& json_;
  const std::string& file_;
  std::string place_;
};

std::uint8_t kind_of(const Value& value) {
  if (!value.json().is_string()) value.fail("must be a string");
  const auto& name = value.json().get_ref<const std::string&>();
  const auto* const found = std::find(pair_kinds.begin(), pair_kinds.end(), name);
  if (found == pair_kinds.end()) {
    value.fail("is '" + name + "', but must be " + join_words({pair_kinds.begin(), pair_kinds.end()}, "or"));
  }
  return static_cast<std::uint8_t>(found - pair_kinds.begin());
}

Vec3d point_of(const Value& value) {
  if (value.array_size() != 3) value.fail("must be three numbers");
  Vec3d point;
  for (std::size_t a = 0; a < 3; ++a) {
    point[a] = value[a].number();
    if (std::abs(point[a]) > farthest) value[a].fail("is beyond 1e30, which browsers cannot draw");
  }
  return point;
}

float time_of(const Value& pair) {
  const Read* found = pair.find("time");
  if (found == nullptr) return std::numeric_limits<float>::quiet_NaN();
  const Value value = pair.of(*found, "time");
  const double time = value.number();
  if (time < 0 || time > 1) value.fail("is " + rounded_text(time) + ", but must be from 0 to 1");
  return static_cast<float>(time);
}

void add_pair(const Value& pair, FramePairs& out) {
  pair.check_object();
  out.kinds.push_back(kind_of(pair.member("kind")));
  const Value points = pair.member("points");
  if (points.array_size() != 2) points.fail("must be two points");
  for (std::size_t k = 0; k < 2; ++k) out.points.push_back(point_of(points[k]));
  out.distances.push_back(pair.member("distance").number());
  out.times.push_back(time_of(pair));
}

void add_pairs(const Value& frame, FramePairs& out) {
  const Read* found = frame.find("pairs");
  if (found == nullptr) return;
  const Value pairs = frame.of(*found, "pairs");
  const std::size_t count = pairs.array_size();
  if (out.kinds.size() + count > most_pairs) {
    pairs.fail("raises the number of pairs above " + count_text(most_pairs) + ", the largest number that is shown");
  }
  for (std::size_t i = 0; i < count; ++i) add_pair(pairs[i], out);
}

using StageSeconds = std::vector<std::pair<std::size_t, double>>;  ///< (index of a stage, its seconds)

StageSeconds stages_of(const Value& frame, std::vector<std::string>& names) {
  StageSeconds out;
  const Read* found = frame.find("stages");
  if (found == nullptr) return out;
  const Value stages = frame.of(*found, "stages");
  stages.check_object();
  for (const auto& [name, json] : found->items()) {
    const Value value = stages.of(json, name);
    const double seconds = value.number();
    if (seconds < 0) value.fail("is " + rounded_text(seconds) + ", but seconds must not be negative");
    const auto at = static_cast<std::size_t>(std::find(names.begin(), names.end(), name) - names.begin());
    if (at == names.size()) {
      if (name.empty()) stages.fail("contains a stage with the name \"\"");
      if (at == most_stages) {
        value.fail("is one stage too many: at most " + std::to_string(most_stages) + " are shown");
      }
      names.push_back(name);
    }
    out.emplace_back(at, seconds);
  }
  return out;
}

Read parsed(const std::filesystem::path& path) {
  try {
    return Read::parse(text_of(path));
  } catch (const Read::parse_error& error) {
    // Drops the library's prefix from messages like "[json.exception.parse_error.101] parse error at line 1, ..."
    const std::string text = error.what();
    const std::size_t mark = text.find("] ");
    throw FormatError("'" + path.string() + "' is not JSON: " + text.substr(mark == std::string::npos ? 0 : mark + 2));
  } catch (const Read::exception& error) {  // thrown for numbers beyond the range of double
    throw FormatError("'" + path.string() + "' cannot be read: " + error.what());
  }
}

}  // namespace

FramePairs read_frame_pairs(const std::filesystem::path& path, std::size_t frames) {
  const Read json = parsed(path);
  const std::string name = path.string();
  const Value file(json, name, "");
  file.check_object();
  const Value list = file.member("frames");
  if (const std::size_t count = list.array_size(); count != frames) {
    list.fail("has " + count_text(count) + (count == 1 ? " entry" : " entries") + ", but there are " +
              count_text(frames) + " meshes; each mesh needs one entry");
  }
  FramePairs out;
  std::vector<StageSeconds> seconds;
  for (std::size_t f = 0; f < frames; ++f) {
    const Value frame = list[f];
    frame.check_object();
    out.first.push_back(static_cast<std::uint32_t>(out.kinds.size()));
    add_pairs(frame, out);
    seconds.push_back(stages_of(frame, out.stages));
  }
  out.first.push_back(static_cast<std::uint32_t>(out.kinds.size()));
  if (out.kinds.empty() && out.stages.empty()) list.fail("has no pairs and no stages in any frame");
  out.seconds.assign(frames * out.stages.size(), std::numeric_limits<double>::quiet_NaN());
  for (std::size_t f = 0; f < frames; ++f) {
    for (const auto& [stage, value] : seconds[f]) out.seconds[f * out.stages.size() + stage] = value;
  }
  return out;
}

}  // namespace blum::cli
