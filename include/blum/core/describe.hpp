// Blum: descriptions of structs and enumerations, shared by all front ends. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <limits>
#include <span>
#include <string>
#include <string_view>
#include <tuple>
#include <type_traits>
#include <utility>
#include <vector>

#include "blum/core/error.hpp"

namespace blum {

/// Description of a struct or an enumeration. Each specialisation is declared next to the type that it describes. The
/// command-line options, the JSON output, and the options and results in Python are generated from descriptions, with
/// types and documentation.
///
/// An enumeration:  static constexpr std::string_view name;
///                  static constexpr std::array values{NamedValue{value, "name"}, ...};
///
/// A struct:        static constexpr std::string_view name, doc;  // one sentence, without a full stop
///                  static constexpr std::tuple members{Member{...}, Fact{...}, ...};
///
/// The description of a struct must list all members in their order. The function for_each_member() checks at compile
/// time that no member is missing.
template <class T>
struct Description;

/// Value of an enumeration, with its name on the command line, in Python and in files.
template <class Enum>
struct NamedValue {
  Enum value;
  std::string_view name;
};
template <class Enum>
NamedValue(Enum, const char*) -> NamedValue<Enum>;

/// Range of the numbers that a member may hold.
struct Range {
  double least = -std::numeric_limits<double>::infinity();
  double most = std::numeric_limits<double>::infinity();
  bool above = false;  ///< true if `least` itself is excluded

  [[nodiscard]] static constexpr Range positive() { return {0, std::numeric_limits<double>::infinity(), true}; }
  [[nodiscard]] static constexpr Range at_least(double least) { return {least}; }
  [[nodiscard]] static constexpr Range between(double least, double most) { return {least, most}; }
};

/// Member of a struct.
template <class Struct, class Type>
struct Member {
  std::string_view name;  ///< name in Python and JSON; on the command line, dashes replace its underscores
  Type Struct::* pointer;
  std::string_view unit;               ///< for example "mesh units"; empty if the member has no unit
  std::string_view doc;                ///< one line, without a full stop
  Range range = {};                    ///< allowed range of a numeric option
  std::span<const Type> choices = {};  ///< allowed values of an enumeration; if empty, all values

  using Value = Type;
  static constexpr bool is_stored = true;
  [[nodiscard]] constexpr const Type& of(const Struct& whole) const { return whole.*pointer; }
};
template <class Struct, class Type>
Member(const char*, Type Struct::*, const char*, const char*) -> Member<Struct, Type>;
template <class Struct, class Type>
Member(const char*, Type Struct::*, const char*, const char*, Range) -> Member<Struct, Type>;
template <class Struct, class Type, class Choices>
Member(const char*, Type Struct::*, const char*, const char*, Range, const Choices&) -> Member<Struct, Type>;

/// Value that a member function of a struct computes. Outputs show this value like a member.
template <class Struct, class Type>
struct Fact {
  std::string_view name;
  Type (Struct::*function)() const;
  std::string_view unit;
  std::string_view doc;

  using Value = Type;
  static constexpr bool is_stored = false;
  [[nodiscard]] constexpr Type of(const Struct& whole) const { return (whole.*function)(); }
};
template <class Struct, class Type>
Fact(const char*, Type (Struct::*)() const, const char*, const char*) -> Fact<Struct, Type>;

template <class T>
concept DescribedEnum = std::is_enum_v<T> && requires { Description<T>::values; };
template <class T>
concept DescribedStruct = requires { Description<T>::members; };

namespace detail {

/// List of types. Compilers evaluate + of two lists much faster than std::tuple_cat() of tuples.
template <class... Types>
struct TypeList {};
template <class... Left, class... Right>
consteval TypeList<Left..., Right...> operator+(TypeList<Left...> /*left*/, TypeList<Right...> /*right*/) {
  return {};
}

template <class Entry>
using StoredType = std::conditional_t<Entry::is_stored, TypeList<typename Entry::Value>, TypeList<>>;

/// Returns true if a T can be initialised from one value of each of these types, and from no additional value.
template <class T, class... Types>
consteval bool consists_of(TypeList<Types...> /*types*/) {
  return requires { T{std::declval<Types>()...}; } && !requires { T{std::declval<Types>()..., {}}; };
}

template <class T, class... Entries>
consteval bool is_described_by(const std::tuple<Entries...>& /*members*/) {
  return consists_of<T>((TypeList<>{} + ... + StoredType<Entries>{}));
}

/// @throws InvalidOption with the message that `what` is `text`, but must be one of `names`.
[[noreturn]] void refuse_choice(std::string_view what, std::string_view text, std::span<const std::string_view> names);

}  // namespace detail

/// Calls visit(entry) with each Member and Fact of a struct, in their order.
template <DescribedStruct T, class Visitor>
constexpr void for_each_member(const Visitor& visit) {
  static_assert(detail::is_described_by<T>(Description<T>::members),
                "Description<T>::members must name every member of T, in their order");
  constexpr std::size_t count = std::tuple_size_v<std::remove_cvref_t<decltype(Description<T>::members)>>;
  [&]<std::size_t... k>(std::index_sequence<k...>) {
    (visit(std::get<k>(Description<T>::members)), ...);
  }(std::make_index_sequence<count>{});
}

/// Returns the name of a value of an enumeration; "unknown" if it has none.
template <DescribedEnum Enum>
[[nodiscard]] constexpr std::string_view to_string(Enum value) {
  for (const auto& named : Description<Enum>::values) {
    if (named.value == value) return named.name;
  }
  return "unknown";
}

/// Returns the names of `choices`, or of all values if `choices` is empty.
template <DescribedEnum Enum>
[[nodiscard]] std::vector<std::string_view> names_of(std::span<const Enum> choices = {}) {
  std::vector<std::string_view> names;
  if (choices.empty()) {
    for (const auto& named : Description<Enum>::values) names.push_back(named.name);
  } else {
    for (const Enum choice : choices) names.push_back(to_string(choice));
  }
  return names;
}

/// Returns the value of an enumeration whose name is `text`.
/// @param what     name of the option in messages.
/// @param choices  as for names_of().
/// @throws InvalidOption if the name is not allowed. The message lists the allowed names.
template <DescribedEnum Enum>
[[nodiscard]] Enum parse_enum(std::string_view what, std::string_view text, std::span<const Enum> choices = {}) {
  const std::vector<std::string_view> names = names_of<Enum>(choices);
  for (const auto& named : Description<Enum>::values) {
    for (const std::string_view name : names) {
      if (name == text && name == named.name) return named.value;
    }
  }
  detail::refuse_choice(what, text, names);
}

/// Returns the words as one text: "a, b and c", with `last` instead of "and". @param quote  is put around each word.
[[nodiscard]] std::string join_words(std::span<const std::string_view> words, std::string_view last = "and",
                                     std::string_view quote = {});

/// @throws InvalidOption if both options are given, with the message "`first` and `second` exclude each other:
/// `reason`".
void exclude(bool has_first, std::string_view first, bool has_second, std::string_view second, std::string_view reason);

}  // namespace blum
