// Conversion of numbers, texts, vectors, grids and arrays between Python and C++.
#include <nanobind/stl/string.h>

#include "arrays.hpp"
#include "structs.hpp"

namespace blum::python {
namespace {

/// Returns a function of blum._arguments. Errors of these functions name the argument.
nb::object argument(const char* function) {
  return nb::module_::import_("blum._arguments").attr(function);
}

}  // namespace

template <class T>
  requires std::is_arithmetic_v<T>
struct Values<T> {
  static nb::object to(const void* value) { return nb::cast(*static_cast<const T*>(value)); }
  static void from(void* value, nb::handle given, const std::string& name, const Choices& /*choices*/) {
    T& own = *static_cast<T*>(value);
    if constexpr (std::same_as<T, bool>) {
      own = nb::cast<bool>(argument("truth")(given, name));
    } else if constexpr (std::integral<T>) {
      // Unsigned numbers of 64 bits are limited to 63 bits, which is enough for seeds and counts.
      const char* const kind = std::unsigned_integral<T> ? "natural" : "integer";
      own = static_cast<T>(nb::cast<std::int64_t>(argument(kind)(given, name, static_cast<int>(8 * sizeof(T)))));
    } else {
      own = static_cast<T>(nb::cast<double>(argument("number")(given, name)));
    }
  }
  static std::string name(nb::module_& /*m*/, bool is_options, const Choices& /*choices*/) {
    if (std::same_as<T, bool>) return "bool";
    if (std::integral<T>) return is_options ? "Integer" : "int";
    return is_options ? "Real" : "float";
  }
};

template <>
struct Values<std::string> {
  static nb::object to(const void* value) { return nb::cast(*static_cast<const std::string*>(value)); }
  static void from(void* value, nb::handle given, const std::string& /*name*/, const Choices& /*choices*/) {
    *static_cast<std::string*>(value) = nb::cast<std::string>(given);
  }
  static std::string name(nb::module_& /*m*/, bool /*is_options*/, const Choices& /*choices*/) { return "str"; }
};

template <>
struct Values<Vec3d> {
  static nb::object to(const void* value) {
    const Vec3d& own = *static_cast<const Vec3d*>(value);
    return nb::make_tuple(own.x, own.y, own.z);
  }
  static std::string name(nb::module_& /*m*/, bool /*is_options*/, const Choices& /*choices*/) {
    return "tuple[float, float, float]";
  }
};

template <>
struct Values<Box3> {
  static nb::object to(const void* value) {
    const Box3& own = *static_cast<const Box3*>(value);
    if (own.is_empty()) return nb::none();
    return nb::make_tuple(to_python(own.lower), to_python(own.upper));
  }
  static std::string name(nb::module_& /*m*/, bool /*is_options*/, const Choices& /*choices*/) {
    return "Bounds | None";
  }
};

/// A blum.Grid.
template <>
struct Values<GridSpec> {
  static nb::object grid() { return nb::module_::import_("blum._grid").attr("Grid"); }
  static nb::object to(const void* value) { return grid().attr("_of")(*static_cast<const GridSpec*>(value)); }
  static void from(void* value, nb::handle given, const std::string& name, const Choices& /*choices*/) {
    if (!nb::isinstance(given, grid())) throw nb::type_error((name + " must be a blum.Grid").c_str());
    *static_cast<GridSpec*>(value) = nb::cast<GridSpec>(given.attr("_spec"));
  }
  static std::string name(nb::module_& /*m*/, bool /*is_options*/, const Choices& /*choices*/) { return "Grid"; }
};

template <>
struct Values<std::vector<PhaseTime>> {
  static nb::object to(const void* value) { return seconds_of(*static_cast<const std::vector<PhaseTime>*>(value)); }
  static std::string name(nb::module_& /*m*/, bool /*is_options*/, const Choices& /*choices*/) {
    return "dict[str, float]";
  }
};

/// Conversion of a list to a NumPy array.
/// @param Shown  type of the array's elements.
template <class T, class Shown, std::size_t width>
struct ArrayOf {
  static nb::object to(const void* value) {
    return nb::cast(handed_over<const Shown>(std::vector<T>(*static_cast<const std::vector<T>*>(value)), width));
  }
  static std::string name(nb::module_& /*m*/, bool /*is_options*/, const Choices& /*choices*/) {
    return std::integral<Shown> ? "IntArray" : "FloatArray";
  }
};

template <>
struct Values<std::vector<Vec3d>> : ArrayOf<Vec3d, double, 3> {};
template <>
struct Values<std::vector<double>> : ArrayOf<double, double, 0> {};
template <>
struct Values<std::vector<std::uint32_t>> : ArrayOf<std::uint32_t, std::int32_t, 0> {};

namespace {

template <class T>
constexpr ValueType read_and_written{&Values<T>::to, &Values<T>::from, &Values<T>::name};
template <class T>
constexpr ValueType only_written{&Values<T>::to, nullptr, &Values<T>::name};

}  // namespace

template <>
const ValueType& value_type<bool>() {
  return read_and_written<bool>;
}
template <>
const ValueType& value_type<int>() {
  return read_and_written<int>;
}
template <>
const ValueType& value_type<unsigned>() {
  return read_and_written<unsigned>;
}
template <>
const ValueType& value_type<long>() {
  return read_and_written<long>;
}
template <>
const ValueType& value_type<unsigned long>() {
  return read_and_written<unsigned long>;
}
template <>
const ValueType& value_type<long long>() {
  return read_and_written<long long>;
}
template <>
const ValueType& value_type<unsigned long long>() {
  return read_and_written<unsigned long long>;
}
template <>
const ValueType& value_type<float>() {
  return read_and_written<float>;
}
template <>
const ValueType& value_type<double>() {
  return read_and_written<double>;
}
template <>
const ValueType& value_type<std::string>() {
  return read_and_written<std::string>;
}
template <>
const ValueType& value_type<std::optional<double>>() {
  return read_and_written<std::optional<double>>;
}
template <>
const ValueType& value_type<GridSpec>() {
  return read_and_written<GridSpec>;
}
template <>
const ValueType& value_type<Vec3d>() {
  return only_written<Vec3d>;
}
template <>
const ValueType& value_type<Box3>() {
  return only_written<Box3>;
}
template <>
const ValueType& value_type<std::vector<PhaseTime>>() {
  return only_written<std::vector<PhaseTime>>;
}
template <>
const ValueType& value_type<std::vector<Vec3d>>() {
  return only_written<std::vector<Vec3d>>;
}
template <>
const ValueType& value_type<std::vector<double>>() {
  return only_written<std::vector<double>>;
}
template <>
const ValueType& value_type<std::vector<std::uint32_t>>() {
  return only_written<std::vector<std::uint32_t>>;
}

}  // namespace blum::python
