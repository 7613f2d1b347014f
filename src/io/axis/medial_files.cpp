#include "io/axis/medial_files.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <type_traits>
#include <variant>
#include <vector>

#include "blum/complex/medial_columns.hpp"
#include "blum/core/error.hpp"
#include "blum/core/exact_text.hpp"
#include "blum/core/ids.hpp"
#include "io/complex/complex_files.hpp"
#include "io/field/field_files.hpp"
#include "io/text/text_cursor.hpp"

namespace blum::medial_files {
namespace {

/// Converts to float. Values beyond float's range become infinite, so later checks for finite numbers reject them.
float to_float(double value) {
  constexpr double most = std::numeric_limits<float>::max();
  if (value > most) return std::numeric_limits<float>::infinity();
  return value < -most ? -std::numeric_limits<float>::infinity() : static_cast<float>(value);
}

/// Converter of the columns of one kind of cell. The columns that an axis needs come first, in the required types;
/// others follow.
class Typed {
 public:
  Typed(Columns& columns, std::string kind, const std::string& name)
      : columns_(columns), kind_(std::move(kind)), name_(name), known_(columns.rows()) {}

  /// Converts a numeric column to doubles or floats. Returns false if it does not exist.
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

  /// Converts a column of integers from `least` to `most` (inclusive) to int32. Returns false if it does not exist.
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
                fail(column, "row " + std::to_string(i) + " is " + std::to_string(values[i]) + ", but must be " +
                                 std::to_string(least) + " to " + std::to_string(most));
              }
              out.push_back(static_cast<std::int32_t>(values[i]));
            }
          }
        },
        found->values);
    known_.add({std::string(column), 1, std::move(out)});
    return true;
  }

  /// Replaces the columns of the complex by the converted ones, followed by the others.
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

/// @param has_levels  if not null, the level columns are converted, too, and it is set to true if all of them exist.
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
  add_missing_medial_columns(nested);  // for edges and triangles, if the complex has none of them
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

namespace {

using Metadata = FileMetadata;

constexpr const char* axis_content = "medial axis";

/// Footprints lie on the border of the solid, so their site ids are those of unselected voxels.
std::string site_sentence(SiteIds ids) {
  if (ids != SiteIds::voxels) return volume_io::site_sentence(ids);
  return "site ids: the linear index x + nx * (y + ny * z) of the unselected voxel whose face the footprint lies on. "
         "Outside the image, the adjacent voxel of the image counts. -1: none";
}

std::string numbers_text(const Vec3d& v) {
  return exact_text(v.x) + " " + exact_text(v.y) + " " + exact_text(v.z);
}

void add_grid(Metadata& pairs, const GridSpec& grid) {
  pairs.emplace_back("grid_origin", numbers_text(grid.origin));
  pairs.emplace_back("grid_spacing", numbers_text(grid.spacing));
  pairs.emplace_back("grid_size", std::to_string(grid.size[0]) + " " + std::to_string(grid.size[1]) + " " +
                                      std::to_string(grid.size[2]));
  std::string rows;
  for (std::size_t row = 0; row < 3; ++row) {
    const auto& c = grid.direction.columns;
    rows += (row == 0 ? "" : " ") + numbers_text({c[0][row], c[1][row], c[2][row]});
  }
  pairs.emplace_back("grid_direction", rows);
}

/// Reader of known keys of the metadata. It converts their values to numbers.
class PairReader {
 public:
  PairReader(const Metadata& pairs, const std::string& name) : pairs_(pairs), name_(name) {}

  [[nodiscard]] std::string text(std::string_view key) const { return std::string(find_value(pairs_, key)); }

  template <class T, std::size_t n>
  [[nodiscard]] std::optional<std::array<T, n>> numbers(std::string_view key) const {
    const std::string_view text = find_value(pairs_, key);
    if (text.empty()) return std::nullopt;
    const auto words = volume_io::split_words(text);
    std::array<T, n> out{};
    for (std::size_t i = 0; i < n; ++i) {
      const auto value = words.size() == n ? volume_io::parse_number<T>(words[i]) : std::nullopt;
      if (!value || !std::isfinite(static_cast<double>(*value))) {
        fail(key, n == 1 ? "it must be a finite number" : "it must be " + std::to_string(n) + " finite numbers");
      }
      out[i] = *value;
    }
    return out;
  }
  template <class T = double>
  [[nodiscard]] std::optional<T> number(std::string_view key) const {
    const auto value = numbers<T, 1>(key);
    return value ? std::optional((*value)[0]) : std::nullopt;
  }
  [[nodiscard]] std::optional<double> not_negative(std::string_view key) const {
    const auto value = number(key);
    if (value && *value < 0) fail(key, "it must not be negative");
    return value;
  }

  [[nodiscard]] SiteIds site_ids() const {
    const std::string_view text = find_value(pairs_, "site_ids");
    if (text.empty()) return SiteIds::features;
    for (const SiteIds ids : {SiteIds::features, SiteIds::triangles, SiteIds::voxels}) {
      if (to_string(ids) == text) return ids;
    }
    fail("site_ids", "this numbering is not known");
  }

  [[nodiscard]] std::optional<GridSpec> grid() const {
    const auto origin = numbers<double, 3>("grid_origin");
    const auto spacing = numbers<double, 3>("grid_spacing");
    const auto size = numbers<std::int64_t, 3>("grid_size");
    const auto rows = numbers<double, 9>("grid_direction");
    if (!origin && !spacing && !size && !rows) return std::nullopt;
    if (!origin || !spacing || !size || !rows) {
      throw FormatError(name_ + ": the metadata give only some of the grid's origin, spacing, size and direction");
    }
    GridSpec grid;
    grid.origin = {(*origin)[0], (*origin)[1], (*origin)[2]};
    grid.spacing = {(*spacing)[0], (*spacing)[1], (*spacing)[2]};
    grid.size = *size;
    for (std::size_t c = 0; c < 3; ++c) grid.direction.columns[c] = {(*rows)[c], (*rows)[3 + c], (*rows)[6 + c]};
    try {
      validate(grid);
    } catch (const InvalidGrid& error) {
      throw FormatError(name_ + ": the grid of the metadata: " + error.what());
    }
    return grid;
  }

 private:
  [[noreturn]] void fail(std::string_view key, const std::string& reason) const {
    throw FormatError(name_ + ": the metadata say " + std::string(key) + " '" + text(key) + "', but " + reason);
  }

  const Metadata& pairs_;
  const std::string& name_;
};

constexpr const char* fitted_borders = "fitted";

}  // namespace

FileMetadata to_pairs(const MedialMetadata& metadata) {
  Metadata pairs;
  pairs.emplace_back("content", axis_content);
  if (!metadata.version.empty()) pairs.emplace_back("blum_version", metadata.version);
  if (!metadata.source.empty()) pairs.emplace_back("source", metadata.source);
  pairs.emplace_back("site_ids", to_string(metadata.site_ids));
  pairs.emplace_back("sites", site_sentence(metadata.site_ids));
  pairs.emplace_back("roles", "0 sheet, 1 rim, 2 seam, 3 curve, 4 junction");
  if (metadata.theta) pairs.emplace_back("theta", exact_text(*metadata.theta));
  if (metadata.lambda) pairs.emplace_back("lambda", exact_text(*metadata.lambda));
  if (metadata.spacing) pairs.emplace_back("spacing", exact_text(*metadata.spacing));
  if (metadata.deviation) pairs.emplace_back("deviation", exact_text(*metadata.deviation));
  if (metadata.fitted) pairs.emplace_back("borders", fitted_borders);
  if (!metadata.solid_rule.empty()) pairs.emplace_back("solid_rule", metadata.solid_rule);
  if (metadata.grid) add_grid(pairs, *metadata.grid);
  if (metadata.label) pairs.emplace_back("label", std::to_string(*metadata.label));
  if (metadata.threshold) pairs.emplace_back("threshold", exact_text(*metadata.threshold));
  if (metadata.weld) pairs.emplace_back("weld", exact_text(*metadata.weld));
  if (metadata.smooth) pairs.emplace_back("smooth", std::to_string(*metadata.smooth));
  return pairs;
}

MedialMetadata from_pairs(const FileMetadata& pairs, const std::string& name) {
  const PairReader reader(pairs, name);
  if (const std::string content = reader.text("content"); !content.empty() && content != axis_content) {
    throw FormatError(name + ": the metadata state the content '" + content + "', not a medial axis");
  }
  MedialMetadata metadata;
  metadata.source = reader.text("source");
  metadata.version = reader.text("blum_version");
  metadata.site_ids = reader.site_ids();
  metadata.theta = reader.number("theta");
  metadata.lambda = reader.number("lambda");
  metadata.spacing = reader.number("spacing");
  metadata.deviation = reader.not_negative("deviation");
  metadata.fitted = reader.text("borders") == fitted_borders;
  metadata.solid_rule = reader.text("solid_rule");
  metadata.grid = reader.grid();
  metadata.label = reader.number<std::int64_t>("label");
  metadata.threshold = reader.number("threshold");
  if (metadata.label && metadata.threshold) {
    throw FormatError(name + ": the metadata give a label and a threshold, but only one of them can select the solid");
  }
  metadata.weld = reader.not_negative("weld");
  metadata.smooth = reader.number<int>("smooth");
  if (metadata.smooth && (*metadata.smooth < 0 || *metadata.smooth > most_smoothing)) {
    throw FormatError(name + ": the metadata say smooth '" + std::to_string(*metadata.smooth) +
                      "', but it must be 0 to " + std::to_string(most_smoothing));
  }
  return metadata;
}

}  // namespace blum::medial_files
