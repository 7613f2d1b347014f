// Blum: XML files of VTK with raw appended data. SPDX-License-Identifier: Apache-2.0
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

/// Opening XML tag, and the text between it and the next tag.
struct XmlTag {
  std::string_view name;
  std::vector<std::pair<std::string_view, std::string_view>> attributes;
  std::string_view text;
  std::size_t end = 0;  ///< position after the tag's '>'

  [[nodiscard]] std::optional<std::string_view> find(std::string_view key) const {
    for (const auto& [attribute, value] : attributes) {
      if (attribute == key) return value;
    }
    return std::nullopt;
  }
};

/// Returns the value of an attribute with its entities (&amp; and so on) replaced by characters.
[[nodiscard]] std::string without_entities(std::string_view value);

/// Reader of the opening tags of an XML text, one after the other. Entities are not replaced.
class XmlTags {
 public:
  XmlTags(std::string_view text, const std::string& name) : text_(text), name_(name) {}
  /// Returns the next tag, or nullopt after the last one. @throws FormatError if the XML is damaged.
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

/// Format of a file's appended arrays.
struct VtkAppended {
  std::endian order = std::endian::little;
  std::size_t length_size = 4;   ///< number of bytes of the length before each array
  std::uint64_t data_start = 0;  ///< position after the '_'
};

/// Description of one appended array.
struct VtkArray {
  ScalarType type = ScalarType::f32;
  std::uint64_t components = 1;
  std::uint64_t offset = 0;
};

// Reading. All of these functions throw FormatError with `name`, the name of the file.

/// Returns the text of a file up to and including the start of the appended data, or the whole file if it has none.
[[nodiscard]] std::string read_vtk_header(const ByteSource& source);
/// Returns the byte order and the size of lengths, from the attributes of the tag VTKFile. Its attribute `type` must
/// have the value `type`.
[[nodiscard]] VtkAppended vtk_layout(const XmlTag& tag, std::string_view type, const std::string& name);
/// Returns the position of the appended data. `tag` is the tag AppendedData of the text.
[[nodiscard]] std::uint64_t vtk_data_start(const XmlTag& tag, std::string_view text, const std::string& name);
[[nodiscard]] VtkArray vtk_array(const XmlTag& tag, const std::string& name);
/// Decodes an array that contains one string: the numbers of its bytes, with a zero at the end.
[[nodiscard]] std::string vtk_string(std::string_view text, const std::string& name);
/// Returns a stream of the values of one array, without the length before them. The length must be that of `count`
/// values, and the file must contain all of them.
/// @param needed_by  part of the file that requires so many values, for the message.
[[nodiscard]] PlainStream open_vtk_array(const ByteSource& source, const VtkAppended& appended, const VtkArray& array,
                                         std::uint64_t count, const char* needed_by);

// Writing.

[[nodiscard]] std::string_view vtk_type(ScalarType type);
/// Returns the start of a file, up to the tag of its data set.
[[nodiscard]] std::string vtk_opening(std::string_view type);
/// Returns an array that contains one string: the numbers of its bytes, with a zero at the end.
[[nodiscard]] std::string vtk_string_array(const std::string& name, const std::string& text);
[[nodiscard]] std::string vtk_appended_array(ScalarType type, std::string_view name, std::uint64_t components,
                                             std::uint64_t offset);

/// Returns true if a file with these first bytes is a VTK XML file of a type, for example "PolyData".
[[nodiscard]] bool begins_as_vtk(std::string_view head, std::string_view type);

}  // namespace blum::volume_io
