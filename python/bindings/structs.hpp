// Blum: described structs as Python sees them: options come as dicts, results are dataclasses. SPDX-License-Identifier:
// Apache-2.0
#pragma once

#include <nanobind/nanobind.h>
#include <nanobind/stl/string.h>

#include <array>
#include <cmath>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

#include "arrays.hpp"
#include "blum/core/describe.hpp"
#include "blum/core/ids.hpp"
#include "blum/core/phase_timer.hpp"
#include "blum/core/vec3.hpp"
#include "blum/grid/grid_spec.hpp"
#include "blum/grid/label_selection.hpp"

namespace blum::python {

namespace nb = nanobind;

/// The name of a member in Python, where some words are taken: `lambda` becomes `lambda_`.
[[nodiscard]] std::string python_name(std::string_view name);
/// An object of blum._structs. @param members  all of them.
[[nodiscard]] nb::object make_struct(std::string_view name, const nb::dict& members);
/// Seconds by phase; those of one name are added.
[[nodiscard]] nb::dict seconds_of(const std::vector<PhaseTime>& phases);
/// A blum.Grid, and the other way round. @throws nanobind::type_error.
[[nodiscard]] nb::object grid_of(const GridSpec& grid);
[[nodiscard]] GridSpec grid_from(nb::handle grid, const std::string& name);
/// Numbers as blum._arguments reads them, which raises errors that name them.
[[nodiscard]] double number_from(nb::handle value, const std::string& name);
[[nodiscard]] std::int64_t integer_from(nb::handle value, const std::string& name, int bits, bool is_unsigned);
[[nodiscard]] bool truth_from(nb::handle value, const std::string& name);
/// A word; what is no string stands as Python shows it.
[[nodiscard]] std::string word_from(nb::handle value);
/// @throws nanobind::type_error for a key that is none of the names.
void refuse_unknown(const nb::dict& given, const std::vector<std::string>& names);
/// Adds to what the module says of itself, for blum._structs and signatures.
void add_described(nb::module_& m, std::string_view name, std::string_view doc, bool is_options,
                   const nb::list& members);
[[nodiscard]] bool is_described(const nb::module_& m, std::string_view name);
/// What Python calls the type of an enumeration, whose values the module then lists.
[[nodiscard]] std::string enum_type(nb::module_& m, std::string_view name, const std::vector<std::string_view>& values,
                                    bool is_all);

template <class T>
struct IsVector : std::false_type {};
template <class T>
struct IsVector<std::vector<T>> : std::true_type {};
template <class T>
struct IsArray : std::false_type {};
template <class T, std::size_t count>
struct IsArray<std::array<T, count>> : std::true_type {};
template <class T>
struct IsId : std::false_type {};
template <class Tag>
struct IsId<Id<Tag>> : std::true_type {};
template <class T>
struct IsOptional : std::false_type {};
template <class T>
struct IsOptional<std::optional<T>> : std::true_type {};

/// Lists of numbers or vectors, which may be long: arrays of NumPy.
template <class T>
inline constexpr bool is_numbers = false;
template <class T>
inline constexpr bool is_numbers<std::vector<T>> =
    std::same_as<T, Vec3d> || std::same_as<T, double> || std::same_as<T, std::uint32_t>;

/// A copy that Python owns, read-only; ids as int32.
template <class T>
[[nodiscard]] nb::object array_of(const std::vector<T>& numbers) {
  if constexpr (std::same_as<T, Vec3d>) return nb::cast(handed_over<const double>(numbers, 3));
  if constexpr (std::same_as<T, double>) return nb::cast(handed_over<const double>(numbers));
  if constexpr (std::same_as<T, std::uint32_t>) return nb::cast(handed_over<const std::int32_t>(numbers));
}

template <class T>
[[nodiscard]] nb::object to_python(const T& value);

/// The members of a described struct by name; of a selection of voxels, what options_from() reads.
template <DescribedStruct T>
[[nodiscard]] nb::dict dict_of(const T& whole) {
  nb::dict out;
  for_each_member<T>([&]<class Entry>(const Entry& member) {
    if constexpr (std::same_as<typename Entry::Value, LabelSelection>) {
      using Rule = LabelSelection::Rule;
      const LabelSelection& chosen = member.of(whole);
      out["label"] = chosen.rule == Rule::label ? to_python(chosen.label) : nb::none();
      out["threshold"] = chosen.rule == Rule::threshold ? to_python(chosen.threshold) : nb::none();
    } else {
      out[python_name(member.name).c_str()] = to_python(member.of(whole));
    }
  });
  return out;
}

template <class T>
nb::object to_python(const T& value) {
  if constexpr (std::same_as<T, GridSpec>) {
    return grid_of(value);
  } else if constexpr (DescribedStruct<T>) {
    return make_struct(Description<T>::name, dict_of(value));
  } else if constexpr (DescribedEnum<T>) {
    return nb::cast(std::string(to_string(value)));
  } else if constexpr (IsOptional<T>::value) {
    return value ? to_python(*value) : nb::none();
  } else if constexpr (IsId<T>::value) {
    return nb::cast(value.to_file());
  } else if constexpr (std::same_as<T, Vec3d>) {
    return nb::make_tuple(value.x, value.y, value.z);
  } else if constexpr (std::same_as<T, Box3>) {
    if (value.is_empty()) return nb::none();
    return nb::make_tuple(to_python(value.lower), to_python(value.upper));
  } else if constexpr (std::same_as<T, std::vector<PhaseTime>>) {
    return seconds_of(value);
  } else if constexpr (is_numbers<T>) {
    return array_of(value);
  } else if constexpr (IsVector<T>::value || IsArray<T>::value) {
    nb::list all;
    for (const auto& part : value) all.append(to_python(part));
    return nb::tuple(all);
  } else {
    static_assert(std::is_arithmetic_v<T> || std::same_as<T, std::string>, "Python has no class for this type yet");
    return nb::cast(value);
  }
}

/// The same as the result of a function, whose type the package names.
template <class T>
[[nodiscard]] nb::any result_of(const T& value) {
  return nb::steal<nb::any>(to_python(value).release());
}

/// @param choices  of enumerations, as parse_enum() has them.
template <class T>
[[nodiscard]] T from_python(nb::handle value, const std::string& name, std::span<const T> choices = {}) {
  if constexpr (DescribedEnum<T>) {
    return parse_enum<T>(name, word_from(value), choices);
  } else if constexpr (IsOptional<T>::value) {
    return value.is_none() ? T{} : T{from_python<typename T::value_type>(value, name)};
  } else if constexpr (std::same_as<T, bool>) {
    return truth_from(value, name);
  } else if constexpr (std::integral<T>) {
    return static_cast<T>(integer_from(value, name, 8 * sizeof(T), std::unsigned_integral<T>));
  } else if constexpr (std::floating_point<T>) {
    return static_cast<T>(number_from(value, name));
  } else if constexpr (std::same_as<T, GridSpec>) {
    return grid_from(value, name);
  } else {
    return nb::cast<T>(value);
  }
}

/// Options of Python as a struct; what is not given keeps its default. A selection of voxels comes as `label` and
/// `threshold`. @throws InvalidOption, nanobind::type_error.
template <DescribedStruct T>
[[nodiscard]] T options_from(const nb::dict& given) {
  T out;
  std::vector<std::string> names;
  const auto value_of = [&](const std::string& name) -> nb::object {
    names.push_back(name);
    return given.contains(name.c_str()) ? nb::object(given[name.c_str()]) : nb::object();
  };
  for_each_member<T>([&]<class Entry>(const Entry& member) {
    using Value = typename Entry::Value;
    if constexpr (std::same_as<Value, LabelSelection>) {
      const nb::object label = value_of("label");
      const nb::object threshold = value_of("threshold");
      out.*member.pointer = LabelSelection::of(
          label.is_valid() ? from_python<std::optional<std::int64_t>>(label, "label") : std::nullopt,
          threshold.is_valid() ? from_python<std::optional<double>>(threshold, "threshold") : std::nullopt);
    } else if constexpr (Entry::is_stored) {
      const std::string name = python_name(member.name);
      const nb::object value = value_of(name);
      if (value.is_valid()) out.*member.pointer = from_python<Value>(value, name, member.choices);
    }
  });
  refuse_unknown(given, names);
  return out;
}

template <DescribedStruct T>
void bind_struct(nb::module_& m, bool is_options = false);

/// What Python calls a type. @param is_options  whether values go in, where NumPy's numbers will do, too.
template <class T>
[[nodiscard]] std::string type_name(nb::module_& m, bool is_options, std::span<const T> choices = {}) {
  if constexpr (DescribedEnum<T>) {
    return enum_type(m, Description<T>::name, names_of<T>(choices), choices.empty());
  } else if constexpr (std::same_as<T, GridSpec>) {
    return "Grid";
  } else if constexpr (DescribedStruct<T>) {
    if (!is_described(m, Description<T>::name)) bind_struct<T>(m);
    return std::string(Description<T>::name);
  } else if constexpr (IsOptional<T>::value) {
    return type_name<typename T::value_type>(m, is_options) + " | None";
  } else if constexpr (IsId<T>::value) {
    return "int";
  } else if constexpr (std::same_as<T, Vec3d>) {
    return "tuple[float, float, float]";
  } else if constexpr (std::same_as<T, Box3>) {
    return "Bounds | None";
  } else if constexpr (std::same_as<T, std::vector<PhaseTime>>) {
    return "dict[str, float]";
  } else if constexpr (is_numbers<T>) {
    return std::same_as<T, std::vector<std::uint32_t>> ? "IntArray" : "FloatArray";
  } else if constexpr (IsVector<T>::value) {
    return "tuple[" + type_name<typename T::value_type>(m, is_options) + ", ...]";
  } else if constexpr (IsArray<T>::value) {
    std::string parts;
    for (std::size_t i = 0; i < std::tuple_size_v<T>; ++i) {
      parts += (i > 0 ? ", " : "") + type_name<typename T::value_type>(m, is_options);
    }
    return "tuple[" + parts + "]";
  } else if constexpr (std::same_as<T, bool>) {
    return "bool";
  } else if constexpr (std::integral<T>) {
    return is_options ? "Integer" : "int";
  } else if constexpr (std::floating_point<T>) {
    return is_options ? "Real" : "float";
  } else {
    static_assert(std::same_as<T, std::string>, "Python has no name for this type yet");
    return "str";
  }
}

/// Makes a struct known to Python, and those that it consists of: results as a dataclass of blum._structs; options as a
/// typed dict there, and in the signatures of what takes them.
template <DescribedStruct T>
void bind_struct(nb::module_& m, bool is_options) {
  const T defaults{};
  nb::list members;
  const auto add = [&](const std::string& name, const std::string& type, const nb::object& value, std::string_view unit,
                       std::string_view doc) {
    members.append(nb::make_tuple(name, type, value, std::string(unit), std::string(doc)));
  };
  for_each_member<T>([&]<class Entry>(const Entry& member) {
    using Value = typename Entry::Value;
    if constexpr (std::same_as<Value, LabelSelection>) {
      add("label", "Integer | None", nb::none(), "", "images: the voxels of this value are the ones");
      add("threshold", "Real | None", nb::none(), "", "images: those of at least this value; excludes a label");
    } else {
      std::span<const Value> choices;
      if constexpr (Entry::is_stored) choices = member.choices;
      // Defaults are of options; results may hold what Python has a class for only once the package is there.
      nb::object value = nb::none();
      if (is_options) value = to_python(member.of(defaults));
      add(python_name(member.name), type_name<Value>(m, is_options, choices), value, member.unit, member.doc);
    }
  });
  add_described(m, Description<T>::name, Description<T>::doc, is_options, members);
}

template <DescribedStruct T>
void bind_options(nb::module_& m) {
  bind_struct<T>(m, true);
}

}  // namespace blum::python
