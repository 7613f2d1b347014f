// Blum: the XML files of VTK, with raw appended data. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "io/bytes/byte_source.hpp"
#include "io/bytes/scalar_type.hpp"

namespace blum::volume_io {

/// An opening tag of XML and the text behind it, up to the next tag.
struct XmlTag {
  std::string_view name;
  std::vector<std::pair<std::string_view, std::string_view>> attributes;
  std::string_view text;
  std::size_t end = 0;  ///< behind the tag's '>'

  [[nodiscard]] std::optional<std::string_view> find(std::string_view key) const {
    for (const auto& [attribute, value] : attributes) {
      if (attribute == key) return value;
    }
    return std::nullopt;
  }
};

/// The value of an attribute with its entities (&amp; and so on) as the characters that they stand for.
[[nodiscard]] std::string without_entities(std::string_view value);

/// The opening tags of a text, one after the other, with their entities.
class XmlTags {
 public:
  XmlTags(std::string_view text, const std::string& name) : text_(text), name_(name) {}
  /// @throws FormatError when the XML is damaged.
  std::optional<XmlTag> next();

 private:
  [[noreturn]] void fail() const;
  std::string_view until(std::string_view stops);
  void skip_space();
  XmlTag tag();

  std::string_view text_;
  const std::string& name_;
  std::size_t at_ = 0;
};

/// How a file holds its appended arrays.
struct VtkAppended {
  std::endian order = std::endian::little;
  std::size_t length_size = 4;   ///< bytes of the number before each array
  std::uint64_t data_start = 0;  ///< behind the '_'
};

/// One appended array.
struct VtkArray {
  ScalarType type = ScalarType::f32;
  std::uint64_t components = 1;
  std::uint64_t offset = 0;
};

// Reading. All throw FormatError with `name`, which stands for the file.

/// The file up to and with the start of the appended data; all of it, where there are none.
[[nodiscard]] std::string read_vtk_header(const ByteSource& source);
/// Byte order and size of lengths, from the tag VTKFile, which must be of the type `type`.
[[nodiscard]] VtkAppended vtk_layout(const XmlTag& tag, std::string_view type, const std::string& name);
/// Where the data begin, from the tag AppendedData of the text.
[[nodiscard]] std::uint64_t vtk_data_start(const XmlTag& tag, std::string_view text, const std::string& name);
[[nodiscard]] VtkArray vtk_array(const XmlTag& tag, const std::string& name);
/// The text of an array of one string: the numbers of its bytes, with a zero at the end.
[[nodiscard]] std::string vtk_string(std::string_view text, const std::string& name);
/// The values of one array, past its length, which must be that of `count` values; all of them are there.
/// @param needed_by  what asks for so many values, for the message.
[[nodiscard]] PlainStream open_vtk_array(const ByteSource& source, const VtkAppended& appended, const VtkArray& array,
                                         std::uint64_t count, const char* needed_by);

// Writing.

[[nodiscard]] std::string_view vtk_type(ScalarType type);
/// The opening of a file, up to the tag of its data set.
[[nodiscard]] std::string vtk_opening(std::string_view type);
/// An array of one string. VTK writes strings as the numbers of their bytes, with a zero at the end.
[[nodiscard]] std::string vtk_string_array(const std::string& name, const std::string& text);
[[nodiscard]] std::string vtk_appended_array(ScalarType type, std::string_view name, std::uint64_t components,
                                             std::uint64_t offset);

}  // namespace blum::volume_io
