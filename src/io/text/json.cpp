#include "io/text/json.hpp"

#include <algorithm>
#include <nlohmann/json.hpp>
#include <string>
#include <utility>

#include "blum/core/error.hpp"

namespace blum {

std::string_view find_value(const FileMetadata& metadata, std::string_view key) {
  const auto found =
      std::find_if(metadata.begin(), metadata.end(), [&](const auto& pair) { return pair.first == key; });
  return found == metadata.end() ? std::string_view() : found->second;
}

namespace volume_io {
namespace {

using nlohmann::json;

std::string json_string(const std::string& text) {
  return json(text).dump(-1, ' ', true, json::error_handler_t::replace);
}

/// Reader of one flat object of strings; it keeps their order. Any other JSON stops the parser at once, so that deep
/// nesting costs nothing.
class FlatObject final : public nlohmann::json_sax<json> {
 public:
  FileMetadata pairs;
  std::size_t position = 0;  ///< position in the text that the parser rejected

  bool start_object(std::size_t /*size*/) override { return !std::exchange(is_open_, true); }
  bool end_object() override { return true; }
  bool key(string_t& text) override {
    key_ = std::move(text);
    return true;
  }
  bool string(string_t& text) override {
    if (is_open_) pairs.emplace_back(std::move(key_), std::move(text));
    return is_open_;
  }
  bool null() override { return false; }
  bool boolean(bool /*value*/) override { return false; }
  bool number_integer(number_integer_t /*value*/) override { return false; }
  bool number_unsigned(number_unsigned_t /*value*/) override { return false; }
  bool number_float(number_float_t /*value*/, const string_t& /*text*/) override { return false; }
  bool binary(binary_t& /*value*/) override { return false; }
  bool start_array(std::size_t /*size*/) override { return false; }
  bool end_array() override { return false; }
  bool parse_error(std::size_t at, const std::string& /*token*/, const json::exception& /*error*/) override {
    position = at;
    return false;
  }

 private:
  std::string key_;
  bool is_open_ = false;
};

}  // namespace

std::string json_text(const std::string& text) {
  return json(text).dump(-1, ' ', false, json::error_handler_t::replace);
}

std::string valid_utf8(const std::string& text) {
  return json::parse(json_string(text)).get<std::string>();
}

std::string to_json(const FileMetadata& metadata) {
  std::string out = "{";
  for (const auto& [key, value] : metadata) {
    if (out.size() > 1) out += ", ";
    out += json_string(key) + ": " + json_string(value);
  }
  return out + "}";
}

std::string to_typed_json(const FileMetadata& metadata, std::span<const std::string_view> typed) {
  std::string out = "{";
  for (const auto& [key, value] : metadata) {
    if (out.size() > 1) out += ", ";
    const bool is_typed = std::find(typed.begin(), typed.end(), key) != typed.end() && json::accept(value);
    out += json_string(key) + ": " + (is_typed ? value : json_string(value));
  }
  return out + "}";
}

FileMetadata from_json(std::string_view text, const std::string& name) {
  FlatObject object;
  if (json::sax_parse(text.begin(), text.end(), &object)) return std::move(object.pairs);
  throw FormatError(name + ": the metadata are not a JSON object of strings" +
                    (object.position > 0 ? " (character " + std::to_string(object.position) + ")" : ""));
}

}  // namespace volume_io
}  // namespace blum
