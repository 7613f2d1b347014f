// Blum: described structs in Python, options as dicts and results as dataclasses. SPDX-License-Identifier: Apache-2.0
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

// These templates only make tables: of the members of a struct, and of the functions that convert their types. Ordinary
// functions of structs.cpp, which are compiled once, use the tables.
namespace blum::python {

namespace nb = nanobind;

/// Allowed values of an enumeration; empty: all of them. `first` points to the first one, of the enumeration's type.
struct Choices {
  const void* first = nullptr;
  std::size_t count = 0;
};

/// Conversion of the values of one C++ type to and from Python.
struct ValueType {
  nb::object (*to_python)(const void* value);
  /// Reads an option into `value`. nullptr for types that options do not have.
  /// @throws InvalidOption, nanobind::type_error: invalid value.
  void (*from_python)(void* value, nb::handle given, const std::string& name, const Choices& choices);
  /// Returns the name of the type in Python.
  /// @param is_options  true for inputs, which may also be NumPy's numbers.
  std::string (*type_name)(nb::module_& m, bool is_options, const Choices& choices);
};

/// Member of a described struct.
struct StructMember {
  std::string_view name;
  std::string_view unit;
  std::string_view doc;
  const ValueType* type = nullptr;  ///< nullptr for a selection of voxels: `label` and `threshold` in Python.
  Choices choices;
  std::size_t offset = 0;  ///< Bytes from the start of the struct, for stored members.
  /// Reads a fact from a struct; nullptr for stored members.
  nb::object (*read)(const void* fact, const void* whole) = nullptr;
  const void* fact = nullptr;

  [[nodiscard]] nb::object of(const void* whole) const;
};

/// Described struct.
struct StructType {
  std::string_view name;
  std::string_view doc;
  const void* defaults;  ///< A default-constructed struct.
  std::vector<StructMember> members;
};

/// Returns an object of blum._structs with the values of a struct.
[[nodiscard]] nb::object struct_of(const StructType& type, const void* whole);
/// Returns the members of a struct by name.
[[nodiscard]] nb::dict members_of(const StructType& type, const void* whole);
/// Sets the members that are given. A selection of voxels is given as `label` and `threshold`.
/// @throws InvalidOption, nanobind::type_error: invalid value; type_error also if a key is not a member.
void read_members(const StructType& type, const nb::dict& given, void* whole);
/// Adds a struct to `described` of the module, from which blum._structs and signatures are made. The structs that it
/// consists of are added before it.
/// @param is_options  true for a typed dict with defaults, false for a dataclass.
void bind_members(nb::module_& m, const StructType& type, bool is_options);
/// Returns the name of a struct as a type, and binds the struct if it is not bound yet.
[[nodiscard]] std::string struct_name(nb::module_& m, const StructType& type);

[[nodiscard]] nb::object word(std::string_view text);
/// Returns a string as it is, and any other value as Python's repr().
[[nodiscard]] std::string word_from(nb::handle value);
/// Returns seconds by phase. Phases of the same name are added up.
[[nodiscard]] nb::dict seconds_of(const std::vector<PhaseTime>& phases);
/// Returns a tuple of the entries of a list.
/// @param size  bytes of each entry.
[[nodiscard]] nb::object tuple_of(const ValueType& type, const void* first, std::size_t count, std::size_t size);
/// Returns the type of a tuple, for example "tuple[int, int]".
[[nodiscard]] std::string tuple_name(nb::module_& m, const ValueType& type, std::size_t count, bool is_options);
/// Returns the type of an enumeration in Python: its name if `is_all`, else a Literal of its allowed values. The module
/// lists the values of the named ones.
[[nodiscard]] std::string enum_type(nb::module_& m, std::string_view name, const std::vector<std::string_view>& values,
                                    bool is_all);

template <class T>
[[nodiscard]] const ValueType& value_type();
template <DescribedStruct T>
[[nodiscard]] const StructType& struct_type();

/// Functions of a type for ValueType. `from` exists only if options may have the type. The specialisations for numbers,
/// texts and arrays are in value_types.cpp.
template <class T>
struct Values;
/// True if options may have members of a type.
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
/// Lists of numbers or vectors may be long. They become NumPy arrays: copies that Python owns, with ids as int32.
template <>
const ValueType& value_type<std::vector<Vec3d>>();
template <>
const ValueType& value_type<std::vector<double>>();
template <>
const ValueType& value_type<std::vector<std::uint32_t>>();
template <>
const ValueType& value_type<std::optional<double>>();

/// Appends a stored member, or a fact that is read by a function.
void add_member(StructType& type, const std::string_view& name, const std::string_view& unit,
                const std::string_view& doc, const ValueType* value, const Choices& choices, std::size_t offset);
void add_fact(StructType& type, const std::string_view& name, const std::string_view& unit, const std::string_view& doc,
              const ValueType* value, nb::object (*read)(const void* fact, const void* whole), const void* fact);

/// Appends an entry of a description.
/// @param example  any struct of the type.
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

/// Returns the same as to_python(), for results of functions. The package states their types.
template <class T>
[[nodiscard]] nb::any result_of(const T& value) {
  return nb::steal<nb::any>(to_python(value).release());
}

/// Returns the members of a described struct by name; for a selection of voxels, the keys that options_from() reads.
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

/// Returns options from Python as a struct. Members that are not given keep their defaults.
/// @throws InvalidOption, nanobind::type_error: as read_members().
template <DescribedStruct T>
[[nodiscard]] T options_from(const nb::dict& given) {
  static_assert(has_option_values<T>(), "options have a member of a type that is not read from Python yet");
  T out;
  read_members(struct_type<T>(), given, &out);
  return out;
}

/// Returns the name of a result's type in Python, and registers the type there.
template <class T>
[[nodiscard]] std::string type_name(nb::module_& m) {
  return value_type<T>().type_name(m, false, {});
}

/// Registers a struct, and the structs that it consists of, as dataclasses of blum._structs.
template <DescribedStruct T>
void bind_struct(nb::module_& m) {
  bind_members(m, struct_type<T>(), false);
}

/// Registers options as a typed dict of blum._structs. It also appears in the signatures of functions that take the
/// options.
template <DescribedStruct T>
void bind_options(nb::module_& m) {
  bind_members(m, struct_type<T>(), true);
}

}  // namespace blum::python
