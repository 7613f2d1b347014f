// Blum: headers and values of PLY files. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <string>
#include <string_view>
#include <vector>

#include "blum/core/error.hpp"
#include "io/text/text_cursor.hpp"

namespace blum {

enum class PlyEncoding : std::uint8_t { text, little_endian, big_endian };
enum class PlyType : std::uint8_t { int8, uint8, int16, uint16, int32, uint32, int64, uint64, float32, float64 };

[[nodiscard]] constexpr bool is_floating(PlyType type) {
  return type >= PlyType::float32;
}
/// Returns the number of bytes that a value of this type takes in a binary file.
[[nodiscard]] constexpr std::size_t size_of(PlyType type) {
  constexpr std::size_t sizes[] = {1, 1, 2, 2, 4, 4, 8, 8, 4, 8};
  return sizes[static_cast<std::size_t>(type)];
}

struct PlyProperty {
  std::string name;
  bool is_list = false;
  PlyType count_type = PlyType::uint8;  ///< type of a list's length
  PlyType type = PlyType::float32;
};

struct PlyElement {
  std::string name;
  std::size_t count = 0;
  std::vector<PlyProperty> properties = {};
};

struct PlyHeader {
  PlyEncoding encoding = PlyEncoding::text;
  std::vector<PlyElement> elements = {};
  std::vector<std::string> comments = {};
  std::size_t size = 0;  ///< size of the header in bytes
};

/// Reads the header of a file. @throws FormatError.
[[nodiscard]] PlyHeader read_ply_header(std::string_view bytes, std::string_view name);

/// Reader of the values of a text file. Line ends count as blanks.
class PlyText {
 public:
  PlyText(std::string_view bytes, const PlyHeader& header, std::string_view name)
      : begin_(bytes.data()), cursor_(bytes, name, 0) {
    cursor_.set_position(begin_ + header.size);
  }

  [[nodiscard]] std::size_t remaining() const { return cursor_.remaining(); }
  /// Returns the smallest number of bytes that an entry of an element can take: one character and one blank for each
  /// value.
  [[nodiscard]] static std::size_t least_size(const PlyElement& element) { return 2 * element.properties.size(); }
  [[nodiscard]] std::size_t where() {
    cursor_.skip_space();
    return static_cast<std::size_t>(cursor_.position() - begin_);
  }

  double number(PlyType /*type*/, std::string_view what) {
    cursor_.skip_space();
    return cursor_.take_number(what);
  }
  /// Reads a number, which may be infinite or NaN.
  double any_number(PlyType /*type*/, std::string_view what) {
    cursor_.skip_space();
    return cursor_.take_any_number(what);
  }
  std::int64_t integer(PlyType /*type*/, std::string_view what) {
    cursor_.skip_space();
    return cursor_.take_integer(what);
  }
  std::size_t list_count(const PlyProperty& property) {
    const std::int64_t count = integer(property.count_type, "length of a list");
    if (count < 0) fail("a list of negative length: " + std::to_string(count));
    if (static_cast<std::uint64_t>(count) > remaining() / 2 + 1) {
      fail("a list of " + std::to_string(count) + " entries, but the file is too short for them");
    }
    return static_cast<std::size_t>(count);
  }
  void skip(const PlyProperty& property) {
    const std::size_t count = property.is_list ? list_count(property) : 1;
    for (std::size_t i = 0; i < count; ++i) {
      if (!cursor_.skip_space()) fail("the file ends where property " + in_quotes(property.name) + " should be");
      cursor_.take_token();
    }
  }
  void expect_end() {
    if (cursor_.skip_space()) fail("the file goes on after its last element: the counts in the header are wrong");
  }

  [[noreturn]] void fail(const std::string& message) const { cursor_.fail(message); }
  [[noreturn]] void fail_at(std::size_t where, const std::string& message) const {
    cursor_.fail_at(begin_ + where, message);
  }

 private:
  const char* begin_;
  TextCursor cursor_;
};

/// Reader of the values of a binary file.
class PlyBinary {
 public:
  PlyBinary(std::string_view bytes, const PlyHeader& header, std::string_view name)
      : bytes_(bytes),
        name_(name),
        position_(header.size),
        swap_((header.encoding == PlyEncoding::big_endian) != (std::endian::native == std::endian::big)) {}

  [[nodiscard]] std::size_t remaining() const { return bytes_.size() - position_; }
  /// Returns the smallest number of bytes that an entry of an element can take. Lists may be empty.
  [[nodiscard]] static std::size_t least_size(const PlyElement& element) {
    std::size_t size = 0;
    for (const PlyProperty& p : element.properties) size += size_of(p.is_list ? p.count_type : p.type);
    return size;
  }
  [[nodiscard]] std::size_t where() const { return position_; }

  double number(PlyType type, std::string_view what) {
    const std::size_t start = position_;
    const double value = any_number(type, what);
    if (!std::isfinite(value)) fail_at(start, "a " + std::string(what) + " is not finite");
    return value;
  }
  /// Reads a number, which may be infinite or NaN.
  double any_number(PlyType type, std::string_view what) {
    if (type == PlyType::float32) return std::bit_cast<float>(take<std::uint32_t>());
    if (type == PlyType::float64) return std::bit_cast<double>(take<std::uint64_t>());
    if (type == PlyType::uint64) return static_cast<double>(take<std::uint64_t>());
    return static_cast<double>(integer(type, what));
  }
  /// Reads a value of an integer type.
  std::int64_t integer(PlyType type, std::string_view what) {
    switch (type) {
      case PlyType::int8:
        return static_cast<std::int8_t>(take<std::uint8_t>());
      case PlyType::uint8:
        return take<std::uint8_t>();
      case PlyType::int16:
        return static_cast<std::int16_t>(take<std::uint16_t>());
      case PlyType::uint16:
        return take<std::uint16_t>();
      case PlyType::int32:
        return static_cast<std::int32_t>(take<std::uint32_t>());
      case PlyType::uint32:
        return take<std::uint32_t>();
      case PlyType::int64:
        return static_cast<std::int64_t>(take<std::uint64_t>());
      case PlyType::uint64:
      case PlyType::float32:
      case PlyType::float64:
        break;
    }
    const std::uint64_t value = take<std::uint64_t>();
    if (value > INT64_MAX) fail(std::string(what) + " is too large: " + std::to_string(value));
    return static_cast<std::int64_t>(value);
  }
  std::size_t list_count(const PlyProperty& property) {
    const std::size_t start = position_;
    const std::int64_t count = integer(property.count_type, "length of a list");
    if (count < 0) fail_at(start, "a list of negative length: " + std::to_string(count));
    if (static_cast<std::uint64_t>(count) > remaining() / size_of(property.type)) {
      fail_at(start, "a list of " + std::to_string(count) + " entries, but the file is too short for them");
    }
    return static_cast<std::size_t>(count);
  }
  void skip(const PlyProperty& property) {
    const std::size_t count = property.is_list ? list_count(property) : 1;
    require(count * size_of(property.type));
    position_ += count * size_of(property.type);
  }
  /// Throws unless the data end here. Some programs add a line end or zeros at the end of a file; anything else means
  /// that counts are wrong.
  void expect_end() const {
    if (bytes_.find_first_not_of(std::string_view("\0\r\n ", 4), position_) == std::string_view::npos) return;
    fail("the file goes on after its last element: the counts in the header are wrong");
  }

  [[noreturn]] void fail(const std::string& message) const { fail_at(position_, message); }
  [[noreturn]] void fail_at(std::size_t where, const std::string& message) const {
    throw FormatError("'" + std::string(name_) + "', byte " + std::to_string(where) + ": " + message);
  }

 private:
  void require(std::size_t size) const {
    if (remaining() < size) fail_at(bytes_.size(), "the file ends too early, within the data that its header promises");
  }

  template <class T>
  T take() {
    require(sizeof(T));
    T value;
    std::memcpy(&value, bytes_.data() + position_, sizeof(T));
    position_ += sizeof(T);
    if constexpr (sizeof(T) == 2) {
      if (swap_) value = __builtin_bswap16(value);
    } else if constexpr (sizeof(T) == 4) {
      if (swap_) value = __builtin_bswap32(value);
    } else if constexpr (sizeof(T) == 8) {
      if (swap_) value = __builtin_bswap64(value);
    }
    return value;
  }

  std::string_view bytes_;
  std::string_view name_;
  std::size_t position_;
  bool swap_;
};

}  // namespace blum
