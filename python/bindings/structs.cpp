#include "structs.hpp"

#include <nanobind/stl/string.h>

#include <algorithm>
#include <utility>

#include "blum/core/error.hpp"

namespace blum::python {
namespace {

/// Returns the name of a member in Python. The reserved word `lambda` becomes `lambda_`.
std::string python_name(std::string_view name) {
  return name == "lambda" ? "lambda_" : std::string(name);
}

/// Returns the address of a stored member.
const void* place_in(const void* whole, const StructMember& member) {
  return static_cast<const std::byte*>(whole) + member.offset;
}
void* place_in(void* whole, const StructMember& member) {
  return static_cast<std::byte*>(whole) + member.offset;
}

/// Values given by name. take() returns an invalid object if nothing was given.
class Given {
 public:
  explicit Given(const nb::dict& values) : values_(&values) {}

  [[nodiscard]] nb::object take(std::string_view name) {
    const std::string& key = names_.emplace_back(name);
    return values_->contains(key.c_str()) ? nb::object((*values_)[key.c_str()]) : nb::object();
  }
  /// @throws nanobind::type_error if a key was not taken.
  void refuse_others() const {
    for (const auto& [key, value] : *values_) {
      const auto name = nb::cast<std::string>(key);
      if (std::find(names_.begin(), names_.end(), name) != names_.end()) continue;
      const std::vector<std::string_view> words(names_.begin(), names_.end());
      throw nb::type_error(("there is no option '" + name + "': there are " + join_words(words)).c_str());
    }
  }

 private:
  const nb::dict* values_;
  std::vector<std::string> names_;
};

template <class T>
std::optional<T> number_of(const nb::object& value, const char* name) {
  std::optional<T> number;
  if (value.is_valid()) value_type<std::optional<T>>().from_python(&number, value, name, {});
  return number;
}

LabelSelection selection_from(Given& given) {
  const nb::object label = given.take("label");
  const nb::object threshold = given.take("threshold");
  const auto number = number_of<std::int64_t>(label, "label");
  return LabelSelection::of(number, number_of<double>(threshold, "threshold"));
}

bool is_described(const nb::module_& m, std::string_view name) {
  return nb::cast<nb::dict>(m.attr("described")).contains(std::string(name).c_str());
}

/// Returns the description of a member, as the module lists it.
/// @param type  name of the member's type.
nb::tuple stated(const std::string& name, const std::string& type, const nb::object& value, std::string_view unit,
                 std::string_view doc) {
  return nb::make_tuple(name, type, value, std::string(unit), std::string(doc));
}

}  // namespace

nb::object StructMember::of(const void* whole) const {
  return read != nullptr ? read(fact, whole) : type->to_python(place_in(whole, *this));
}

void add_member(StructType& type, const std::string_view& name, const std::string_view& unit,
                const std::string_view& doc, const ValueType* value, const Choices& choices, std::size_t offset) {
  type.members.push_back({name, unit, doc, value, choices, offset});
}

void add_fact(StructType& type, const std::string_view& name, const std::string_view& unit, const std::string_view& doc,
              const ValueType* value, nb::object (*read)(const void* fact, const void* whole), const void* fact) {
  type.members.push_back({name, unit, doc, value, {}, 0, read, fact});
}

nb::object struct_of(const StructType& type, const void* whole) {
  const nb::object python = nb::module_::import_("blum._structs").attr(std::string(type.name).c_str());
  return python(**members_of(type, whole));
}

nb::dict members_of(const StructType& type, const void* whole) {
  nb::dict out;
  for (const StructMember& member : type.members) {
    if (member.type != nullptr) {
      out[python_name(member.name).c_str()] = member.of(whole);
      continue;
    }
    using Rule = LabelSelection::Rule;
    const auto& chosen = *static_cast<const LabelSelection*>(place_in(whole, member));
    out["label"] = chosen.rule == Rule::label ? to_python(chosen.label) : nb::none();
    out["threshold"] = chosen.rule == Rule::threshold ? to_python(chosen.threshold) : nb::none();
  }
  return out;
}

void read_members(const StructType& type, const nb::dict& given, void* whole) {
  Given values(given);
  for (const StructMember& member : type.members) {
    if (member.read != nullptr) continue;
    if (member.type == nullptr) {
      *static_cast<LabelSelection*>(place_in(whole, member)) = selection_from(values);
      continue;
    }
    const std::string name = python_name(member.name);
    const nb::object value = values.take(name);
    if (value.is_valid()) member.type->from_python(place_in(whole, member), value, name, member.choices);
  }
  values.refuse_others();
}

void bind_members(nb::module_& m, const StructType& type, bool is_options) {
  nb::list members;
  for (const StructMember& member : type.members) {
    if (member.type == nullptr) {
      members.append(stated("label", "Integer | None", nb::none(), "", "images: selects the voxels of this value"));
      members.append(stated("threshold", "Real | None", nb::none(), "",
                            "images: selects the voxels of at least this value; excludes a label"));
      continue;
    }
    // Only options have defaults. Results may have types whose Python classes exist only once the package is complete.
    const nb::object value = is_options ? member.of(type.defaults) : nb::none();
    const std::string name = member.type->type_name(m, is_options, member.choices);
    members.append(stated(python_name(member.name), name, value, member.unit, member.doc));
  }
  nb::dict entry;
  entry["doc"] = std::string(type.doc);
  entry["is_options"] = is_options;
  entry["members"] = members;
  nb::cast<nb::dict>(m.attr("described"))[std::string(type.name).c_str()] = entry;
}

std::string struct_name(nb::module_& m, const StructType& type) {
  if (!is_described(m, type.name)) bind_members(m, type, false);
  return std::string(type.name);
}

nb::object word(std::string_view text) {
  return nb::cast(std::string(text));
}

std::string word_from(nb::handle value) {
  return nb::cast<std::string>(nb::isinstance<nb::str>(value) ? nb::str(value) : nb::repr(value));
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

nb::object tuple_of(const ValueType& type, const void* first, std::size_t count, std::size_t size) {
  nb::list all;
  for (std::size_t k = 0; k < count; ++k) all.append(type.to_python(static_cast<const std::byte*>(first) + k * size));
  return nb::tuple(all);
}

std::string tuple_name(nb::module_& m, const ValueType& type, std::size_t count, bool is_options) {
  std::string parts;
  for (std::size_t k = 0; k < count; ++k) parts += (k > 0 ? ", " : "") + type.type_name(m, is_options, {});
  return "tuple[" + parts + "]";
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
