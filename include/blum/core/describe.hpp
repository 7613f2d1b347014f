// Blum: what structs and enumerations hold, said once for all front ends. SPDX-License-Identifier: Apache-2.0
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

/// What a struct or an enumeration holds: specialised beside it. The tool's options, JSON, Python's options and
/// results, their types and documentation are made from this.
///
/// Of an enumeration:  static constexpr std::string_view name;
///                     static constexpr std::array values{NamedValue{value, "name"}, ...};
/// Of a struct:        static constexpr std::string_view name, doc;  // one sentence, without a full stop
///                     static constexpr std::tuple members{Member{...}, Fact{...}, ...};
/// All members of a struct, in their order; that none is missing is checked where they are visited.
template <class T>
struct Description;

/// The value of an enumeration, and its name on the command line, in Python and in files.
template <class Enum>
struct NamedValue {
  Enum value;
  std::string_view name;
};
template <class Enum>
NamedValue(Enum, const char*) -> NamedValue<Enum>;

/// Which numbers a member may hold.
struct Range {
  double least = -std::numeric_limits<double>::infinity();
  double most = std::numeric_limits<double>::infinity();
  bool above = false;  ///< whether `least` itself is left out

  [[nodiscard]] static constexpr Range positive() { return {0, std::numeric_limits<double>::infinity(), true}; }
  [[nodiscard]] static constexpr Range at_least(double least) { return {least}; }
  [[nodiscard]] static constexpr Range between(double least, double most) { return {least, most}; }
};

/// A member of a struct.
template <class Struct, class Type>
struct Member {
  std::string_view name;  ///< in Python, in JSON, and with dashes on the command line
  Type Struct::* pointer;
  std::string_view unit;               ///< such as "mesh units"; empty where there is none
  std::string_view doc;                ///< one line, without a full stop
  Range range = {};                    ///< of options that are numbers
  std::span<const Type> choices = {};  ///< of enumerations: what may be chosen; empty: all of it

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

/// What a struct tells of its members, shown as if it were one of them.
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

/// A list of types; lists are joined by +, which compilers do much faster than std::tuple_cat().
template <class... Types>
struct TypeList {};
template <class... Left, class... Right>
consteval TypeList<Left..., Right...> operator+(TypeList<Left...> /*left*/, TypeList<Right...> /*right*/) {
  return {};
}

template <class Entry>
using StoredType = std::conditional_t<Entry::is_stored, TypeList<typename Entry::Value>, TypeList<>>;

/// Whether a T can be made of exactly these, and of no more.
template <class T, class... Types>
consteval bool consists_of(TypeList<Types...> /*types*/) {
  return requires { T{std::declval<Types>()...}; } && !requires { T{std::declval<Types>()..., {}}; };
}

template <class T, class... Entries>
consteval bool is_described_by(const std::tuple<Entries...>& /*members*/) {
  return consists_of<T>((TypeList<>{} + ... + StoredType<Entries>{}));
}

/// @throws InvalidOption: `what` is 'text', but must be one of some names.
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

/// The name of a value of an enumeration.
template <DescribedEnum Enum>
[[nodiscard]] constexpr std::string_view to_string(Enum value) {
  for (const auto& named : Description<Enum>::values) {
    if (named.value == value) return named.name;
  }
  return "unknown";
}

/// The names of `choices`, or of all values where there are none.
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

/// The value with a name. @param what  what messages call it.  @param choices  as names_of().
/// @throws InvalidOption that names what may be chosen.
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

/// "a, b and c"; "or" by `last`. @param quote  around each word.
[[nodiscard]] std::string join_words(std::span<const std::string_view> words, std::string_view last = "and",
                                     std::string_view quote = {});

/// @throws InvalidOption where both are given: "`a` and `b` exclude each other: `reason`".
void exclude(bool has_first, std::string_view first, bool has_second, std::string_view second, std::string_view reason);

}  // namespace blum
