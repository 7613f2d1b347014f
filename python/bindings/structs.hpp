// Blum: described structs as Python sees them: options come as dicts, results are dataclasses. SPDX-License-Identifier:
// Apache-2.0
#pragma once

#include <nanobind/nanobind.h>

#include <array>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <tuple>
#include <type_traits>
#include <vector>

#include "blum/core/describe.hpp"
#include "blum/core/ids.hpp"
#include "blum/core/phase_timer.hpp"
#include "blum/core/vec3.hpp"
#include "blum/grid/grid_spec.hpp"
#include "blum/grid/label_selection.hpp"

// Templates here only make tables, of the members of a struct and of how Python sees their types. What is done with
// them is ordinary functions of structs.cpp, compiled once.
namespace blum::python {

namespace nb = nanobind;

/// Values of an enumeration that may be chosen; none: all of it. `first` is one of the type that they are of.
struct Choices {
  const void* first = nullptr;
  std::size_t count = 0;
};

/// How Python sees the values of one type of C++.
struct ValueType {
  nb::object (*to_python)(const void* value);
  /// Reads an option into `value`; nullptr for types that no options have. @throws InvalidOption, nanobind::type_error.
  void (*from_python)(void* value, nb::handle given, const std::string& name, const Choices& choices);
  /// What Python calls it. @param is_options  whether values go in, where NumPy's numbers will do, too.
  std::string (*type_name)(nb::module_& m, bool is_options, const Choices& choices);
};

/// A member of a described struct.
struct StructMember {
  std::string_view name;
  std::string_view unit;
  std::string_view doc;
  const ValueType* type = nullptr;  ///< nullptr for a selection of voxels, which Python has as `label` and `threshold`
  Choices choices;
  std::size_t offset = 0;  ///< of what is stored
  /// Of facts: asks a struct for it.
  nb::object (*read)(const void* fact, const void* whole) = nullptr;
  const void* fact = nullptr;

  [[nodiscard]] nb::object of(const void* whole) const;
};

/// A described struct.
struct StructType {
  std::string_view name;
  std::string_view doc;
  const void* defaults;  ///< one that is as it is made
  std::vector<StructMember> members;
};

/// An object of blum._structs with what a struct holds; its members by name.
[[nodiscard]] nb::object struct_of(const StructType& type, const void* whole);
[[nodiscard]] nb::dict members_of(const StructType& type, const void* whole);
/// Sets the members that are given; a selection of voxels comes as `label` and `threshold`.
/// @throws InvalidOption, nanobind::type_error, for a key that is no member, too.
void read_members(const StructType& type, const nb::dict& given, void* whole);
/// Adds a struct to what the module says of itself, for blum._structs and signatures, and the structs that it consists
/// of before it. @param is_options  a typed dict with defaults; else a dataclass.
void bind_members(nb::module_& m, const StructType& type, bool is_options);
/// The name of a struct as a type, which is bound where it is not yet.
[[nodiscard]] std::string struct_name(nb::module_& m, const StructType& type);

[[nodiscard]] nb::object word(std::string_view text);
/// A word; what is no string stands as Python shows it.
[[nodiscard]] std::string word_from(nb::handle value);
/// Seconds by phase; those of one name are added.
[[nodiscard]] nb::dict seconds_of(const std::vector<PhaseTime>& phases);
/// A tuple of the entries of a list. @param size  bytes of each.
[[nodiscard]] nb::object tuple_of(const ValueType& type, const void* first, std::size_t count, std::size_t size);
/// "tuple[int, int]".
[[nodiscard]] std::string tuple_name(nb::module_& m, const ValueType& type, std::size_t count, bool is_options);
/// What Python calls the type of an enumeration, whose values the module then lists.
[[nodiscard]] std::string enum_type(nb::module_& m, std::string_view name, const std::vector<std::string_view>& values,
                                    bool is_all);

template <class T>
[[nodiscard]] const ValueType& value_type();
template <DescribedStruct T>
[[nodiscard]] const StructType& struct_type();

/// A type's functions for ValueType; `from` only where options may have it. What it is not specialised for here is in
/// value_types.cpp: numbers, texts, arrays.
template <class T>
struct Values;
/// Whether options may have members of a type.
template <class T>
inline constexpr bool is_option_value =
    std::is_arithmetic_v<T> || std::same_as<T, std::string> || std::same_as<T, GridSpec> || DescribedEnum<T>;
template <class T>
inline constexpr bool is_option_value<std::optional<T>> = is_option_value<T>;

template <DescribedEnum T>
struct Values<T> {
  static nb::object to(const void* value) { return word(to_string(*static_cast<const T*>(value))); }
  static std::span<const T> chosen(const Choices& choices) {
    return {static_cast<const T*>(choices.first), choices.count};
  }
  static void from(void* value, nb::handle given, const std::string& name, const Choices& choices) {
    *static_cast<T*>(value) = parse_enum<T>(name, word_from(given), chosen(choices));
  }
  static std::string name(nb::module_& m, bool /*is_options*/, const Choices& choices) {
    return enum_type(m, Description<T>::name, names_of<T>(chosen(choices)), choices.count == 0);
  }
};

template <DescribedStruct T>
struct Values<T> {
  static nb::object to(const void* value) { return struct_of(struct_type<T>(), value); }
  static std::string name(nb::module_& m, bool /*is_options*/, const Choices& /*choices*/) {
    return struct_name(m, struct_type<T>());
  }
};

template <class T>
struct Values<std::optional<T>> {
  static nb::object to(const void* value) {
    const auto& own = *static_cast<const std::optional<T>*>(value);
    return own ? value_type<T>().to_python(&*own) : nb::none();
  }
  static void from(void* value, nb::handle given, const std::string& name, const Choices& /*choices*/)
    requires is_option_value<T>
  {
    std::optional<T> own;
    if (!given.is_none()) value_type<T>().from_python(&own.emplace(), given, name, {});
    *static_cast<std::optional<T>*>(value) = own;
  }
  static std::string name(nb::module_& m, bool is_options, const Choices& /*choices*/) {
    return value_type<T>().type_name(m, is_options, {}) + " | None";
  }
};

template <class Tag>
struct Values<Id<Tag>> {
  static nb::object to(const void* value) {
    const std::int32_t number = static_cast<const Id<Tag>*>(value)->to_file();
    return value_type<std::int32_t>().to_python(&number);
  }
  static std::string name(nb::module_& /*m*/, bool /*is_options*/, const Choices& /*choices*/) { return "int"; }
};

template <class T>
struct Values<std::vector<T>> {
  static nb::object to(const void* value) {
    const auto& own = *static_cast<const std::vector<T>*>(value);
    return tuple_of(value_type<T>(), own.data(), own.size(), sizeof(T));
  }
  static std::string name(nb::module_& m, bool is_options, const Choices& /*choices*/) {
    return "tuple[" + value_type<T>().type_name(m, is_options, {}) + ", ...]";
  }
};

template <class T, std::size_t count>
struct Values<std::array<T, count>> {
  static nb::object to(const void* value) { return tuple_of(value_type<T>(), value, count, sizeof(T)); }
  static std::string name(nb::module_& m, bool is_options, const Choices& /*choices*/) {
    return tuple_name(m, value_type<T>(), count, is_options);
  }
};

template <class T>
const ValueType& value_type() {
  if constexpr (is_option_value<T>) {
    static constexpr ValueType type{&Values<T>::to, &Values<T>::from, &Values<T>::name};
    return type;
  } else {
    static constexpr ValueType type{&Values<T>::to, nullptr, &Values<T>::name};
    return type;
  }
}

template <>
const ValueType& value_type<bool>();
template <>
const ValueType& value_type<int>();
template <>
const ValueType& value_type<unsigned>();
template <>
const ValueType& value_type<long>();
template <>
const ValueType& value_type<unsigned long>();
template <>
const ValueType& value_type<long long>();
template <>
const ValueType& value_type<unsigned long long>();
template <>
const ValueType& value_type<float>();
template <>
const ValueType& value_type<double>();
template <>
const ValueType& value_type<std::string>();
template <>
const ValueType& value_type<Vec3d>();
template <>
const ValueType& value_type<Box3>();
template <>
const ValueType& value_type<GridSpec>();
template <>
const ValueType& value_type<std::vector<PhaseTime>>();
/// Lists of numbers or vectors, which may be long, are arrays of NumPy: copies that Python owns, ids as int32.
template <>
const ValueType& value_type<std::vector<Vec3d>>();
template <>
const ValueType& value_type<std::vector<double>>();
template <>
const ValueType& value_type<std::vector<std::uint32_t>>();
template <>
const ValueType& value_type<std::optional<double>>();

/// Appends a member that is stored, or one that a struct is asked for.
void add_member(StructType& type, const std::string_view& name, const std::string_view& unit,
                const std::string_view& doc, const ValueType* value, const Choices& choices, std::size_t offset);
void add_fact(StructType& type, const std::string_view& name, const std::string_view& unit, const std::string_view& doc,
              const ValueType* value, nb::object (*read)(const void* fact, const void* whole), const void* fact);

/// Appends an entry of a description. @param example  any struct of its kind.
template <class T, class Type>
void add_entry(StructType& type, const Member<T, Type>& entry, const T& example) {
  const ValueType* value = nullptr;
  if constexpr (!std::same_as<Type, LabelSelection>) value = &value_type<Type>();
  const auto offset =
      reinterpret_cast<const std::byte*>(&(example.*entry.pointer)) - reinterpret_cast<const std::byte*>(&example);
  add_member(type, entry.name, entry.unit, entry.doc, value, {entry.choices.data(), entry.choices.size()},
             static_cast<std::size_t>(offset));
}
template <class T, class Type>
void add_entry(StructType& type, const Fact<T, Type>& entry, const T& /*example*/) {
  const auto read = [](const void* fact, const void* whole) {
    const Type value = static_cast<const Fact<T, Type>*>(fact)->of(*static_cast<const T*>(whole));
    return value_type<Type>().to_python(&value);
  };
  add_fact(type, entry.name, entry.unit, entry.doc, &value_type<Type>(), read, &entry);
}

template <DescribedStruct T>
const StructType& struct_type() {
  static const T example{};
  static const StructType type = [] {
    StructType out{Description<T>::name, Description<T>::doc, &example, {}};
    for_each_member<T>([&](const auto& entry) { add_entry(out, entry, example); });
    return out;
  }();
  return type;
}

template <class T>
[[nodiscard]] nb::object to_python(const T& value) {
  return value_type<T>().to_python(&value);
}

/// The same as the result of a function, whose type the package names.
template <class T>
[[nodiscard]] nb::any result_of(const T& value) {
  return nb::steal<nb::any>(to_python(value).release());
}

/// The members of a described struct by name; of a selection of voxels, what options_from() reads.
template <DescribedStruct T>
[[nodiscard]] nb::dict dict_of(const T& whole) {
  return members_of(struct_type<T>(), &whole);
}

template <DescribedStruct T>
consteval bool has_option_values() {
  return std::apply(
      []<class... Entries>(const Entries&...) {
        return ((!Entries::is_stored || std::same_as<typename Entries::Value, LabelSelection> ||
                 is_option_value<typename Entries::Value>) &&
                ...);
      },
      Description<T>::members);
}

/// Options of Python as a struct; what is not given keeps its default. @throws InvalidOption, nanobind::type_error.
template <DescribedStruct T>
[[nodiscard]] T options_from(const nb::dict& given) {
  static_assert(has_option_values<T>(), "options have a member of a type that is not read from Python yet");
  T out;
  read_members(struct_type<T>(), given, &out);
  return out;
}

/// What Python calls the type of a result; makes it known to Python.
template <class T>
[[nodiscard]] std::string type_name(nb::module_& m) {
  return value_type<T>().type_name(m, false, {});
}

/// Makes a struct known to Python, and those that it consists of: as a dataclass of blum._structs.
template <DescribedStruct T>
void bind_struct(nb::module_& m) {
  bind_members(m, struct_type<T>(), false);
}

/// The same for options: as a typed dict there, and in the signatures of what takes them.
template <DescribedStruct T>
void bind_options(nb::module_& m) {
  bind_members(m, struct_type<T>(), true);
}

}  // namespace blum::python
