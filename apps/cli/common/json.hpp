// Blum: values of JSON. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <concepts>
#include <cstddef>
#include <cstdint>
#include <initializer_list>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <variant>
#include <vector>

namespace blum::cli {

class JsonItem;

/// JSON value: null, true or false, a number, a text, an array, or an object whose members keep their order. It is
/// written with nlohmann/json. Only json.cpp includes nlohmann/json, because its header takes longer to compile than a
/// command.
///
/// Values in braces form an object if each of them is a pair of a text and a value: {{"a", 1}, {"b", 2}}. Otherwise
/// they form an array.
// NOLINTBEGIN(google-explicit-constructor): values of JSON are made of what they hold, within braces too
class Json {
 public:
  using Array = std::vector<Json>;
  using Object = std::vector<std::pair<std::string, Json>>;

  Json() noexcept;
  Json(std::nullptr_t) noexcept : Json() {}
  template <std::same_as<bool> Value>
  Json(Value value) : Json(Exactly{}, static_cast<bool>(value)) {}
  template <std::floating_point Value>
  Json(Value value) : Json(Exactly{}, static_cast<double>(value)) {}
  template <std::signed_integral Value>
  Json(Value value) : Json(Exactly{}, static_cast<std::int64_t>(value)) {}
  template <std::unsigned_integral Value>
    requires(!std::same_as<Value, bool>)
  Json(Value value) : Json(Exactly{}, static_cast<std::uint64_t>(value)) {}
  Json(const char* text);
  Json(std::string text);
  Json(std::string_view text);
  /// Makes an array of the items.
  template <class Value>
    requires std::constructible_from<Json, const Value&>
  Json(const std::vector<Value>& values) : Json(array()) {
    for (const auto& value : values) push_back(Json(value));
  }
  Json(std::initializer_list<JsonItem> items);

  Json(const Json& other);
  Json(Json&& other) noexcept;
  Json& operator=(const Json& other);
  Json& operator=(Json&& other) noexcept;
  ~Json();

  [[nodiscard]] static Json array();
  /// Makes an array, even if all items are pairs.
  [[nodiscard]] static Json array(std::initializer_list<JsonItem> items);
  [[nodiscard]] static Json object();

  [[nodiscard]] bool is_null() const;
  [[nodiscard]] bool is_true() const;
  /// @throws std::bad_variant_access if the value is not a number. The functions below throw it likewise.
  [[nodiscard]] double number() const;
  [[nodiscard]] const std::string& text() const;

  // Functions for arrays and objects. Writing to null turns it into an array or an object.
  [[nodiscard]] bool empty() const { return size() == 0; }
  [[nodiscard]] std::size_t size() const;
  void push_back(Json value);
  [[nodiscard]] const Json& front() const { return (*this)[std::size_t{0}]; }
  [[nodiscard]] const Json& operator[](std::size_t index) const;
  [[nodiscard]] Array::const_iterator begin() const;
  [[nodiscard]] Array::const_iterator end() const;
  [[nodiscard]] const Object& members() const;
  /// Returns the member with this name, or nullptr if there is none.
  [[nodiscard]] const Json* find(std::string_view name) const;
  [[nodiscard]] bool contains(std::string_view name) const { return find(name) != nullptr; }
  /// Returns the member with this name. If there is none, adds it as null.
  [[nodiscard]] Json& operator[](std::string_view name);
  [[nodiscard]] const Json& operator[](std::string_view name) const;
  /// Sets members: adds or replaces all members of another object.
  void update(const Json& other);
  void erase(std::string_view name);

  /// Returns the value as text, on one line or on several indented lines. Invalid UTF-8 is replaced.
  [[nodiscard]] std::string dump() const;
  [[nodiscard]] std::string dump(int indent) const;

 private:
  friend struct JsonWriter;
  struct Exactly {};
  Json(Exactly /*tag*/, bool value);
  Json(Exactly /*tag*/, std::int64_t value);
  Json(Exactly /*tag*/, std::uint64_t value);
  Json(Exactly /*tag*/, double value);

  std::variant<std::monostate, bool, std::int64_t, std::uint64_t, double, std::string, Array, Object> value_;
};

/// Item in braces: a value, or nested braces. The value can be moved out of it, which initializer lists do not allow
/// for their elements.
class JsonItem {
 public:
  JsonItem(const char* text) : value_(text) {}
  template <class Value>
    requires(!std::is_array_v<std::remove_reference_t<Value>> && !std::same_as<std::remove_cvref_t<Value>, JsonItem> &&
             std::constructible_from<Json, Value>)
  JsonItem(Value&& value) : value_(std::forward<Value>(value)) {}
  JsonItem(std::initializer_list<JsonItem> items) : value_(items) {}

 private:
  friend class Json;
  mutable Json value_;
};
// NOLINTEND(google-explicit-constructor)

}  // namespace blum::cli
