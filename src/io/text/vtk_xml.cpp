#include "io/text/vtk_xml.hpp"

#include <algorithm>
#include <limits>
#include <span>

#include "blum/core/error.hpp"
#include "io/text/text_cursor.hpp"

namespace blum::volume_io {
namespace {

constexpr std::uint64_t largest_header = std::uint64_t{16} << 20U;
constexpr std::array<std::string_view, 10> type_names{"UInt8", "Int8",   "UInt16", "Int16",   "UInt32",
                                                      "Int32", "UInt64", "Int64",  "Float32", "Float64"};

}  // namespace

std::string without_entities(std::string_view value) {
  constexpr std::array<std::pair<std::string_view, char>, 5> entities{
      {{"&amp;", '&'}, {"&lt;", '<'}, {"&gt;", '>'}, {"&quot;", '"'}, {"&apos;", '\''}}};
  std::string out;
  while (!value.empty()) {
    const auto entity = std::find_if(entities.begin(), entities.end(),
                                     [&](const auto& known) { return value.starts_with(known.first); });
    out += entity == entities.end() ? value.front() : entity->second;
    value.remove_prefix(entity == entities.end() ? 1 : entity->first.size());
  }
  return out;
}

std::optional<XmlTag> XmlTags::next() {
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

void XmlTags::fail() const {
  throw FormatError(name_ + ": the XML is damaged at byte " + std::to_string(std::min(at_, text_.size())));
}

std::string_view XmlTags::until(std::string_view stops) {
  const std::size_t end = text_.find_first_of(stops, at_);
  if (end == std::string_view::npos) fail();
  const std::string_view out = text_.substr(at_, end - at_);
  at_ = end;
  return out;
}

void XmlTags::skip_space() {
  at_ = std::min(text_.find_first_not_of(white_space, at_), text_.size());
}

XmlTag XmlTags::tag() {
  XmlTag tag;
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

std::string read_vtk_header(const ByteSource& source) {
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
    if (have == largest_header) throw FormatError(source.name() + ": it is not a file of VTK with appended data");
  }
}

VtkAppended vtk_layout(const XmlTag& tag, std::string_view type, const std::string& name) {
  if (tag.find("type") != type) {
    throw FormatError(name + ": it is a VTK file of another type than " + std::string(type));
  }
  if (tag.find("compressor")) throw FormatError(name + ": its data are compressed; save it without compression");
  VtkAppended appended;
  appended.order = tag.find("byte_order") == "BigEndian" ? std::endian::big : std::endian::little;
  appended.length_size = tag.find("header_type") == "UInt64" ? 8 : 4;
  return appended;
}

std::uint64_t vtk_data_start(const XmlTag& tag, std::string_view text, const std::string& name) {
  if (tag.find("encoding") != "raw") {
    throw FormatError(name + ": its appended data are not raw; save it with raw appended data");
  }
  const std::size_t mark = text.find_first_not_of(white_space, tag.end);
  if (mark == std::string_view::npos || text[mark] != '_') {
    throw FormatError(name + ": the appended data do not begin with '_'");
  }
  return mark + 1;
}

VtkArray vtk_array(const XmlTag& tag, const std::string& name) {
  const std::string shown = "'" + std::string(tag.find("Name").value_or("")) + "'";
  if (tag.find("format") != "appended") {
    throw FormatError(name + ": its arrays are not appended; save it with raw appended data");
  }
  const auto components = parse_number<std::uint64_t>(tag.find("NumberOfComponents").value_or("1"));
  if (!components) throw FormatError(name + ": the number of components of " + shown + " is not a number");
  const auto offset = parse_number<std::uint64_t>(tag.find("offset").value_or(""));
  if (!offset) throw FormatError(name + ": the offset of " + shown + " is not a number");
  const std::string_view type = tag.find("type").value_or("");
  const auto found = std::find(type_names.begin(), type_names.end(), type);
  if (found == type_names.end()) {
    throw FormatError(name + ": the array " + shown + " has the unknown type '" + std::string(type) + "'");
  }
  return {static_cast<ScalarType>(found - type_names.begin()), *components, *offset};
}

std::string vtk_string(std::string_view text, const std::string& name) {
  std::string out;
  for (const std::string_view word : split_words(text)) {
    const auto byte = parse_number<unsigned>(word);
    if (!byte || *byte > 255) throw FormatError(name + ": the metadata are not a string of VTK");
    if (*byte == 0) break;
    out += static_cast<char>(static_cast<unsigned char>(*byte));
  }
  return out;
}

PlainStream open_vtk_array(const ByteSource& source, const VtkAppended& appended, const VtkArray& array,
                           std::uint64_t count, const char* needed_by) {
  const std::uint64_t room = source.size() - appended.data_start;
  if (array.offset > room || room - array.offset < appended.length_size) {
    throw FormatError(source.name() + ": an array begins beyond the end of the file; it is cut short");
  }
  std::array<std::byte, 8> bytes{};
  const std::uint64_t at = appended.data_start + array.offset;
  source.read(at, std::span(bytes).first(appended.length_size));
  if (appended.order == std::endian::big) {
    std::reverse(bytes.begin(), bytes.begin() + std::ptrdiff_t(appended.length_size));
  }
  std::uint64_t length = 0;
  for (std::size_t i = 8; i-- > 0;) length = length << 8U | std::to_integer<std::uint64_t>(bytes[i]);
  const std::uint64_t size = scalar_size(array.type);
  if (length % size != 0 || length / size != count) {
    throw FormatError(source.name() + ": an array has " + std::to_string(length) + " bytes, but " + needed_by +
                      " needs " + std::to_string(count * size));
  }
  if (length > room - array.offset - appended.length_size) {
    throw FormatError(source.name() + ": an array reaches beyond the end of the file; it is cut short");
  }
  return {source, at + appended.length_size, source.size()};
}

std::string_view vtk_type(ScalarType type) {
  return type_names[static_cast<std::size_t>(type)];
}

std::string vtk_opening(std::string_view type) {
  return "<?xml version=\"1.0\"?>\n<VTKFile type=\"" + std::string(type) + "\" version=\"1.0\" byte_order=\"" +
         (std::endian::native == std::endian::little ? "LittleEndian" : "BigEndian") + "\" header_type=\"UInt64\">\n";
}

std::string vtk_string_array(const std::string& name, const std::string& text) {
  std::string out = "      <DataArray type=\"String\" Name=\"" + name + "\" NumberOfTuples=\"1\" format=\"ascii\">\n";
  for (const char c : text) out += std::to_string(static_cast<unsigned char>(c)) + " ";
  return out + "0\n      </DataArray>\n";
}

std::string vtk_appended_array(ScalarType type, std::string_view name, std::uint64_t components, std::uint64_t offset) {
  return "        <DataArray type=\"" + std::string(vtk_type(type)) + "\" Name=\"" + std::string(name) +
         "\" NumberOfComponents=\"" + std::to_string(components) + "\" format=\"appended\" offset=\"" +
         std::to_string(offset) + "\"/>\n";
}

bool begins_as_vtk(std::string_view head, std::string_view type) {
  const std::size_t start = head.find("<VTKFile");
  if (start == std::string_view::npos) return false;
  const std::string_view tag = head.substr(start, head.find('>', start) - start);
  return tag.find("type=\"" + std::string(type) + "\"") != std::string_view::npos;
}

}  // namespace blum::volume_io
