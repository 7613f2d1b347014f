#include "io/image/nrrd.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "blum/core/error.hpp"
#include "blum/core/exact_text.hpp"
#include "blum/core/ids.hpp"
#include "io/format_table.hpp"
#include "io/image/image_files.hpp"
#include "io/text/text_cursor.hpp"

namespace blum::volume_io {
namespace {

constexpr std::uint64_t largest_header = std::uint64_t{4} << 20U;
constexpr std::uint64_t most_axes = 16;  ///< the same limit as in Teem

/// NRRD names of a scalar type. The first one is used for writing.
struct TypeNames {
  ScalarType type;
  std::vector<std::string_view> names;
};
const std::vector<TypeNames>& type_names() {
  static const std::vector<TypeNames> all{
      {ScalarType::u8, {"uint8", "unsigned char", "uchar", "uint8_t"}},
      {ScalarType::i8, {"int8", "signed char", "int8_t"}},
      {ScalarType::u16, {"uint16", "ushort", "unsigned short", "unsigned short int", "uint16_t"}},
      {ScalarType::i16, {"int16", "short", "short int", "signed short", "signed short int", "int16_t"}},
      {ScalarType::u32, {"uint32", "uint", "unsigned int", "uint32_t"}},
      {ScalarType::i32, {"int32", "int", "signed int", "int32_t"}},
      {ScalarType::u64, {"uint64", "ulonglong", "unsigned long long", "unsigned long long int", "uint64_t"}},
      {ScalarType::i64,
       {"int64", "longlong", "long long", "long long int", "signed long long", "signed long long int", "int64_t"}},
      {ScalarType::f32, {"float"}},
      {ScalarType::f64, {"double"}}};
  return all;
}

/// Names of spaces with three dimensions: full name and abbreviation. Some have no abbreviation.
constexpr std::array<std::array<std::string_view, 2>, 6> spaces{{{"right-anterior-superior", "ras"},
                                                                 {"left-anterior-superior", "las"},
                                                                 {"left-posterior-superior", "lps"},
                                                                 {"scanner-xyz", ""},
                                                                 {"3D-right-handed", ""},
                                                                 {"3D-left-handed", ""}}};

std::string vector_text(const Vec3d& v) {
  return "(" + exact_text(v.x) + "," + exact_text(v.y) + "," + exact_text(v.z) + ")";
}

std::string escaped(std::string_view text) {
  std::string out;
  for (const char c : text) out += c == '\n' ? std::string("\\n") : c == '\\' ? std::string("\\\\") : std::string(1, c);
  return out;
}

std::string unescaped(std::string_view text) {
  std::string out;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const bool escape = text[i] == '\\' && i + 1 < text.size() && (text[i + 1] == 'n' || text[i + 1] == '\\');
    if (escape) ++i;
    out += escape && text[i] == 'n' ? '\n' : text[i];
  }
  return out;
}

/// Text of the header, without the empty line at its end, and the position of the data.
struct HeaderText {
  std::string text;
  std::uint64_t end = 0;
};

HeaderText read_header_text(const ByteSource& source) {
  HeaderText header;
  for (std::uint64_t size = 4096;; size *= 4) {
    const std::uint64_t have = std::min({size, source.size(), largest_header});
    header.text.resize(static_cast<std::size_t>(have));
    source.read(0, std::as_writable_bytes(std::span(header.text)));
    for (std::size_t line = 0; line < header.text.size();) {
      const std::size_t next = header.text.find('\n', line);
      if (next == std::string::npos) break;
      const bool empty = next == line || (next == line + 1 && header.text[line] == '\r');
      if (empty) {
        header.text.resize(line);
        header.end = next + 1;
        return header;
      }
      line = next + 1;
    }
    if (!header.text.starts_with("NRRD")) return header;  // the caller rejects it
    if (have == source.size()) break;                     // the header of detached data may end with the file
    if (have == largest_header) throw FormatError(source.name() + ": its header does not end");
  }
  header.end = source.size();
  return header;
}

class HeaderParser {
 public:
  explicit HeaderParser(const ByteSource& source) : name_(source.name()) {
    const HeaderText text = read_header_text(source);
    header_.data_start = text.end;
    split(text.text);
  }

  NrrdHeader parse() {
    header_.type = type();
    header_.encoding = encoding();
    header_.order = order();
    read_sizes();
    choose_axes();
    read_frame();
    header_.data_file = data_file();
    read_skips();
    return std::move(header_);
  }

 private:
  using Vectors = std::vector<std::optional<std::vector<double>>>;

  [[noreturn]] void fail(const std::string& reason) const { throw FormatError(name_ + ": " + reason); }

  void split(std::string_view text) {
    int number = 0;
    while (!text.empty()) {
      const std::size_t end = std::min(text.find('\n'), text.size());
      std::string_view line = text.substr(0, end);
      text.remove_prefix(std::min(end + 1, text.size()));
      if (line.ends_with('\r')) line.remove_suffix(1);
      if (++number == 1) {
        check_magic(line);
      } else if (!line.starts_with('#') && !line.empty()) {
        add_line(line, number);
      }
    }
    if (number == 0) check_magic({});
  }

  void check_magic(std::string_view line) const {
    if (!line.starts_with("NRRD")) fail("it does not begin with NRRD, so it is not an NRRD file");
    if (line.size() != 8 || line.substr(4, 3) != "000" || line[7] < '1' || line[7] > '5') {
      fail("'" + std::string(line.substr(0, 16)) + "' is not a known version of NRRD; NRRD0001 to NRRD0005 are");
    }
  }

  void add_line(std::string_view line, int number) {
    const std::size_t colon = line.find(':');
    if (colon == std::string_view::npos) {
      fail("line " + std::to_string(number) + " is neither 'field: value' nor 'key:=value'");
    }
    const std::string_view before = line.substr(0, colon);
    if (colon + 1 < line.size() && line[colon + 1] == '=') {
      header_.key_values.emplace_back(unescaped(before), unescaped(line.substr(colon + 2)));
      return;
    }
    std::string field = lower_case(trim(before));
    field.erase(std::remove(field.begin(), field.end(), ' '), field.end());
    if (!fields_.emplace(field, trim(line.substr(colon + 1))).second) {
      fail("line " + std::to_string(number) + " gives the field '" + std::string(before) + "' again");
    }
  }

  /// Returns the value of a field, or null if there is none. The name must be in lower case without spaces.
  const std::string* find(const std::string& field) const {
    const auto found = fields_.find(field);
    return found == fields_.end() ? nullptr : &found->second;
  }
  const std::string& need(const std::string& field) const {
    const std::string* value = find(field);
    if (value == nullptr) fail("the field '" + field + "' is missing");
    return *value;
  }

  ScalarType type() const {
    const std::string value = lower_case(need("type"));
    for (const TypeNames& t : type_names()) {
      if (std::find(t.names.begin(), t.names.end(), value) != t.names.end()) return t.type;
    }
    fail("values of type '" + value + "' are not read; integers of 8 to 64 bits, float and double are");
  }

  NrrdEncoding encoding() const {
    const std::string value = lower_case(need("encoding"));
    if (value == "raw") return NrrdEncoding::raw;
    if (value == "gzip" || value == "gz") return NrrdEncoding::gzip;
    if (value == "text" || value == "txt" || value == "ascii") return NrrdEncoding::text;
    fail("data encoded as '" + value + "' are not read; raw, gzip and text are");
  }

  std::endian order() const {
    const std::string* value = find("endian");
    if (value == nullptr) {
      if (header_.encoding != NrrdEncoding::text && scalar_size(header_.type) > 1) {
        fail("the field 'endian' is missing, which values of several bytes need");
      }
      return std::endian::native;
    }
    if (lower_case(*value) == "little") return std::endian::little;
    if (lower_case(*value) == "big") return std::endian::big;
    fail("endian is '" + *value + "', but it must be little or big");
  }

  void read_sizes() {
    const auto dimension = parse_number<std::uint64_t>(need("dimension"));
    if (!dimension || *dimension < 1 || *dimension > most_axes) fail("dimension must be 1 to 16");
    axis_count_ = static_cast<std::size_t>(*dimension);
    for (const std::string_view word : split_words(need("sizes"))) {
      const auto size = parse_number<std::int64_t>(word);
      if (!size || *size < 1) fail("'" + std::string(word) + "' in sizes is not a positive whole number");
      sizes_.push_back(*size);
    }
    if (sizes_.size() != axis_count_) fail("'sizes' must hold one number for each axis that 'dimension' counts");
  }

  /// Returns the numbers of a field that has one number per axis. Returns none if the field is missing.
  std::vector<double> numbers(const std::string& field) const {
    std::vector<double> out;
    const std::string* value = find(field);
    if (value == nullptr) return out;
    for (const std::string_view word : split_words(*value)) {
      const auto number = parse_number<double>(word);
      if (!number) fail("'" + std::string(word) + "' in '" + field + "' is not a number");
      out.push_back(*number);
    }
    if (out.size() != axis_count_) fail("'" + field + "' must hold one number for each axis");
    return out;
  }

  /// Parses vectors from text like "(1,0,0) none (0,1,0)".
  Vectors vectors(const std::string& field, std::string_view text) const {
    Vectors out;
    for (text = trim(text); !text.empty(); text = trim(text)) {
      if (text.starts_with("none")) {
        out.emplace_back();
        text.remove_prefix(4);
        continue;
      }
      const std::size_t end = text.find(')');
      if (text.front() != '(' || end == std::string_view::npos) fail("'" + field + "' is not a list of vectors");
      std::vector<double> v;
      for (std::size_t at = 1; at <= end;) {
        const std::size_t comma = std::min(text.find(',', at), end);
        const auto number = parse_number<double>(trim(text.substr(at, comma - at)));
        if (!number) fail("a vector in '" + field + "' is not made of numbers");
        v.push_back(*number);
        at = comma + 1;
      }
      if (v.size() > 3) fail("spaces of more than three dimensions are not read");
      out.emplace_back(std::move(v));
      text.remove_prefix(end + 1);
      if (out.size() > most_axes) fail("'" + field + "' has too many vectors");
    }
    return out;
  }

  static Vec3d to_vec3(const std::vector<double>& v) {
    return {v[0], v.size() > 1 ? v[1] : 0.0, v.size() > 2 ? v[2] : 0.0};
  }

  /// Returns true if an axis, by its kind, enumerates components instead of positions.
  static bool counts_components(std::string_view kind) {
    constexpr std::array<std::string_view, 3> ends{"vector", "color", "matrix"};
    constexpr std::array<std::string_view, 6> names{"complex", "quaternion", "point", "gradient", "normal", "2-vector"};
    return std::any_of(ends.begin(), ends.end(), [&](auto end) { return kind.ends_with(end); }) ||
           std::find(names.begin(), names.end(), kind) != names.end() || kind.find("gradient") != kind.npos;
  }

  void choose_axes() {
    if (const std::string* text = find("spacedirections")) {
      directions_ = vectors("space directions", *text);
      if (directions_.size() != axis_count_) fail("'space directions' must hold one vector, or none, for each axis");
    }
    std::vector<std::string_view> kinds;
    if (const std::string* text = find("kinds")) kinds = split_words(*text);
    kinds.resize(axis_count_);
    for (std::size_t a = 0; a < axis_count_; ++a) {
      const bool no_place = (!directions_.empty() && !directions_[a]) || counts_components(lower_case(kinds[a]));
      if (!no_place) {
        axes_.push_back(a);
      } else if (sizes_[a] != 1) {
        fail("axis " + std::to_string(a) + " has " + std::to_string(sizes_[a]) +
             " entries and no direction in space (a vector, colour or list image): extract one of them first");
      }
    }
    drop_single_layers();
    for (std::size_t i = 0; i < axes_.size(); ++i) header_.grid.size[i] = sizes_[axes_[i]];
    for (std::size_t i = axes_.size(); i < 3; ++i) header_.grid.size[i] = 1;
    check_count(header_.grid.size, max_field_nodes, name_);
  }

  /// Removes axes with one entry, starting with the last axis, until at most three axes are left.
  void drop_single_layers() {
    for (std::size_t i = axes_.size(); i-- > 0 && axes_.size() > 3;) {
      if (sizes_[axes_[i]] == 1) axes_.erase(axes_.begin() + static_cast<std::ptrdiff_t>(i));
    }
    if (axes_.size() > 3) {
      fail("it has " + std::to_string(axes_.size()) + " axes of more than one entry; an image has at most three");
    }
  }

  void read_frame() {
    std::array<std::optional<Vec3d>, 3> steps;
    if (!directions_.empty()) {
      for (std::size_t i = 0; i < axes_.size(); ++i) steps[i] = to_vec3(*directions_[axes_[i]]);
      set_frame(header_.grid, steps, name_ + ": 'space directions'");
      if (const std::string* text = find("space")) header_.space = nrrd_space(*text);
    } else {
      read_spacings(header_.grid);
    }
    if (const std::string* text = find("spaceorigin")) {
      const Vectors origin = vectors("space origin", *text);
      if (origin.size() != 1) fail("'space origin' must be one vector");
      if (origin[0]) header_.grid.origin = to_vec3(*origin[0]);
      // NaN coordinates mean that the origin is unknown.
      const Vec3d& o = header_.grid.origin;
      if (origin[0] && std::all_of(origin[0]->begin(), origin[0]->end(), [](double v) { return std::isnan(v); })) {
        header_.grid.origin = {};
      } else if (!is_finite(o)) {
        fail("the space origin is not finite");
      }
    }
    if (!directions_.empty()) compare_spacings();
  }

  /// Warns if the axes' own spacings and positions disagree with the space directions and origin. Fields of axes that
  /// are missing or unknown agree with everything.
  void compare_spacings() {
    const bool has_steps = find("spacings") != nullptr;
    const bool has_starts = find("axismins") != nullptr && find("spaceorigin") != nullptr;
    if (!has_steps && !has_starts) return;
    std::vector<double> spacings;
    std::vector<double> mins;
    GridSpec other = header_.grid;
    try {
      spacings = numbers("spacings");
      mins = numbers("axismins");
      read_spacings(other);
    } catch (const FormatError&) {
      return;  // they are not needed, and may be filled with anything
    }
    for (std::size_t i = 0; i < axes_.size(); ++i) {
      const std::size_t a = axes_[i];
      const double step = header_.grid.spacing[i];
      const double start = dot(header_.grid.origin, header_.grid.direction.columns[i]);
      const bool same_step = !has_steps || std::isnan(spacings[a]) ||
                             std::abs(other.spacing[i] - step) * static_cast<double>(header_.grid.size[i]) <=
                                 largest_frame_distance * step;
      const bool same_start =
          !has_starts || std::isnan(mins[a]) || std::abs(other.origin[i] - start) <= largest_frame_distance * step;
      if (same_step && same_start) continue;
      header_.warnings.emplace_back(
          WarningCode::left_out,
          name_ + ": its " + (same_step ? "space origin and 'axis mins'" : "space directions and spacings") +
              " disagree at axis " + std::to_string(a) + ": " + exact_text(same_step ? start : step) + " and " +
              exact_text(same_step ? other.origin[i] : other.spacing[i]) + "; the " +
              (same_step ? "space origin is used" : "space directions are used"));
      return;
    }
  }

  /// Reads the spacings of axes without directions, which are x, y, z of the world in this order. NaN means that a
  /// spacing is unknown. If an axis has no spacing, its range (min to max) gives it. The range ends at the borders of
  /// the outer voxels, unless the axis is centred at nodes; this is the default of Teem, too.
  void read_spacings(GridSpec& grid) {
    const std::vector<double> spacings = numbers("spacings");
    const std::vector<double> mins = numbers("axismins");
    const std::vector<double> maxs = numbers("axismaxs");
    std::vector<std::string_view> centers;
    if (const std::string* text = find(find("centers") != nullptr ? "centers" : "centerings")) {
      centers = split_words(*text);
    }
    centers.resize(axis_count_);
    std::array<std::optional<Vec3d>, 3> steps;
    for (std::size_t i = 0; i < axes_.size(); ++i) {
      const std::size_t a = axes_[i];
      const std::string center = lower_case(centers[a]);
      double step = spacings.empty() || std::isnan(spacings[a]) ? 1.0 : spacings[a];
      const bool has_range = !mins.empty() && !maxs.empty() && std::isfinite(mins[a]) && std::isfinite(maxs[a]);
      const bool is_from_range = has_range && (spacings.empty() || std::isnan(spacings[a])) && mins[a] != maxs[a];
      if (is_from_range) {
        const auto count = static_cast<double>(sizes_[a]);
        step = (maxs[a] - mins[a]) / (center == "node" ? std::max(count - 1, 1.0) : count);
      }
      steps[i].emplace();
      (*steps[i])[i] = step;
      if (!mins.empty() && !std::isnan(mins[a])) {
        const bool is_cell = center == "cell" || (is_from_range && center != "node");
        grid.origin[i] = mins[a] + (is_cell ? 0.5 * step : 0.0);
      }
    }
    set_frame(grid, steps, name_);
    if (!is_finite(grid.origin)) fail("'axis mins' are not finite");
  }

  std::string data_file() const {
    const std::string* value = find("datafile");
    if (value == nullptr) return {};
    if (value->empty() || value->starts_with("LIST") || value->find('%') != std::string::npos) {
      fail("data spread over several files are not read; join them into one file first");
    }
    return *value;
  }

  void read_skips() {
    if (const std::string* value = find("lineskip")) {
      const auto skip = parse_number<std::uint64_t>(*value);
      if (!skip) fail("'line skip' is not a whole number >= 0");
      header_.line_skip = *skip;
    }
    if (const std::string* value = find("byteskip")) {
      const auto skip = parse_number<std::int64_t>(*value);
      if (!skip || *skip < -1 || (*skip == -1 && header_.encoding != NrrdEncoding::raw)) {
        fail("'byte skip' must be a whole number >= 0, or -1 for raw data");
      }
      header_.byte_skip = *skip;
    }
  }

  std::string name_;
  std::map<std::string, std::string> fields_;
  NrrdHeader header_;
  std::size_t axis_count_ = 0;
  std::vector<std::int64_t> sizes_;
  Vectors directions_;
  std::vector<std::size_t> axes_;  ///< the axes of the file that become x, y and z
};

std::uint64_t skip_lines(const ByteSource& source, std::uint64_t at, std::uint64_t lines) {
  std::vector<std::byte> piece(65536);
  while (lines > 0) {
    const std::size_t count = static_cast<std::size_t>(std::min<std::uint64_t>(piece.size(), source.size() - at));
    if (count == 0) throw FormatError(source.name() + ": it has fewer lines than 'line skip' says");
    source.read(at, std::span(piece).first(count));
    std::size_t i = 0;
    for (; i < count && lines > 0; ++i) lines -= piece[i] == std::byte{'\n'} ? 1U : 0U;
    at += i;
  }
  return at;
}

/// Returns a stream that starts at the first byte of a header's data.
std::unique_ptr<ByteStream> open_data(const ByteSource& source, const NrrdHeader& header, std::uint64_t bytes) {
  const std::uint64_t start = header.data_file.empty() ? header.data_start : 0;
  const std::uint64_t begin = skip_lines(source, start, header.line_skip);
  if (header.byte_skip == -1) {
    PlainStream(source, begin, source.size()).check_left(bytes, "the data");
    return std::make_unique<PlainStream>(source, source.size() - bytes, source.size());
  }
  std::unique_ptr<ByteStream> stream;
  if (header.encoding == NrrdEncoding::gzip) {
    stream = std::make_unique<InflateStream>(source, begin, source.size(), Compression::gzip);
  } else {
    stream = std::make_unique<PlainStream>(source, begin, source.size());
  }
  stream->skip(static_cast<std::uint64_t>(header.byte_skip), "the skipped part");
  return stream;
}

template <class T>
void parse_text_values(std::string_view text, std::span<std::byte> out, const std::string& name) {
  constexpr std::string_view separators = " \t\r\n\v\f,";
  std::size_t at = 0;
  for (std::size_t i = 0; i * sizeof(T) < out.size(); ++i) {
    at = std::min(text.find_first_not_of(separators, at), text.size());
    const std::size_t end = std::min(text.find_first_of(separators, at), text.size());
    const std::string_view word = text.substr(at, end - at);
    if (word.empty()) {
      throw FormatError(name + ": the text ends after " + std::to_string(i) + " of " +
                        std::to_string(out.size() / sizeof(T)) + " values");
    }
    const auto value = parse_number<T>(word);
    if (!value) {
      throw FormatError(name + ": value " + std::to_string(i) + " is '" + std::string(word.substr(0, 40)) +
                        "', which is not a number of its type");
    }
    std::copy_n(reinterpret_cast<const std::byte*>(&*value), sizeof(T), out.data() + i * sizeof(T));
    at = end;
  }
}

void read_text_values(ByteStream& stream, ScalarType type, std::span<std::byte> out) {
  std::string text(static_cast<std::size_t>(stream.most_left()), '\0');
  stream.read(std::as_writable_bytes(std::span(text)), "the data");
  using Parser = void (*)(std::string_view, std::span<std::byte>, const std::string&);
  constexpr std::array<Parser, 10> parsers{parse_text_values<std::uint8_t>,  parse_text_values<std::int8_t>,
                                           parse_text_values<std::uint16_t>, parse_text_values<std::int16_t>,
                                           parse_text_values<std::uint32_t>, parse_text_values<std::int32_t>,
                                           parse_text_values<std::uint64_t>, parse_text_values<std::int64_t>,
                                           parse_text_values<float>,         parse_text_values<double>};
  parsers[static_cast<std::size_t>(type)](text, out, stream.name());
}

}  // namespace

std::string nrrd_space(std::string_view name) {
  const std::string wanted = lower_case(trim(name));
  for (const auto& [full, short_form] : spaces) {
    if (wanted == lower_case(full) || (!short_form.empty() && wanted == short_form)) return std::string(full);
  }
  return {};
}

std::string nrrd_header(ScalarType type, const GridSpec& grid, const std::string& space, const Metadata& key_values) {
  const std::string known = nrrd_space(space);
  const auto& n = grid.size;
  std::string out =
      "NRRD0005\n# Complete NRRD file format specification at http://teem.sourceforge.net/nrrd/format.html\n";
  out += "type: " + std::string(type_names()[static_cast<std::size_t>(type)].names[0]) + "\ndimension: 3\n";
  out += (known.empty() ? "space dimension: 3" : "space: " + known) + "\nsizes: " + std::to_string(n[0]) + " " +
         std::to_string(n[1]) + " " + std::to_string(n[2]) + "\nspace directions:";
  for (std::size_t a = 0; a < 3; ++a) out += " " + vector_text(grid.direction.columns[a] * grid.spacing[a]);
  out += "\nkinds: domain domain domain\nendian: ";
  out += std::endian::native == std::endian::little ? "little" : "big";
  out += "\nencoding: raw\nspace origin: " + vector_text(grid.origin) + "\n";
  for (const auto& [key, value] : key_values) out += escaped(key) + ":=" + escaped(value) + "\n";
  return out + "\n";
}

NrrdHeader read_nrrd_header(const ByteSource& source) {
  return HeaderParser(source).parse();
}

void check_nrrd_data_size(const ByteSource& source, const NrrdHeader& header) {
  const std::uint64_t count = header.grid.node_count();
  if (header.encoding == NrrdEncoding::text) {
    // Each value needs at least two characters, a digit and a separator; the last one needs only a digit.
    open_data(source, header, 0)->check_left(2 * count - 1, "the data as text");
  } else {
    const std::uint64_t bytes = count * scalar_size(header.type);
    open_data(source, header, bytes)->check_left(bytes, "the data");
  }
}

void read_nrrd_data(const ByteSource& source, const NrrdHeader& header, std::span<std::byte> out) {
  const auto stream = open_data(source, header, out.size());
  if (header.encoding == NrrdEncoding::text) return read_text_values(*stream, header.type, out);
  stream->read(out, "the data");
  to_native(out, header.type, header.order);
  if (header.encoding == NrrdEncoding::gzip) stream->check_end();
}

std::filesystem::path nrrd_data_path(const NrrdHeader& header, const std::filesystem::path& header_path) {
  return header_path.parent_path() / header.data_file;
}

bool begins_as_nrrd(std::string_view head) {
  return head.starts_with("NRRD000");
}

ImageFile read_nrrd(const ByteSource& source, const std::filesystem::path& path) {
  NrrdHeader header = read_nrrd_header(source);
  check_count(header.grid.size, max_id_count, source.name());
  std::optional<FileSource> detached;
  if (!header.data_file.empty()) {
    if (path.empty()) throw FormatError(source.name() + ": its data are in another file, '" + header.data_file + "'");
    detached.emplace(nrrd_data_path(header, path), PipeUse::refuse);
  }
  const ByteSource& data = detached ? static_cast<const ByteSource&>(*detached) : source;
  check_nrrd_data_size(data, header);
  VoxelImage image;
  image.grid = header.grid;
  image.space = header.space;
  image.values = make_values(header.type, header.grid.node_count());
  read_nrrd_data(data, header, as_bytes(image.values));
  return {std::move(image), std::move(header.warnings)};
}

namespace {

void write_nrrd(const std::filesystem::path& path, const VoxelImageView& image) {
  write_values_after(path, nrrd_header(scalar_type(image.values), image.grid, image.space, {}), image);
}

}  // namespace

}  // namespace blum::volume_io

namespace blum::formats {

using namespace volume_io;

constinit const ImageCode image_nrrd{read_nrrd, write_nrrd, {begins_as_nrrd}};

}  // namespace blum::formats
