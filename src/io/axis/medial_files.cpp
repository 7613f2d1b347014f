#include "io/axis/medial_columns.hpp"

#include <algorithm>
#include <array>
#include <cstdint>
#include <limits>
#include <string_view>
#include <type_traits>
#include <variant>
#include <vector>

#include "blum/complex/medial_columns.hpp"
#include "blum/core/error.hpp"
#include "blum/core/ids.hpp"
#include "io/complex/edge_set.hpp"

namespace blum::medial_files {
namespace {

/// A double too large for a float becomes an infinity, which whoever needs finite numbers finds.
float to_float(double value) {
  constexpr double most = std::numeric_limits<float>::max();
  if (value > most) return std::numeric_limits<float>::infinity();
  return value < -most ? -std::numeric_limits<float>::infinity() : static_cast<float>(value);
}

/// The columns of one kind of cell: those of an axis in the types that it needs, then the others.
class Typed {
 public:
  Typed(Columns& columns, std::string kind, const std::string& name)
      : columns_(columns), kind_(std::move(kind)), name_(name), known_(columns.rows()) {}

  /// Takes a column of numbers as doubles or floats; false when it is not there.
  template <class T>
  bool numbers(std::string_view column, std::size_t components = 1) {
    const Column* const found = find(column, components);
    if (found == nullptr) return false;
    std::vector<T> out;
    std::visit(
        [&](const auto& values) {
          out.reserve(values.size());
          for (const auto value : values) {
            if constexpr (std::is_same_v<T, float>) {
              out.push_back(to_float(static_cast<double>(value)));
            } else {
              out.push_back(static_cast<T>(value));
            }
          }
        },
        found->values);
    known_.add({std::string(column), components, std::move(out)});
    return true;
  }

  /// The same of whole numbers from `least` to `most`, as int32.
  bool integers(std::string_view column, std::int64_t least, std::int64_t most) {
    const Column* const found = find(column, 1);
    if (found == nullptr) return false;
    std::vector<std::int32_t> out;
    std::visit(
        [&]<class T>(const std::vector<T>& values) {
          if constexpr (std::is_floating_point_v<T>) {
            fail(column, "the values must be whole numbers, but these are floating-point");
          } else {
            for (std::size_t i = 0; i < values.size(); ++i) {
              if (values[i] < least || values[i] > most) {
                fail(column, "row " + std::to_string(i) + " is " + std::to_string(values[i]) + ", but " +
                                 std::to_string(least) + " to " + std::to_string(most) + " are possible");
              }
              out.push_back(static_cast<std::int32_t>(values[i]));
            }
          }
        },
        found->values);
    known_.add({std::string(column), 1, std::move(out)});
    return true;
  }

  /// Puts the columns in their new types and order in the place of those of the complex.
  void finish() {
    for (const Column& column : columns_) {
      if (known_.find(column.name) == nullptr) known_.add(column);
    }
    columns_ = std::move(known_);
  }

 private:
  [[noreturn]] void fail(std::string_view column, const std::string& reason) const {
    throw FormatError(name_ + ": the column '" + std::string(column) + "' of " + kind_ + ": " + reason);
  }

  const Column* find(std::string_view column, std::size_t components) const {
    const Column* const found = columns_.find(column);
    if (found != nullptr && found->components != components) {
      fail(column, "it has " + std::to_string(found->components) + " components, not " + std::to_string(components));
    }
    return found;
  }

  Columns& columns_;
  std::string kind_;
  const std::string& name_;
  Columns known_;
};

constexpr auto last_role = static_cast<std::int64_t>(MedialRole::junction);

/// @param has_levels  where not null: levels are taken, too, and this tells whether all of them are there.
MedialColumns take_columns(Complex& complex, const std::string& name, bool* has_levels) {
  namespace names = medial_columns;
  if (complex.vertex_columns.empty()) complex.vertex_columns.resize(complex.positions.size());
  if (complex.edge_columns.empty()) complex.edge_columns.resize(complex.edges.size());
  if (complex.triangle_columns.empty()) complex.triangle_columns.resize(complex.triangles.size());
  Typed vertices(complex.vertex_columns, "vertices", name);
  Typed edges(complex.edge_columns, "edges", name);
  Typed triangles(complex.triangle_columns, "triangles", name);
  MedialColumns has;
  has.radii = vertices.numbers<double>(names::radius);
  has.footprints = has.sites = true;
  for (const std::string_view foot : names::footprints)
    has.footprints = vertices.numbers<double>(foot, 3) && has.footprints;
  for (const std::string_view site : names::sites) {
    has.sites = vertices.integers(site, -1, std::int64_t{max_id_count}) && has.sites;
  }
  has.angles = vertices.numbers<double>(names::separation_angle);
  has.labels = vertices.integers(names::role, 0, last_role);
  has.angles = (edges.numbers<float>(names::separation_angle) || complex.edges.empty()) && has.angles;
  has.labels = (edges.integers(names::role, 0, last_role) || complex.edges.empty()) && has.labels;
  has.angles = (triangles.numbers<float>(names::separation_angle) || complex.triangles.empty()) && has.angles;
  has.labels =
      (triangles.integers(names::sheet, 0, std::int64_t{max_id_count} - 1) || complex.triangles.empty()) && has.labels;
  if (has_levels != nullptr) {
    *has_levels = vertices.numbers<float>(names::until);
    *has_levels = edges.numbers<float>(names::from) && *has_levels;
    *has_levels = edges.numbers<float>(names::until) && *has_levels;
    *has_levels = triangles.numbers<float>(names::until) && *has_levels;
  }
  for (Typed* columns : {&vertices, &edges, &triangles}) columns->finish();
  return has;
}

}  // namespace

Complex to_axis(Complex complex, const std::string& name, MedialColumns& found) {
  const bool is_labelled = complex.edge_columns.find(medial_columns::role) != nullptr;
  if (!is_labelled && !complex.edges.empty() && !complex.triangles.empty()) complex = without_sides(std::move(complex));
  found = take_columns(complex, name, nullptr);
  const CompleteAxis all(complex);
  if (complex.positions.empty()) complex.vertex_columns = all.get().vertex_columns;
  if (complex.edges.empty()) complex.edge_columns = all.get().edge_columns;
  if (complex.triangles.empty()) complex.triangle_columns = all.get().triangle_columns;
  return complex;
}

Complex to_nested(const Complex& complex, const std::string& name) {
  Complex nested = complex;
  bool has_levels = false;
  const MedialColumns has = take_columns(nested, name, &has_levels);
  if (!has_levels || !has.radii || !has.footprints || !has.sites || !has.angles || !has.labels) {
    throw FormatError(name + ": columns of the axes of all angles are missing");
  }
  add_missing_medial_columns(nested);  // of edges and triangles where there are none
  return nested;
}

Complex without_sides(Complex complex) {
  using complex_files::EdgeSet;
  const EdgeSet sides(complex.view(), EdgeSet::Of::triangles);
  std::vector<std::uint32_t> kept;
  for (std::size_t e = 0; e < complex.edges.size(); ++e) {
    if (!sides.contains(complex.edges[e])) kept.push_back(static_cast<std::uint32_t>(e));
  }
  if (!complex.edge_columns.empty()) complex.edge_columns = complex.edge_columns.pick(kept);
  for (std::size_t i = 0; i < kept.size(); ++i) complex.edges[i] = complex.edges[kept[i]];
  complex.edges.resize(kept.size());
  return complex;
}

}  // namespace blum::medial_files
