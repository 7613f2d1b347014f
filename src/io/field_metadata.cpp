#include "io/field_metadata.hpp"

#include <array>
#include <charconv>
#include <cmath>
#include <cstdint>

#include "blum/core/error.hpp"
#include "blum/core/exact_text.hpp"

namespace blum::volume_io {
namespace {

constexpr char32_t replacement = 0xFFFD;
constexpr std::string_view hex_digits = "0123456789abcdef";

/// The next code point of UTF-8 text, which is advanced past it; malformed bytes give U+FFFD, one byte at a time.
char32_t next_code_point(std::string_view& text) {
  const auto byte = [&](std::size_t i) { return static_cast<unsigned char>(text[i]); };
  const unsigned char first = byte(0);
  const std::size_t length = first < 0x80 ? 1 : first >= 0xF0 ? 4 : first >= 0xE0 ? 3 : 2;
  char32_t value = length == 1 ? first : first & (0x7FU >> length);
  bool good = first < 0x80 || (first >= 0xC2 && first <= 0xF4);
  for (std::size_t i = 1; good && i < length; ++i) {
    good = i < text.size() && (byte(i) & 0xC0U) == 0x80U;
    if (good) value = (value << 6U) | (byte(i) & 0x3FU);
  }
  constexpr std::array<char32_t, 5> smallest{0, 0, 0x80, 0x800, 0x10000};
  good = good && value >= smallest[length] && value <= 0x10FFFF && (value < 0xD800 || value > 0xDFFF);
  text.remove_prefix(good ? length : 1);
  return good ? value : replacement;
}

void append_unit(std::string& out, char32_t unit) {
  out += "\\u";
  for (int shift = 12; shift >= 0; shift -= 4) out += hex_digits[(unit >> shift) & 0xFU];
}

void append_json_string(std::string& out, std::string_view text) {
  out += '"';
  while (!text.empty()) {
    const char32_t c = next_code_point(text);
    if (c == '"' || c == '\\') {
      out += '\\';
      out += static_cast<char>(c);
    } else if (c >= 0x20 && c < 0x7F) {
      out += static_cast<char>(c);
    } else if (c < 0x10000) {
      append_unit(out, c);
    } else {
      append_unit(out, 0xD800 + ((c - 0x10000) >> 10U));
      append_unit(out, 0xDC00 + ((c - 0x10000) & 0x3FFU));
    }
  }
  out += '"';
}

void append_utf8(std::string& out, char32_t c) {
  const auto put = [&](char32_t byte) { out += static_cast<char>(static_cast<unsigned char>(byte)); };
  if (c < 0x80) return put(c);
  if (c < 0x800) {
    put(0xC0U | (c >> 6U));
  } else if (c < 0x10000) {
    put(0xE0U | (c >> 12U));
    put(0x80U | ((c >> 6U) & 0x3FU));
  } else {
    put(0xF0U | (c >> 18U));
    put(0x80U | ((c >> 12U) & 0x3FU));
    put(0x80U | ((c >> 6U) & 0x3FU));
  }
  put(0x80U | (c & 0x3FU));
}

/// A reader of one flat JSON object of strings.
class JsonReader {
 public:
  JsonReader(std::string_view text, const std::string& name) : text_(text), name_(name) {}

  Metadata object() {
    Metadata pairs;
    expect('{');
    if (accept('}')) return pairs;
    do {
      std::string key = string();
      expect(':');
      pairs.emplace_back(std::move(key), string());
    } while (accept(','));
    expect('}');
    return pairs;
  }

 private:
  [[noreturn]] void fail() const {
    throw FormatError(name_ + ": the metadata are not a JSON object of strings (character " + std::to_string(at_) +
                      ")");
  }
  void skip_space() {
    while (at_ < text_.size() && std::string_view(" \t\r\n").find(text_[at_]) != std::string_view::npos) ++at_;
  }
  bool accept(char c) {
    skip_space();
    if (at_ >= text_.size() || text_[at_] != c) return false;
    ++at_;
    return true;
  }
  void expect(char c) {
    if (!accept(c)) fail();
  }
  char take() {
    if (at_ >= text_.size()) fail();
    return text_[at_++];
  }

  std::string string() {
    std::string out;
    expect('"');
    for (char c = take(); c != '"'; c = take()) {
      if (c == '\\') {
        append_escape(out);
      } else {
        out += c;
      }
    }
    return out;
  }

  void append_escape(std::string& out) {
    const char c = take();
    constexpr std::string_view names = "\"\\/bfnrt";
    constexpr std::string_view values = "\"\\/\b\f\n\r\t";
    if (const std::size_t i = names.find(c); i != std::string_view::npos) {
      out += values[i];
      return;
    }
    if (c != 'u') fail();
    char32_t code = unit();
    if (code >= 0xD800 && code < 0xDC00) {
      if (take() != '\\' || take() != 'u') fail();
      const char32_t low = unit();
      if (low < 0xDC00 || low > 0xDFFF) fail();
      code = 0x10000 + ((code - 0xD800) << 10U) + (low - 0xDC00);
    } else if (code >= 0xDC00 && code <= 0xDFFF) {
      fail();
    }
    append_utf8(out, code);
  }

  char32_t unit() {
    char32_t value = 0;
    for (int i = 0; i < 4; ++i) {
      const char c = take();
      const char lower = c >= 'A' && c <= 'F' ? static_cast<char>(c - 'A' + 'a') : c;
      const std::size_t digit = hex_digits.find(lower);
      if (digit == std::string_view::npos) fail();
      value = value * 16 + static_cast<char32_t>(digit);
    }
    return value;
  }

  std::string_view text_;
  const std::string& name_;
  std::size_t at_ = 0;
};

/// Finds the enumerator that to_string shows as `text`.
template <class Enum, std::size_t n>
Enum from_text(std::string_view text, const std::array<Enum, n>& all, std::string_view key, const std::string& name) {
  for (const Enum value : all) {
    if (to_string(value) == text) return value;
  }
  throw FormatError(name + ": the metadata say " + std::string(key) + " '" + std::string(text) +
                    "', which is not known");
}

}  // namespace

std::string site_sentence(SiteIds ids) {
  switch (ids) {
    case SiteIds::features:
      return "site ids: [0, V) the vertices in the mesh's order; [V, V+E) the distinct edges in rising order of "
             "(smaller, larger vertex); [V+E, V+E+F) the triangles in the mesh's order; -1 none";
    case SiteIds::triangles:
      return "site ids: the smallest triangle, in the mesh's order, that the closest site lies on; -1 none";
    case SiteIds::voxels:
      return "site ids: the linear index x + nx * (y + ny * z) of the closest voxel; -1 none";
  }
  return {};
}

Metadata field_metadata(const Field& field, const FieldFileInfo& info) {
  Metadata pairs;
  if (!info.version.empty()) pairs.emplace_back("blum_version", info.version);
  if (!info.source.empty()) pairs.emplace_back("source", info.source);
  const bool is_signed = field.sign_rule != SignRule::none;
  const std::string unit = field.site_ids == SiteIds::voxels ? "the image" : "the mesh";
  pairs.emplace_back("distance", is_signed ? "negative inside, units of " + unit : "unsigned, units of " + unit);
  pairs.emplace_back("sign_rule", to_string(field.sign_rule));
  if (!field.sign_reason.empty()) pairs.emplace_back("sign_reason", field.sign_reason);
  if (field.band) {
    pairs.emplace_back("band", exact_text(*field.band));
    pairs.emplace_back("beyond_band", "distance +-band, site -1");
  }
  if (!field.site.empty()) {
    pairs.emplace_back("site_ids", to_string(field.site_ids));
    pairs.emplace_back("sites", site_sentence(field.site_ids));
  }
  if (info.sites != nullptr) {
    pairs.emplace_back("vertex_count", std::to_string(info.sites->vertex_count()));
    pairs.emplace_back("edge_count", std::to_string(info.sites->edge_count()));
    pairs.emplace_back("face_count", std::to_string(info.sites->face_count()));
  }
  if (!info.space.empty()) pairs.emplace_back("world_axes", info.space);
  pairs.emplace_back("values", "at nodes, x fastest");
  return pairs;
}

std::string_view find_value(const Metadata& metadata, std::string_view key) {
  for (const auto& [name, value] : metadata) {
    if (name == key) return value;
  }
  return {};
}

void apply_metadata(const Metadata& metadata, const std::string& name, Field& field) {
  if (const std::string_view text = find_value(metadata, "band"); !text.empty()) {
    double band = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), band);
    if (error != std::errc() || end != text.data() + text.size() || !(band > 0) || !std::isfinite(band)) {
      throw FormatError(name + ": the metadata say band '" + std::string(text) + "', but it must be a positive number");
    }
    field.band = band;
  }
  if (const std::string_view text = find_value(metadata, "sign_rule"); !text.empty()) {
    constexpr std::array all{SignRule::none, SignRule::normals, SignRule::winding, SignRule::label, SignRule::balls};
    field.sign_rule = from_text(text, all, "sign_rule", name);
  }
  if (const std::string_view text = find_value(metadata, "site_ids"); !text.empty()) {
    constexpr std::array all{SiteIds::features, SiteIds::triangles, SiteIds::voxels};
    field.site_ids = from_text(text, all, "site_ids", name);
  }
  field.sign_reason = find_value(metadata, "sign_reason");
}

std::string to_json(const Metadata& metadata) {
  std::string out = "{";
  for (const auto& [key, value] : metadata) {
    if (out.size() > 1) out += ", ";
    append_json_string(out, key);
    out += ": ";
    append_json_string(out, value);
  }
  return out + "}";
}

Metadata from_json(std::string_view json, const std::string& name) {
  return JsonReader(json, name).object();
}

}  // namespace blum::volume_io
