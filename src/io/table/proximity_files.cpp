#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "blum/complex/columns.hpp"
#include "blum/complex/complex.hpp"
#include "blum/core/error.hpp"
#include "blum/geometry/primitives.hpp"
#include "blum/io/formats.hpp"
#include "blum/io/proximity_io.hpp"
#include "io/format_table.hpp"
#include "io/table/table_files.hpp"

namespace blum {
namespace {

template <class T>
using Two = std::array<T, 2>;

/// Pairs of primitives, stored column by column.
class PairColumns {
 public:
  /// All arguments are kept by reference.
  /// @throws InvalidOption if the objects lack a primitive of a pair, or if `more` has another number of rows than
  /// pairs; Cancelled.
  PairColumns(std::span<const PrimitivePair> pairs, std::span<const MeshView> objects, const Columns& more,
              const Context& context)
      : pairs_(pairs), objects_(objects), more_(more), context_(context) {
    check(more);
    for_each([&](std::size_t n) {
      check(pairs_[n].first_object, pairs_[n].first);
      check(pairs_[n].second_object, pairs_[n].second);
    });
  }

  [[nodiscard]] std::size_t size() const { return pairs_.size(); }
  [[nodiscard]] Two<std::int32_t> object(std::size_t n) const {
    return {pairs_[n].first_object.to_file(), pairs_[n].second_object.to_file()};
  }
  [[nodiscard]] Two<std::int32_t> primitive(std::size_t n) const {
    return {static_cast<std::int32_t>(pairs_[n].first), static_cast<std::int32_t>(pairs_[n].second)};
  }
  [[nodiscard]] double distance(std::size_t n) const { return pairs_[n].between.distance; }
  [[nodiscard]] Two<Vec3d> point(std::size_t n) const {
    return {pairs_[n].between.first_point, pairs_[n].between.second_point};
  }
  [[nodiscard]] Two<std::array<std::int32_t, 3>> feature(std::size_t n) const {
    const PrimitivePair& pair = pairs_[n];
    return {feature_vertices(corners(pair.first_object, pair.first), pair.between.first_feature),
            feature_vertices(corners(pair.second_object, pair.second), pair.between.second_feature)};
  }

  /// Returns the additional columns.
  [[nodiscard]] const Columns& more() const { return more_; }

  /// Calls visit(n) for the index n of each pair. @throws Cancelled.
  template <class Visit>
  void for_each(const Visit& visit) const {
    constexpr std::size_t look_every = 65536;
    for (std::size_t n = 0; n < size(); ++n) {
      if (n % look_every == 0) throw_if_cancelled(context_);
      visit(n);
    }
  }

 private:
  void check(const Columns& more) const {
    if (!more.empty() && more.rows() != pairs_.size()) {
      throw InvalidOption("further columns have " + std::to_string(more.rows()) + " rows, but there are " +
                          std::to_string(pairs_.size()) + " pairs; give one row for each pair");
    }
    for (const Column& column : more) {
      if (std::find(own_names.begin(), own_names.end(), column.name) == own_names.end()) continue;
      throw InvalidOption("a further column has the name '" + column.name + "', which files of pairs use themselves");
    }
  }
  void check(ObjectId object, std::uint32_t primitive) const {
    if (object.value >= objects_.size()) {
      throw InvalidOption("a pair uses object " + std::to_string(object.value) + ", but meshes of " +
                          std::to_string(objects_.size()) + " objects are given; give one mesh for each object");
    }
    if (const std::size_t count = primitive_count(objects_[object.value]); primitive >= count) {
      throw InvalidOption("a pair uses primitive " + std::to_string(primitive) + " of object " +
                          std::to_string(object.value) + ", whose mesh has only " + std::to_string(count) +
                          " primitives; give the meshes in which the pairs were found");
    }
  }
  [[nodiscard]] Triangle corners(ObjectId object, std::uint32_t primitive) const {
    return primitive_vertices(objects_[object.value], primitive);
  }

  static constexpr std::array<std::string_view, 6> own_names{"object",  "primitive", "distance",
                                                             "closest", "feature",   "metadata"};

  std::span<const PrimitivePair> pairs_;
  std::span<const MeshView> objects_;
  const Columns& more_;
  const Context& context_;
};

/// Keys of metadata whose values are written as numbers, true or false in .json.
constexpr std::array<std::string_view, 2> typed_keys{"max_distance", "self"};

using tables::made_column;
using tables::TableColumn;

/// Names of columns in .csv for the coordinates of points; below, those for the vertices of features.
const std::vector<std::string> point_names{"first_x", "first_y", "first_z", "second_x", "second_y", "second_z"};
const std::vector<std::string> feature_names{"first_feature_0",  "first_feature_1",  "first_feature_2",
                                             "second_feature_0", "second_feature_1", "second_feature_2"};

/// Returns two columns: the objects of each pair, and its primitives.
std::vector<TableColumn> id_columns(const PairColumns& pairs) {
  const auto object = [&](std::size_t n, std::span<std::int32_t> out) {
    std::ranges::copy(pairs.object(n), out.begin());
  };
  const auto primitive = [&](std::size_t n, std::span<std::int32_t> out) {
    std::ranges::copy(pairs.primitive(n), out.begin());
  };
  return {made_column<std::int32_t>("object", {2}, object), made_column<std::int32_t>("primitive", {2}, primitive)};
}

/// Returns one column with the object and primitive of the first side, then those of the second side.
TableColumn ids_by_side(const PairColumns& pairs) {
  const auto make = [&](std::size_t n, std::span<std::int32_t> out) {
    for (std::size_t side = 0; side < 2; ++side) {
      out[2 * side] = pairs.object(n)[side];
      out[2 * side + 1] = pairs.primitive(n)[side];
    }
  };
  return made_column<std::int32_t>("ids", {4}, make,
                                   {"first_object", "first_primitive", "second_object", "second_primitive"});
}

/// Adds columns for the distance, closest points and features of each pair, and the additional columns.
void add_places(const PairColumns& pairs, std::vector<TableColumn>& columns) {
  const auto distance = [&](std::size_t n, std::span<double> out) { out[0] = pairs.distance(n); };
  const auto point = [&](std::size_t n, std::span<double> out) {
    for (std::size_t k = 0; k < 6; ++k) out[k] = pairs.point(n)[k / 3][k % 3];
  };
  const auto feature = [&](std::size_t n, std::span<std::int32_t> out) {
    const auto sides = pairs.feature(n);
    for (std::size_t k = 0; k < 6; ++k) out[k] = sides[k / 3][k % 3];
  };
  columns.push_back(made_column<double>("distance", {}, distance));
  columns.push_back(made_column<double>("closest", {2, 3}, point, point_names));
  columns.push_back(made_column<std::int32_t>("feature", {2, 3}, feature, feature_names));
  for (const Column& column : pairs.more()) columns.push_back(tables::column_of(column));
}

/// Returns a table with a separate column for each kind of data.
tables::Table facts(const PairColumns& pairs) {
  tables::Table table{pairs.size(), id_columns(pairs)};
  add_places(pairs, table.columns);
  return table;
}

/// Returns a table for text files. Ids of the first side come before those of the second side.
tables::Table rows_of_text(const PairColumns& pairs) {
  tables::Table table{pairs.size(), {ids_by_side(pairs)}};
  add_places(pairs, table.columns);
  return table;
}

/// Returns a complex with one line between the closest points of each pair.
Complex lines_of(const PairColumns& pairs) {
  Complex lines;
  lines.positions.reserve(2 * pairs.size());
  lines.edges.reserve(pairs.size());
  lines.edge_columns = Columns(pairs.size());
  const std::span<double> distance = lines.edge_columns.add<double>("distance");
  const std::span<std::int32_t> object = lines.edge_columns.add<std::int32_t>("object", 2);
  const std::span<std::int32_t> primitive = lines.edge_columns.add<std::int32_t>("primitive", 2);
  const std::span<std::int32_t> feature = lines.edge_columns.add<std::int32_t>("feature", 6);
  pairs.for_each([&](std::size_t n) {
    const auto first = static_cast<std::uint32_t>(2 * n);
    lines.edges.push_back({first, first + 1});
    distance[n] = pairs.distance(n);
    for (std::size_t side = 0; side < 2; ++side) {
      lines.positions.push_back(pairs.point(n)[side]);
      object[2 * n + side] = pairs.object(n)[side];
      primitive[2 * n + side] = pairs.primitive(n)[side];
      const std::array<std::int32_t, 3> vertices = pairs.feature(n)[side];
      std::copy(vertices.begin(), vertices.end(), &feature[6 * n + 3 * side]);
    }
  });
  for (const Column& column : pairs.more()) lines.edge_columns.add(column);
  lines.vertex_columns = Columns(lines.positions.size());
  return lines;
}

}  // namespace

void write_proximity_pairs(const std::filesystem::path& path, std::span<const PrimitivePair> pairs,
                           std::span<const MeshView> objects, const FileMetadata& metadata, const Columns& more,
                           const Context& context) {
  const PairFormat format = PairFormat::of(path, FileAccess::write);
  const PairColumns columns(pairs, objects, more, context);
  throw_if_cancelled(context);
  const auto arrays = [&] { return std::vector{facts(columns)}; };
  const tables::RowFile file{
      arrays, arrays, [&] { return rows_of_text(columns); }, [&] { return lines_of(columns); }, metadata, typed_keys};
  formats::code_of(format).write(path, file, context);
}

}  // namespace blum
