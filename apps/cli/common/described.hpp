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

/// Returns an object with the seconds of each phase. Durations of phases with the same name are added.
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

/// Converts values and described structs, including nested ones. An empty optional becomes null.
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

/// Returns the name of the option for a member: --site-ids for site_ids.
[[nodiscard]] std::string option_name(std::string_view member);
/// Parses the number of an option. @throws UsageError if it is outside of the described range.
[[nodiscard]] double number_in(const std::string& option, const std::string& text, const Range& range);
[[nodiscard]] std::int64_t integer_in(const std::string& option, const std::string& text, const Range& range);
/// If `step` is given, a text like `3v` means three steps. Other texts are parsed by number_in(). @throws UsageError.
[[nodiscard]] double length_in(const std::string& option, const std::string& text, const Range& range,
                               std::optional<double> step);

/// Option for a member of a described struct.
struct OptionMember {
  std::string_view name, unit, doc;
  bool is_flag = false;
  bool is_on = false;    ///< for a flag: its default
  std::string fallback;  ///< for other options: the default, as shown in the help
};

/// Part of OptionTexts<T> that does not depend on T.
class OptionTable {
 public:
  /// Adds an option for each member to a command. This object must not be moved until the command line has been read.
  /// @param prefix  text at the start of all help texts. @param left_out members without an option.
  /// @param in_steps  true if lengths may also be given in grid steps.
  void add_to(const Command& command, std::string_view prefix = {},
              std::initializer_list<std::string_view> left_out = {}, bool in_steps = false);

  [[nodiscard]] bool has(std::string_view member) const { return text_of(member) != nullptr; }
  /// Returns the names of the options on the command line, in the order of the members.
  [[nodiscard]] std::vector<std::string> given() const;

 protected:
  explicit OptionTable(std::vector<OptionMember> members) : members_(std::move(members)) {}
  /// Returns the text of a member's option; nullptr if the option is not given.
  [[nodiscard]] const std::string* text_of(std::string_view member) const;

 private:
  std::vector<OptionMember> members_;
  std::map<std::string, std::string, std::less<>> texts_;
};

/// Options for the members of a described struct. Enumerations are given as words, and numbers must be in their range.
/// A boolean is a flag, called `--no-NAME` if its default is true. A selection of voxels has no option.
template <DescribedStruct T>
class OptionTexts : public OptionTable {
 public:
  OptionTexts() : OptionTable(members()) {}

  /// Returns the struct. Members whose option is not given have their default.
  /// @param step  length of a grid step, if lengths may be given in steps.
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
