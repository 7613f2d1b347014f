#include "io/complex/complex_ply_names.hpp"

#include <algorithm>
#include <map>
#include <optional>
#include <set>
#include <string>

#include "io/text/text_cursor.hpp"

namespace blum::complex_files {
namespace {

constexpr std::string_view mark = "blum_column";
constexpr std::string_view axes = "xyz";

std::string component_name(const Column& column, std::size_t i) {
  if (column.components == 1) return column.name;
  return column.name + "_" + (column.components == 3 ? std::string(1, axes[i]) : std::to_string(i));
}

/// If the property `first` is the first of the three properties of a vector, returns the vector's name; else an empty
/// text.
std::string_view vector_name(const std::vector<PlyProperty>& properties, std::size_t first) {
  if (first + 3 > properties.size()) return {};
  const std::string_view x = properties[first].name;
  if (x.size() < 3 || !x.ends_with("_x")) return {};
  const std::string_view stem = x.substr(0, x.size() - 1);
  for (std::size_t i = 1; i < 3; ++i) {
    const PlyProperty& next = properties[first + i];
    if (next.name != std::string(stem) + axes[i] || next.type != properties[first].type) return {};
  }
  return x.substr(0, x.size() - 2);
}

struct Listed {
  std::size_t components = 1;
  std::string_view name;
};

/// Returns the columns that comments declare for an element, with their first properties as keys.
std::map<std::string_view, Listed> listed_columns(std::string_view element, const std::vector<std::string>& comments) {
  std::map<std::string_view, Listed> stated;
  for (const std::string& comment : comments) {
    const auto words = volume_io::split_words(comment);
    if (words.size() != 5 || words[0] != mark || words[1] != element) continue;
    const auto components = volume_io::parse_number<std::size_t>(words[3]);
    if (components && *components > 0) stated.emplace(words[2], Listed{*components, words[4]});
  }
  return stated;
}

/// Returns true if there are `count` properties of the same type, starting with `first`.
bool has_run(const std::vector<PlyProperty>& properties, std::size_t first, std::size_t count) {
  if (count > properties.size() - first) return false;
  const auto begin = properties.begin() + static_cast<std::ptrdiff_t>(first);
  return std::all_of(begin, begin + static_cast<std::ptrdiff_t>(count),
                     [&](const PlyProperty& p) { return p.type == begin->type; });
}

std::string comment_line(std::string_view element, const std::string& property, const Column& column) {
  return "comment " + std::string(mark) + " " + std::string(element) + " " + property + " " +
         std::to_string(column.components) + " " + column.name + "\n";
}

}  // namespace

PlyNames property_names(const Columns& columns, std::string_view element, const std::vector<std::string>& reserved) {
  PlyNames names;
  std::set<std::string> used(reserved.begin(), reserved.end());
  std::vector<PlyProperty> properties;
  std::vector<std::size_t> firsts;
  for (const Column& column : columns) {
    firsts.push_back(properties.size());
    for (std::size_t i = 0; i < column.components; ++i) {
      std::string name = component_name(column, i);
      while (!used.insert(name).second) name += "_";
      // The rule for reading only checks if types are equal. So it suffices that the values of different types differ.
      properties.push_back({name, false, PlyType::uint8, static_cast<PlyType>(column.values.index())});
      names.properties.push_back(std::move(name));
    }
  }
  // A column needs a comment only if the rule for reading finds a different column at its position. A comment takes
  // effect at the first property of its column. So every column that would be read differently gets a comment.
  const std::vector<PlyColumn> read = find_columns(properties, element, {});
  std::size_t c = 0;
  for (const Column& column : columns) {
    const std::size_t first = firsts[c++];
    const bool is_right = std::any_of(read.begin(), read.end(), [&](const PlyColumn& r) {
      return r.first == first && r.components == column.components && r.name == column.name;
    });
    if (!is_right || column.name == derived_property)
      names.comments += comment_line(element, properties[first].name, column);
  }
  return names;
}

std::vector<PlyColumn> find_columns(const std::vector<PlyProperty>& properties, std::string_view element,
                                    const std::vector<std::string>& comments) {
  const auto stated = listed_columns(element, comments);
  std::vector<PlyColumn> columns;
  for (std::size_t i = 0; i < properties.size(); i += columns.back().components) {
    const auto found = stated.find(properties[i].name);
    if (found != stated.end() && has_run(properties, i, found->second.components)) {
      columns.push_back({std::string(found->second.name), i, found->second.components});
    } else if (const std::string_view name = vector_name(properties, i); !name.empty()) {
      columns.push_back({std::string(name), i, 3});
    } else {
      columns.push_back({properties[i].name, i, 1});
    }
  }
  return columns;
}

bool is_listed(std::string_view property, std::string_view element, const std::vector<std::string>& comments) {
  return listed_columns(element, comments).contains(property);
}

}  // namespace blum::complex_files
