#include "common/json.hpp"

#include <algorithm>
#include <nlohmann/json.hpp>
#include <stdexcept>

namespace blum::cli {

Json::Json() noexcept = default;
Json::Json(Exactly /*tag*/, bool value) : value_(value) {}
Json::Json(Exactly /*tag*/, std::int64_t value) : value_(value) {}
Json::Json(Exactly /*tag*/, std::uint64_t value) : value_(value) {}
Json::Json(Exactly /*tag*/, double value) : value_(value) {}
Json::Json(const char* text) : value_(std::string(text)) {}
Json::Json(std::string text) : value_(std::move(text)) {}
Json::Json(std::string_view text) : value_(std::string(text)) {}
Json::Json(const Json& other) = default;
Json::Json(Json&& other) noexcept = default;
Json& Json::operator=(const Json& other) = default;
Json& Json::operator=(Json&& other) noexcept = default;
Json::~Json() = default;

Json::Json(std::initializer_list<JsonItem> items) {
  const bool is_object = std::all_of(items.begin(), items.end(), [](const JsonItem& item) {
    const Array* pair = std::get_if<Array>(&item.value_.value_);
    return pair != nullptr && pair->size() == 2 && std::holds_alternative<std::string>(pair->front().value_);
  });
  if (!is_object) {
    *this = array(items);
    return;
  }
  *this = object();
  for (const JsonItem& item : items) {
    auto& pair = std::get<Array>(item.value_.value_);
    const std::string& name = std::get<std::string>(pair[0].value_);
    if (!contains(name)) (*this)[name] = std::move(pair[1]);
  }
}

Json Json::array() {
  Json out;
  out.value_ = Array();
  return out;
}

Json Json::array(std::initializer_list<JsonItem> items) {
  Array values;
  values.reserve(items.size());
  for (const JsonItem& item : items) values.push_back(std::move(item.value_));
  Json out;
  out.value_ = std::move(values);
  return out;
}

Json Json::object() {
  Json out;
  out.value_ = Object();
  return out;
}

bool Json::is_null() const {
  return std::holds_alternative<std::monostate>(value_);
}

bool Json::is_true() const {
  const auto* value = std::get_if<bool>(&value_);
  return value != nullptr && *value;
}

double Json::number() const {
  if (const auto* integer = std::get_if<std::int64_t>(&value_)) return static_cast<double>(*integer);
  if (const auto* natural = std::get_if<std::uint64_t>(&value_)) return static_cast<double>(*natural);
  return std::get<double>(value_);
}

const std::string& Json::text() const {
  return std::get<std::string>(value_);
}

std::size_t Json::size() const {
  if (const auto* array = std::get_if<Array>(&value_)) return array->size();
  if (const auto* object = std::get_if<Object>(&value_)) return object->size();
  return is_null() ? 0 : 1;
}

void Json::push_back(Json value) {
  if (is_null()) value_ = Array();
  std::get<Array>(value_).push_back(std::move(value));
}

const Json& Json::operator[](std::size_t index) const {
  return std::get<Array>(value_).at(index);
}

Json::Array::const_iterator Json::begin() const {
  return std::get<Array>(value_).begin();
}

Json::Array::const_iterator Json::end() const {
  return std::get<Array>(value_).end();
}

const Json::Object& Json::members() const {
  return std::get<Object>(value_);
}

const Json* Json::find(std::string_view name) const {
  const auto* object = std::get_if<Object>(&value_);
  if (object == nullptr) return nullptr;
  for (const auto& [member, value] : *object) {
    if (member == name) return &value;
  }
  return nullptr;
}

Json& Json::operator[](std::string_view name) {
  if (is_null()) value_ = Object();
  auto& object = std::get<Object>(value_);
  for (auto& [member, value] : object) {
    if (member == name) return value;
  }
  return object.emplace_back(std::string(name), Json()).second;
}

const Json& Json::operator[](std::string_view name) const {
  if (const Json* found = find(name)) return *found;
  throw std::out_of_range("no member with this name: " + std::string(name));
}

void Json::update(const Json& other) {
  for (const auto& [name, value] : other.members()) (*this)[name] = value;
}

void Json::erase(std::string_view name) {
  std::erase_if(std::get<Object>(value_), [&](const auto& member) { return member.first == name; });
}

/// Converts a value to one of nlohmann/json, and writes it as text.
struct JsonWriter {
  using Written = nlohmann::ordered_json;

  static Written of(const Json& json) {
    return std::visit([](const auto& value) { return of_value(value); }, json.value_);
  }
  static std::string text(const Json& json, int indent) {
    return of(json).dump(indent, ' ', false, Written::error_handler_t::replace);
  }

 private:
  static Written of_value(std::monostate /*null*/) { return nullptr; }
  template <class Value>
  static Written of_value(const Value& value) {
    return value;
  }
  static Written of_value(const Json::Array& values) {
    Written out = Written::array();
    out.get_ref<Written::array_t&>().reserve(values.size());
    for (const Json& value : values) out.push_back(of(value));
    return out;
  }
  static Written of_value(const Json::Object& members) {
    Written out = Written::object();
    // push_back without a search, because names are already unique.
    for (const auto& [name, value] : members) out.get_ref<Written::object_t&>().push_back({name, of(value)});
    return out;
  }
};

std::string Json::dump() const {
  return JsonWriter::text(*this, -1);
}

std::string Json::dump(int indent) const {
  return JsonWriter::text(*this, indent);
}

}  // namespace blum::cli
