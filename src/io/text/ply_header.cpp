#include "io/text/ply.hpp"

#include <array>
#include <utility>

#include "io/text/text_cursor.hpp"

namespace blum {
namespace {

constexpr std::array<std::pair<std::string_view, PlyType>, 18> type_names = {{{"char", PlyType::int8},
                                                                              {"int8", PlyType::int8},
                                                                              {"uchar", PlyType::uint8},
                                                                              {"uint8", PlyType::uint8},
                                                                              {"short", PlyType::int16},
                                                                              {"int16", PlyType::int16},
                                                                              {"ushort", PlyType::uint16},
                                                                              {"uint16", PlyType::uint16},
                                                                              {"int", PlyType::int32},
                                                                              {"int32", PlyType::int32},
                                                                              {"uint", PlyType::uint32},
                                                                              {"uint32", PlyType::uint32},
                                                                              {"int64", PlyType::int64},
                                                                              {"uint64", PlyType::uint64},
                                                                              {"float", PlyType::float32},
                                                                              {"float32", PlyType::float32},
                                                                              {"double", PlyType::float64},
                                                                              {"float64", PlyType::float64}}};

class HeaderReader {
 public:
  HeaderReader(std::string_view bytes, std::string_view name) : begin_(bytes.data()), cursor_(bytes, name, 0) {}

  PlyHeader read() {
    if (cursor_.take_token() != "ply") cursor_.fail_at(begin_, "a PLY file must begin with the word 'ply'");
    line_end_ = take_line_end();
    bool has_format = false;
    while (true) {
      if (!cursor_.skip_space()) cursor_.fail("the file ends within its header: 'end_header' is missing");
      const char* const start = cursor_.position();
      const std::string_view keyword = cursor_.take_token();
      if (keyword == "end_header") break;
      if (keyword == "format") {
        read_format();
        has_format = true;
      } else if (keyword == "element") {
        read_element();
      } else if (keyword == "property") {
        read_property();
      } else if (keyword == "comment") {
        header_.comments.emplace_back(rest_of_line());
      } else if (keyword != "obj_info") {
        cursor_.fail_at(start, "unknown keyword in the header: " + in_quotes(keyword));
      }
      cursor_.skip_line();
    }
    if (!has_format) cursor_.fail("the header has no 'format' line");
    if (take_line_end().empty()) cursor_.fail("'end_header' must be alone on its line");
    header_.size = static_cast<std::size_t>(cursor_.position() - begin_);
    return std::move(header_);
  }

 private:
  /// Moves behind the end of this line. The first line defines how lines end. Later lines are not examined because, in
  /// a binary file whose lines end in CR, the data may start with the byte LF.
  std::string_view take_line_end() {
    cursor_.skip_blanks();
    const char* const start = cursor_.position();
    const std::string_view rest(start, cursor_.remaining());
    std::size_t size = 0;
    if (rest.starts_with("\r\n") && (line_end_.empty() || line_end_ == "\r\n")) {
      size = 2;
    } else if (rest.starts_with('\n') || rest.starts_with('\r')) {
      size = 1;
    }
    cursor_.set_position(start + size);
    return rest.substr(0, size);
  }

  /// Returns the remaining text of the line, without blanks at its ends. The cursor is not moved.
  [[nodiscard]] std::string_view rest_of_line() const {
    TextCursor end = cursor_;
    end.skip_line();
    return volume_io::trim({cursor_.position(), static_cast<std::size_t>(end.position() - cursor_.position())});
  }

  std::string_view next(std::string_view what) {
    cursor_.skip_blanks();
    const std::string_view token = cursor_.take_token();
    if (token.empty()) cursor_.fail(std::string(what) + " is missing");
    return token;
  }

  void read_format() {
    const std::string_view encoding = next("the format");
    if (encoding == "ascii") {
      header_.encoding = PlyEncoding::text;
    } else if (encoding == "binary_little_endian") {
      header_.encoding = PlyEncoding::little_endian;
    } else if (encoding == "binary_big_endian") {
      header_.encoding = PlyEncoding::big_endian;
    } else {
      cursor_.fail_at(encoding.data(), "unknown format " + in_quotes(encoding) +
                                           ": known are ascii, binary_little_endian and binary_big_endian");
    }
    if (next("the format's version") != "1.0") cursor_.fail("only version 1.0 of PLY is known");
  }

  void read_element() {
    PlyElement element;
    element.name = next("the element's name");
    const std::int64_t count = cursor_.take_integer("number of elements");
    if (count < 0) cursor_.fail("element " + in_quotes(element.name) + " has a negative count");
    element.count = static_cast<std::size_t>(count);
    for (const PlyElement& other : header_.elements) {
      if (other.name == element.name) cursor_.fail("element " + in_quotes(element.name) + " occurs twice");
    }
    constexpr std::size_t most = 1000;  // the search above takes linear time, and real files have far fewer
    if (header_.elements.size() == most) cursor_.fail("the header has more than 1000 elements");
    header_.elements.push_back(std::move(element));
  }

  void read_property() {
    if (header_.elements.empty()) cursor_.fail("a property comes before the first element");
    PlyProperty property;
    std::string_view type = next("the property's type");
    if (type == "list") {
      property.is_list = true;
      property.count_type = type_of(next("the type of the list's length"));
      if (is_floating(property.count_type)) cursor_.fail("the length of a list must be of a whole-number type");
      type = next("the type of the list's entries");
    }
    property.type = type_of(type);
    property.name = next("the property's name");
    header_.elements.back().properties.push_back(std::move(property));
  }

  PlyType type_of(std::string_view name) const {
    for (const auto& [known, type] : type_names) {
      if (known == name) return type;
    }
    cursor_.fail_at(name.data(), "unknown type " + in_quotes(name));
  }

  const char* begin_;
  TextCursor cursor_;
  std::string_view line_end_;
  PlyHeader header_;
};

}  // namespace

PlyHeader read_ply_header(std::string_view bytes, std::string_view name) {
  return HeaderReader(bytes, name).read();
}

}  // namespace blum
