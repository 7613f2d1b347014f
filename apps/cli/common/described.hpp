// Blum: described structs as JSON and as options of the command line. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <initializer_list>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

#include "blum/core/describe.hpp"
#include "blum/core/exact_text.hpp"
#include "blum/core/ids.hpp"
#include "blum/core/phase_timer.hpp"
#include "blum/core/vec3.hpp"
#include "blum/grid/label_selection.hpp"
#include "common/command_line.hpp"
#include "common/json.hpp"

namespace blum::cli {

/// Returns seconds by phase. Phases of one name are added.
[[nodiscard]] Json to_json(const std::vector<PhaseTime>& phases);
[[nodiscard]] Json to_json(const Vec3d& v);
/// Returns null if the box is empty.
[[nodiscard]] Json to_json(const Box3& box);
[[nodiscard]] Json to_json(const Mat3& columns);
/// Returns -1 if the id is empty.
template <class Tag>
[[nodiscard]] Json to_json(const Id<Tag>& id) {
  return id.to_file();
}

/// Converts values of described structs and of their members. An empty optional becomes null.
template <class T>
  requires(DescribedStruct<T> || DescribedEnum<T> || std::is_arithmetic_v<T> || std::same_as<T, std::string>)
[[nodiscard]] Json to_json(const T& value);
template <class T>
[[nodiscard]] Json to_json(const std::optional<T>& value);
template <class T>
[[nodiscard]] Json to_json(const std::vector<T>& values);
template <class T, std::size_t count>
[[nodiscard]] Json to_json(const std::array<T, count>& values);

template <class T>
  requires(DescribedStruct<T> || DescribedEnum<T> || std::is_arithmetic_v<T> || std::same_as<T, std::string>)
Json to_json(const T& value) {
  if constexpr (DescribedStruct<T>) {
    Json json = Json::object();
    for_each_member<T>([&](const auto& member) { json[member.name] = to_json(member.of(value)); });
    return json;
  } else if constexpr (DescribedEnum<T>) {
    return to_string(value);
  } else {
    return value;
  }
}
template <class T>
Json to_json(const std::optional<T>& value) {
  return value ? to_json(*value) : Json(nullptr);
}
template <class T>
Json to_json(const std::vector<T>& values) {
  Json json = Json::array();
  for (const T& value : values) json.push_back(to_json(value));
  return json;
}
template <class T, std::size_t count>
Json to_json(const std::array<T, count>& values) {
  Json json = Json::array();
  for (const T& value : values) json.push_back(to_json(value));
  return json;
}

/// Returns the option of a member: --site-ids for site_ids.
[[nodiscard]] std::string option_name(std::string_view member);
/// Reads the number of an option. @throws UsageError if it is outside the range of the description.
[[nodiscard]] double number_in(const std::string& option, const std::string& text, const Range& range);
[[nodiscard]] std::int64_t integer_in(const std::string& option, const std::string& text, const Range& range);
/// Reads `3v` as three steps if `step` is given, other texts as number_in(). @throws UsageError.
[[nodiscard]] double length_in(const std::string& option, const std::string& text, const Range& range,
                               std::optional<double> step);

/// A member of a described struct as an option.
struct OptionMember {
  std::string_view name, unit, doc;
  bool is_flag = false;
  bool is_on = false;    ///< default of a flag
  std::string fallback;  ///< default of other options, for the help
};

/// The part of OptionTexts<T> that does not depend on T.
class OptionTable {
 public:
  /// Adds the members as options of a command. The object must keep its address until the command line is read.
  /// @param prefix  starts all help texts.  @param left_out  members without an option.
  /// @param in_steps  true if lengths may also be given in grid steps.
  void add_to(const Command& command, std::string_view prefix = {},
              std::initializer_list<std::string_view> left_out = {}, bool in_steps = false);

  [[nodiscard]] bool has(std::string_view member) const { return text_of(member) != nullptr; }
  /// Returns the names of the given options, in the order of the members.
  [[nodiscard]] std::vector<std::string> given() const;

 protected:
  explicit OptionTable(std::vector<OptionMember> members) : members_(std::move(members)) {}
  /// Returns nullptr if the option is not given.
  [[nodiscard]] const std::string* text_of(std::string_view member) const;

 private:
  std::vector<OptionMember> members_;
  std::map<std::string, std::string, std::less<>> texts_;
};

/// The members of a described struct as options of a command: words for enumerations, and numbers in their range. A
/// boolean is a flag, called `--no-NAME` if its default is true. A selection of voxels gets no option.
template <DescribedStruct T>
class OptionTexts : public OptionTable {
 public:
  OptionTexts() : OptionTable(members()) {}

  /// Returns the struct. Members without a given option keep their default.
  /// @param step  grid step, if lengths may be given in steps.
  /// @throws UsageError, InvalidOption.
  [[nodiscard]] T read(std::optional<double> step = {}) const {
    T out;
    for_each_option([&](const auto& member) {
      const std::string* text = text_of(member.name);
      if (text != nullptr) read_value(member, *text, step, out.*member.pointer);
    });
    return out;
  }

 private:
  template <class Visitor>
  static void for_each_option(const Visitor& visit) {
    for_each_member<T>([&]<class Entry>(const Entry& member) {
      if constexpr (Entry::is_stored && !std::same_as<typename Entry::Value, LabelSelection>) visit(member);
    });
  }

  static std::vector<OptionMember> members() {
    std::vector<OptionMember> out;
    const T defaults{};
    for_each_option([&]<class Entry>(const Entry& member) {
      OptionMember option;
      option.name = member.name;
      option.unit = member.unit;
      option.doc = member.doc;
      const auto& value = member.of(defaults);
      if constexpr (std::same_as<typename Entry::Value, bool>) {
        option.is_flag = true;
        option.is_on = value;
      } else {
        option.fallback = default_text(member, value);
      }
      out.push_back(std::move(option));
    });
    return out;
  }

  template <class Entry, class Value>
  static std::string default_text(const Entry& member, const Value& value) {
    if constexpr (DescribedEnum<Value>) {
      return join_words(names_of<Value>(member.choices), "or") + "; default " + std::string(to_string(value));
    } else if constexpr (std::floating_point<Value>) {
      return "default " + rounded_text(static_cast<double>(value));
    } else if constexpr (std::integral<Value>) {
      return "default " + std::to_string(value);
    } else {
      return {};
    }
  }

  template <class Entry, class Value>
  static void read_value(const Entry& member, const std::string& text, const std::optional<double>& step, Value& out) {
    const std::string name = option_name(member.name);
    if constexpr (DescribedEnum<Value>) {
      out = parse_enum<Value>(name, text, member.choices);
    } else if constexpr (std::same_as<Value, bool>) {
      out = !out;
    } else if constexpr (std::integral<Value>) {
      out = static_cast<Value>(integer_in(name, text, member.range));
    } else {
      out = length_in(name, text, member.range, member.unit == "mesh units" ? step : std::nullopt);
    }
  }
};

}  // namespace blum::cli
