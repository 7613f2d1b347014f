#include "structs.hpp"

#include <nanobind/stl/array.h>
#include <nanobind/stl/vector.h>

#include <algorithm>

namespace blum::python {

std::string python_name(std::string_view name) {
  return name == "lambda" ? "lambda_" : std::string(name);
}

nb::object make_struct(std::string_view name, const nb::dict& members) {
  return nb::module_::import_("blum._structs").attr(std::string(name).c_str())(**members);
}

nb::dict seconds_of(const std::vector<PhaseTime>& phases) {
  nb::dict out;
  for (const PhaseTime& phase : phases) {
    const char* const name = phase.phase.c_str();
    const double before = out.contains(name) ? nb::cast<double>(out[name]) : 0.0;
    out[name] = before + phase.seconds;
  }
  return out;
}

nb::object grid_of(const GridSpec& grid) {
  return nb::module_::import_("blum._grid").attr("Grid").attr("_of")(grid);
}

GridSpec grid_from(nb::handle grid, const std::string& name) {
  const nb::object type = nb::module_::import_("blum._grid").attr("Grid");
  if (!nb::isinstance(grid, type)) {
    throw nb::type_error((name + " must be a blum.Grid").c_str());
  }
  return nb::cast<GridSpec>(grid.attr("_spec"));
}

double number_from(nb::handle value, const std::string& name) {
  return nb::cast<double>(nb::module_::import_("blum._arguments").attr("number")(value, name));
}

std::int64_t integer_from(nb::handle value, const std::string& name, int bits, bool is_unsigned) {
  // Of 64 bits without a sign those of 63 are taken, which are enough for seeds and counts.
  const char* kind = is_unsigned ? "natural" : "integer";
  return nb::cast<std::int64_t>(nb::module_::import_("blum._arguments").attr(kind)(value, name, bits));
}

bool truth_from(nb::handle value, const std::string& name) {
  return nb::cast<bool>(nb::module_::import_("blum._arguments").attr("truth")(value, name));
}

std::string word_from(nb::handle value) {
  return nb::cast<std::string>(nb::isinstance<nb::str>(value) ? nb::str(value) : nb::repr(value));
}

void refuse_unknown(const nb::dict& given, const std::vector<std::string>& names) {
  for (const auto& [key, value] : given) {
    const auto name = nb::cast<std::string>(key);
    if (std::find(names.begin(), names.end(), name) != names.end()) continue;
    const std::vector<std::string_view> words(names.begin(), names.end());
    throw nb::type_error(("there is no option '" + name + "': there are " + join_words(words)).c_str());
  }
}

void add_described(nb::module_& m, std::string_view name, std::string_view doc, bool is_options,
                   const nb::list& members) {
  nb::dict entry;
  entry["doc"] = std::string(doc);
  entry["is_options"] = is_options;
  entry["members"] = members;
  nb::cast<nb::dict>(m.attr("described"))[std::string(name).c_str()] = entry;
}

bool is_described(const nb::module_& m, std::string_view name) {
  return nb::cast<nb::dict>(m.attr("described")).contains(std::string(name).c_str());
}

std::string enum_type(nb::module_& m, std::string_view name, const std::vector<std::string_view>& values, bool is_all) {
  if (!is_all) {
    std::string words;
    for (const std::string_view value : values) words += (words.empty() ? "'" : ", '") + std::string(value) + "'";
    return "Literal[" + words + "]";
  }
  nb::list all;
  for (const std::string_view value : values) all.append(std::string(value));
  nb::cast<nb::dict>(m.attr("enums"))[std::string(name).c_str()] = nb::tuple(all);
  return std::string(name);
}

}  // namespace blum::python
