#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <string_view>
#include <type_traits>
#include <utility>
#include <variant>
#include <vector>

#include "blum/complex/columns.hpp"
#include "blum/complex/complex.hpp"
#include "blum/core/error.hpp"
#include "blum/core/exact_text.hpp"
#include "blum/geometry/primitives.hpp"
#include "blum/io/atomic_file.hpp"
#include "blum/io/complex_io.hpp"
#include "blum/io/formats.hpp"
#include "blum/io/proximity_io.hpp"
#include "io/field_sink.hpp"
#include "io/file_columns.hpp"
#include "io/json.hpp"
#include "io/npz.hpp"
#include "io/row_writer.hpp"

namespace blum {
namespace {

template <class T>
using Two = std::array<T, 2>;

/// Pairs, column by column.
class PairColumns {
 public:
  /// All are kept by reference. @throws InvalidOption where a pair is not of the objects, or `more` not of the pairs;
  /// Cancelled.
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

  /// What is told beside that.
  [[nodiscard]] const Columns& more() const { return more_; }

  /// Calls visit(n) for each pair. @throws Cancelled.
  template <class Visit>
  void for_each(const Visit& visit) const {
    constexpr std::size_t look_every = 65536;
    for (std::size_t n = 0; n < size(); ++n) {
      if (n % look_every == 0) throw_if_cancelled(context_);
      visit(n);
    }
  }
  /// All rows of one column.
  template <class Row>
  [[nodiscard]] std::vector<Row> all(Row (PairColumns::*row)(std::size_t) const) const {
    std::vector<Row> rows(size());
    for_each([&](std::size_t n) { rows[n] = (this->*row)(n); });
    return rows;
  }

 private:
  void check(const Columns& more) const {
    if (!more.empty() && more.rows() != pairs_.size()) {
      throw InvalidOption("further columns have " + std::to_string(more.rows()) + " rows, but there are " +
                          std::to_string(pairs_.size()) + " pairs; give a row for each");
    }
    for (const Column& column : more) {
      if (std::find(own_names.begin(), own_names.end(), column.name) == own_names.end()) continue;
      throw InvalidOption("a further column is named '" + column.name + "', as one that files of pairs have anyway");
    }
  }
  void check(ObjectId object, std::uint32_t primitive) const {
    if (object.value >= objects_.size()) {
      throw InvalidOption("a pair is of object " + std::to_string(object.value) + ", but meshes of " +
                          std::to_string(objects_.size()) + " objects are given; give one for each object");
    }
    if (const std::size_t count = primitive_count(objects_[object.value]); primitive >= count) {
      throw InvalidOption("a pair is of primitive " + std::to_string(primitive) + " of object " +
                          std::to_string(object.value) + ", whose mesh has " + std::to_string(count) +
                          "; give the meshes that the pairs were found on");
    }
  }
  [[nodiscard]] Triangle corners(ObjectId object, std::uint32_t primitive) const {
    return primitive_vertices(objects_[object.value], primitive);
  }

  static constexpr std::array<std::string_view, 6> own_names{"object", "primitive", "distance",
                                                             "point",  "feature",   "metadata"};

  std::span<const PrimitivePair> pairs_;
  std::span<const MeshView> objects_;
  const Columns& more_;
  const Context& context_;
};

/// Metadata that are numbers, true or false in .json.
constexpr std::array<std::string_view, 2> typed_keys{"within", "self"};

/// Bytes of a pair in .npz.
constexpr std::size_t row_size = 8 * sizeof(std::int32_t) + 7 * sizeof(double) + 2 * sizeof(std::int32_t);

void write_npz(const std::filesystem::path& path, const PairColumns& pairs, const FileMetadata& metadata,
               const Context& context) {
  AtomicFile file(path);
  std::size_t size = row_size;
  for (const Column& column : pairs.more()) {
    size += volume_io::scalar_size(complex_files::scalar_type(column)) * column.components;
  }
  volume_io::FieldSink sink(size * pairs.size(), context);
  volume_io::NpzWriter npz(file, sink, context);
  const auto add = [&]<class Row>(const char* name, const char* type, std::vector<std::uint64_t> shape,
                                  const std::vector<Row>& rows) {
    shape.insert(shape.begin(), rows.size());
    npz.add(name, type, shape, std::span<const Row>(rows));
  };
  // One column after the other, so that one at a time is in memory.
  add("object", "i4", {2}, pairs.all(&PairColumns::object));
  add("primitive", "i4", {2}, pairs.all(&PairColumns::primitive));
  add("distance", "f8", {}, pairs.all(&PairColumns::distance));
  add("point", "f8", {2, 3}, pairs.all(&PairColumns::point));
  add("feature", "i4", {2, 3}, pairs.all(&PairColumns::feature));
  for (const Column& column : pairs.more()) complex_files::write_column(npz, column.name, column);
  if (!metadata.empty()) npz.add_text("metadata", volume_io::to_json(metadata));
  npz.finish();
  file.commit();
}

/// The numbers of a row of a column.
std::vector<std::string> texts_of(const Column& column, std::size_t row) {
  std::vector<std::string> out;
  const auto add = [&](const auto& numbers) {
    for (std::size_t k = row * column.components; k < (row + 1) * column.components; ++k) {
      if constexpr (std::is_floating_point_v<std::decay_t<decltype(numbers[k])>>) {
        out.push_back(exact_text(numbers[k]));
      } else {
        out.push_back(std::to_string(numbers[k]));
      }
    }
  };
  std::visit(add, column.values);
  return out;
}

/// The names of further columns in .csv.
std::string names_of(const Columns& more) {
  std::string out;
  for (const Column& column : more) {
    for (std::size_t k = 0; k < column.components; ++k) {
      out += ',' + column.name + (column.components > 1 ? '_' + std::to_string(k) : "");
    }
  }
  return out;
}

void write_csv(const std::filesystem::path& path, const PairColumns& pairs, const Context& context) {
  RowWriter rows(path, pairs.size(), context);
  rows.text(
      "first_object,first_primitive,second_object,second_primitive,distance,first_x,first_y,first_z,second_x,second_y,"
      "second_z,first_feature_0,first_feature_1,first_feature_2,second_feature_0,second_feature_1,second_feature_2");
  rows.text(names_of(pairs.more()) + '\n');
  for (std::size_t n = 0; n < pairs.size(); ++n) {
    const auto object = pairs.object(n);
    const auto primitive = pairs.primitive(n);
    std::string row = std::to_string(object[0]) + ',' + std::to_string(primitive[0]) + ',' + std::to_string(object[1]) +
                      ',' + std::to_string(primitive[1]) + ',' + exact_text(pairs.distance(n));
    for (const Vec3d& p : pairs.point(n)) {
      for (std::size_t axis = 0; axis < 3; ++axis) row += ',' + exact_text(p[axis]);
    }
    for (const auto& feature : pairs.feature(n)) {
      for (const std::int32_t vertex : feature) row += ',' + std::to_string(vertex);
    }
    for (const Column& column : pairs.more()) {
      for (const std::string& number : texts_of(column, n)) row += ',' + number;
    }
    rows.text(row + '\n');
    rows.end_row();
  }
  rows.finish();
}

std::string json_text(std::int32_t value) {
  return std::to_string(value);
}
std::string json_text(double value) {
  return exact_text(value);
}
std::string json_text(const Vec3d& v) {
  return '[' + exact_text(v.x) + ", " + exact_text(v.y) + ", " + exact_text(v.z) + ']';
}
template <class T, std::size_t count>
std::string json_text(const std::array<T, count>& values) {
  std::string text;
  for (const T& value : values) text += (text.empty() ? "[" : ", ") + json_text(value);
  return text + ']';
}

/// One number as itself, more as a list; null for those that JSON has no numbers for.
std::string json_text(std::vector<std::string> numbers) {
  for (std::string& number : numbers) {
    if (number.find_first_of("in") != std::string::npos) number = "null";  // inf, -inf, nan
  }
  if (numbers.size() == 1) return numbers.front();
  std::string text;
  for (const std::string& number : numbers) text += (text.empty() ? "[" : ", ") + number;
  return text + ']';
}

void write_json(const std::filesystem::path& path, const PairColumns& pairs, const FileMetadata& metadata,
                const Context& context) {
  RowWriter rows(path, (5 + pairs.more().size()) * pairs.size(), context);
  rows.text("{\"metadata\": " + volume_io::to_typed_json(metadata, typed_keys));
  const auto add = [&](const std::string& name, const auto& row_of) {
    rows.text(",\n\"" + name + "\": [");
    for (std::size_t n = 0; n < pairs.size(); ++n) {
      rows.text((n == 0 ? "\n" : ",\n") + json_text(row_of(n)));
      rows.end_row();
    }
    rows.text("]");
  };
  add("object", [&](std::size_t n) { return pairs.object(n); });
  add("primitive", [&](std::size_t n) { return pairs.primitive(n); });
  add("distance", [&](std::size_t n) { return pairs.distance(n); });
  add("point", [&](std::size_t n) { return pairs.point(n); });
  add("feature", [&](std::size_t n) { return pairs.feature(n); });
  for (const Column& column : pairs.more()) {
    add(column.name, [&](std::size_t n) { return texts_of(column, n); });
  }
  rows.text("}\n");
  rows.finish();
}

void write_vtp(const std::filesystem::path& path, const PairColumns& pairs, const FileMetadata& metadata,
               const Context& context) {
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
  write_complex(path, lines, metadata, {}, context);
}

}  // namespace

const std::vector<std::string>& proximity_extensions() {
  static const std::vector<std::string> extensions{".npz", ".csv", ".json", ".vtp"};
  return extensions;
}

void write_proximity_pairs(const std::filesystem::path& path, std::span<const PrimitivePair> pairs,
                           std::span<const MeshView> objects, const FileMetadata& metadata, const Columns& more,
                           const Context& context) {
  const std::string extension = file_extension(path);
  const auto& known = proximity_extensions();
  if (std::find(known.begin(), known.end(), extension) == known.end()) {
    throw InvalidOption("'" + path.string() +
                        "': close pairs are written to .npz, .csv, .json, .vtp files; use one of these extensions");
  }
  const PairColumns columns(pairs, objects, more, context);
  throw_if_cancelled(context);
  if (extension == ".npz") {
    write_npz(path, columns, metadata, context);
  } else if (extension == ".csv") {
    write_csv(path, columns, context);
  } else if (extension == ".json") {
    write_json(path, columns, metadata, context);
  } else {
    write_vtp(path, columns, metadata, context);
  }
}

}  // namespace blum
