#include <algorithm>
#include <array>
#include <bit>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "blum/core/error.hpp"
#include "io/field_files.hpp"
#include "io/field_metadata.hpp"
#include "io/image_geometry.hpp"
#include "io/text_scan.hpp"

namespace blum::volume_io {
namespace {

constexpr std::uint64_t largest_header = std::uint64_t{16} << 20U;

/// An opening tag of XML and the text behind it, up to the next tag.
struct Tag {
  std::string_view name;
  std::vector<std::pair<std::string_view, std::string_view>> attributes;
  std::string_view text;
  std::size_t end = 0;  ///< behind the tag's '>'
};

/// The opening tags of a text, one after the other. Knows no entities: nothing that is read here has any.
class TagScanner {
 public:
  TagScanner(std::string_view text, const std::string& name) : text_(text), name_(name) {}

  std::optional<Tag> next() {
    while ((at_ = text_.find('<', at_)) != std::string_view::npos) {
      if (text_.substr(at_).starts_with("<!--")) {
        at_ = std::min(text_.find("-->", at_), text_.size());
        continue;
      }
      ++at_;
      if (at_ < text_.size() && std::string_view("/?!").find(text_[at_]) == std::string_view::npos) return tag();
    }
    return std::nullopt;
  }

 private:
  [[noreturn]] void fail() const {
    throw FormatError(name_ + ": the XML is damaged at byte " + std::to_string(std::min(at_, text_.size())));
  }
  std::string_view until(std::string_view stops) {
    const std::size_t end = text_.find_first_of(stops, at_);
    if (end == std::string_view::npos) fail();
    const std::string_view out = text_.substr(at_, end - at_);
    at_ = end;
    return out;
  }
  void skip_space() { at_ = std::min(text_.find_first_not_of(white_space, at_), text_.size()); }

  Tag tag() {
    Tag tag;
    tag.name = until(" \t\r\n/>");
    for (skip_space(); at_ < text_.size() && text_[at_] != '>' && text_[at_] != '/'; skip_space()) {
      const std::string_view key = trim(until("=>"));
      if (text_[at_++] != '=') fail();
      skip_space();
      const std::string_view quote = text_.substr(at_, 1);
      if (quote != "\"" && quote != "'") fail();
      ++at_;
      tag.attributes.emplace_back(key, until(quote));
      ++at_;
    }
    until(">");
    tag.end = ++at_;
    tag.text = text_.substr(at_, text_.find('<', at_) - at_);
    return tag;
  }

  std::string_view text_;
  const std::string& name_;
  std::size_t at_ = 0;
};

struct ArrayPlace {
  ScalarType type = ScalarType::f32;
  std::uint64_t offset = 0;
};

struct VtiHeader {
  GridSpec grid;
  std::endian order = std::endian::little;
  std::size_t length_size = 4;  ///< bytes of the number before each array
  std::optional<ArrayPlace> distance;
  std::optional<ArrayPlace> site;
  std::string metadata;
  std::uint64_t data_start = 0;
};

class VtiParser {
 public:
  VtiParser(std::string_view text, const std::string& name) : tags_(text, name), text_(text), name_(name) {}

  VtiHeader parse() {
    while (const auto tag = tags_.next()) {
      if (tag->name == "VTKFile") read_file(*tag);
      if (tag->name == "ImageData") read_image(*tag);
      if (tag->name == "Piece") read_piece(*tag);
      if (tag->name == "FieldData" || tag->name == "PointData" || tag->name == "CellData") section_ = tag->name;
      if (tag->name == "DataArray" || tag->name == "Array") read_array(*tag);
      if (tag->name == "AppendedData") {
        read_appended(*tag);
        return std::move(header_);
      }
    }
    fail("it has no appended data; save it with raw appended data");
  }

 private:
  [[noreturn]] void fail(const std::string& reason) const { throw FormatError(name_ + ": " + reason); }

  static std::optional<std::string_view> find(const Tag& tag, std::string_view key) {
    for (const auto& [name, value] : tag.attributes) {
      if (name == key) return value;
    }
    return std::nullopt;
  }

  template <class T, std::size_t n>
  std::optional<std::array<T, n>> numbers(const Tag& tag, std::string_view key) const {
    const auto text = find(tag, key);
    if (!text) return std::nullopt;
    const auto words = split_words(*text);
    std::array<T, n> out{};
    for (std::size_t i = 0; i < n; ++i) {
      const auto value = i < words.size() ? parse_number<T>(words[i]) : std::nullopt;
      if (!value || words.size() != n) fail(std::string(key) + " must be " + std::to_string(n) + " numbers");
      out[i] = *value;
    }
    return out;
  }

  void read_file(const Tag& tag) {
    seen_file_ = true;
    if (find(tag, "type") != "ImageData") fail("it is a VTK file of another type than ImageData");
    if (find(tag, "compressor")) fail("its data are compressed; save it without compression");
    header_.order = find(tag, "byte_order") == "BigEndian" ? std::endian::big : std::endian::little;
    header_.length_size = find(tag, "header_type") == "UInt64" ? 8 : 4;
  }

  void read_image(const Tag& tag) {
    const auto extent = numbers<std::int64_t, 6>(tag, "WholeExtent");
    if (!seen_file_ || !extent) fail("it has no WholeExtent in a VTKFile");
    extent_ = *extent;
    Vec3d start{};
    for (std::size_t a = 0; a < 3; ++a) {
      const std::int64_t low = extent_[2 * a];
      const std::int64_t high = extent_[2 * a + 1];
      constexpr std::int64_t limit = std::int64_t{1} << 40U;
      if (low < -limit || high > limit || high < low) fail("the extent is empty or too large");
      header_.grid.size[a] = high - low + 1;
      start[a] = static_cast<double>(low);
    }
    check_count(header_.grid.size, max_field_nodes, name_);
    const auto origin = numbers<double, 3>(tag, "Origin").value_or(std::array<double, 3>{0, 0, 0});
    const auto spacing = numbers<double, 3>(tag, "Spacing").value_or(std::array<double, 3>{1, 1, 1});
    const auto d = numbers<double, 9>(tag, "Direction").value_or(std::array<double, 9>{1, 0, 0, 0, 1, 0, 0, 0, 1});
    GridSpec& grid = header_.grid;
    set_frame(grid, {Vec3d{d[0], d[3], d[6]}, Vec3d{d[1], d[4], d[7]}, Vec3d{d[2], d[5], d[8]}},
              {spacing[0], spacing[1], spacing[2]}, name_);
    // The origin of VTK is the place of index 0, also where the extent begins elsewhere.
    const Vec3d offset{start.x * grid.spacing.x, start.y * grid.spacing.y, start.z * grid.spacing.z};
    grid.origin = Vec3d{origin[0], origin[1], origin[2]};
    if (start != Vec3d{}) grid.origin += grid.direction * offset;
    if (!is_finite(grid.origin)) fail("the origin is not finite");
  }

  void read_piece(const Tag& tag) const {
    if (numbers<std::int64_t, 6>(tag, "Extent") != extent_) fail("it is cut into several pieces; save it as one");
  }

  void read_array(const Tag& tag) {
    const std::string_view name = find(tag, "Name").value_or("");
    if (section_ == "FieldData" && name == "metadata" && find(tag, "type") == "String" &&
        find(tag, "format") == "ascii") {
      read_metadata(tag.text);
    }
    if (section_ != "PointData" || (name != "distance" && name != "site")) return;
    if (find(tag, "format") != "appended") fail("its arrays are not appended; save it with raw appended data");
    if (find(tag, "NumberOfComponents").value_or("1") != "1") {
      fail("'" + std::string(name) + "' has several components at each point");
    }
    const auto offset = parse_number<std::uint64_t>(find(tag, "offset").value_or(""));
    if (!offset) fail("the offset of '" + std::string(name) + "' is not a number");
    (name == "site" ? header_.site : header_.distance) = ArrayPlace{type(find(tag, "type").value_or("")), *offset};
  }

  ScalarType type(std::string_view text) const {
    constexpr std::array<std::string_view, 10> names{"UInt8", "Int8",   "UInt16", "Int16",   "UInt32",
                                                     "Int32", "UInt64", "Int64",  "Float32", "Float64"};
    const auto found = std::find(names.begin(), names.end(), text);
    if (found == names.end()) fail("an array has the unknown type '" + std::string(text) + "'");
    return static_cast<ScalarType>(found - names.begin());
  }

  /// A string as the numbers of its bytes, with a zero at the end.
  void read_metadata(std::string_view text) {
    for (const std::string_view word : split_words(text)) {
      const auto byte = parse_number<unsigned>(word);
      if (!byte || *byte > 255) fail("the metadata are not a string of VTK");
      if (*byte == 0) return;
      header_.metadata += static_cast<char>(static_cast<unsigned char>(*byte));
    }
  }

  void read_appended(const Tag& tag) {
    if (!seen_file_ || header_.grid.node_count() == 0) fail("it has no ImageData");
    if (!header_.distance) fail("it has no point data 'distance'");
    if (find(tag, "encoding") != "raw") fail("its appended data are not raw; save it with raw appended data");
    const std::size_t mark = text_.find_first_not_of(white_space, tag.end);
    if (mark == std::string_view::npos || text_[mark] != '_') fail("the appended data do not begin with '_'");
    header_.data_start = mark + 1;
  }

  TagScanner tags_;
  std::string_view text_;
  const std::string& name_;
  VtiHeader header_;
  std::array<std::int64_t, 6> extent_{};
  std::string_view section_;
  bool seen_file_ = false;
};

/// The file up to and with the start of the appended data; all of it, where there are none.
std::string read_header_text(const ByteSource& source) {
  std::string text;
  for (std::uint64_t size = 65536;; size *= 4) {
    const std::uint64_t have = std::min({size, source.size(), largest_header});
    text.resize(static_cast<std::size_t>(have));
    source.read(0, std::as_writable_bytes(std::span(text)));
    const std::size_t tag = text.find("<AppendedData");
    const std::size_t end = tag == std::string::npos ? tag : text.find('_', text.find('>', tag));
    if (end != std::string::npos) {
      text.resize(end + 1);
      return text;
    }
    if (have == source.size()) return text;
    if (have == largest_header) throw FormatError(source.name() + ": it is not a VTK image with appended data");
  }
}

/// The values of one array, past its length, which must be that of `count` values.
PlainStream open_array(const ByteSource& source, const VtiHeader& header, const ArrayPlace& place,
                       std::uint64_t count) {
  const std::uint64_t room = source.size() - header.data_start;
  if (place.offset > room || room - place.offset < header.length_size) {
    throw FormatError(source.name() + ": an array begins beyond the end of the file; it is cut short");
  }
  std::array<std::byte, 8> bytes{};
  const std::uint64_t at = header.data_start + place.offset;
  source.read(at, std::span(bytes).first(header.length_size));
  if (header.order == std::endian::big) std::reverse(bytes.begin(), bytes.begin() + std::ptrdiff_t(header.length_size));
  std::uint64_t length = 0;
  for (std::size_t i = 8; i-- > 0;) length = length << 8U | std::to_integer<std::uint64_t>(bytes[i]);
  if (length != count * scalar_size(place.type)) {
    throw FormatError(source.name() + ": an array has " + std::to_string(length) + " bytes, but the extent needs " +
                      std::to_string(count * scalar_size(place.type)));
  }
  return {source, at + header.length_size, source.size()};
}

}  // namespace

Field read_field_vti(const ByteSource& source) {
  const std::string text = read_header_text(source);
  const VtiHeader header = VtiParser(text, source.name()).parse();
  const std::uint64_t count = header.grid.node_count();
  const auto reader = [&](PlainStream& stream, const ArrayPlace& place) {
    stream.check_left(count * scalar_size(place.type), "the array");
    return [&](std::span<std::byte> out) {
      stream.read(out, "the array");
      to_native(out, place.type, header.order);
    };
  };
  Field field;
  field.grid = header.grid;
  PlainStream distances = open_array(source, header, *header.distance, count);
  field.distance = read_distances(header.distance->type, count, reader(distances, *header.distance));
  if (header.site) {
    PlainStream sites = open_array(source, header, *header.site, count);
    field.site = read_sites(header.site->type, count, reader(sites, *header.site), source.name());
  }
  if (!header.metadata.empty()) {
    apply_metadata(from_json(header.metadata, source.name()), source.name(), field);
  }
  return field;
}

}  // namespace blum::volume_io
