#include <algorithm>
#include <array>
#include <cstdint>
#include <functional>
#include <limits>
#include <span>
#include <string>
#include <type_traits>
#include <utility>
#include <variant>
#include <vector>

#include "io/bytes/field_sink.hpp"
#include "io/complex/complex_files.hpp"
#include "io/complex/edge_set.hpp"
#include "io/complex/file_columns.hpp"
#include "io/field/field_metadata.hpp"
#include "io/format_table.hpp"
#include "io/text/vtk_xml.hpp"

namespace blum::complex_files {
namespace {

using volume_io::ScalarType;

using Put = std::function<void(std::span<const std::byte>)>;

/// An array of a file, whose bytes are made only while they are written.
struct OutArray {
  std::string name;
  ScalarType type = ScalarType::f64;
  std::size_t components = 1;
  std::uint64_t numbers = 0;  ///< in all
  std::function<void(const Put&)> write;

  [[nodiscard]] std::uint64_t size() const { return numbers * volume_io::scalar_size(type); }
};

struct Section {
  std::string tag;  ///< with its attributes
  std::vector<OutArray> arrays;
};

template <class T>
void put_numbers(const Put& put, std::span<const T> numbers) {
  put(std::as_bytes(numbers));
}

constexpr std::size_t piece_size = 65536;

/// The same number again and again.
template <class T>
void put_fill(const Put& put, T value, std::uint64_t count) {
  const std::vector<T> piece(static_cast<std::size_t>(std::min<std::uint64_t>(count, piece_size)), value);
  while (count > 0) {
    const std::uint64_t now = std::min<std::uint64_t>(count, piece.size());
    put_numbers(put, std::span<const T>(piece).first(static_cast<std::size_t>(now)));
    count -= now;
  }
}

template <class Get>
void put_integers(const Put& put, std::uint64_t count, Get get) {
  std::vector<std::int64_t> piece;
  for (std::uint64_t begin = 0; begin < count; begin += piece_size) {
    piece.clear();
    for (std::uint64_t i = begin; i < std::min<std::uint64_t>(count, begin + piece_size); ++i) piece.push_back(get(i));
    put_numbers(put, std::span<const std::int64_t>(piece));
  }
}

OutArray whole_column(const Column& column) {
  return {column.name, scalar_type(column), column.components, column.rows() * column.components,
          [&column](const Put& put) {
            std::visit([&](const auto& values) { put_numbers(put, std::span(values)); }, column.values);
          }};
}

template <class T>
constexpr T fill_value = std::is_floating_point_v<T> ? std::numeric_limits<T>::quiet_NaN() : static_cast<T>(-1);

/// A column of cells: of edges, triangles, or both.
struct CellColumn {
  std::string name;  ///< of the array
  const Column* edges = nullptr;
  const Column* triangles = nullptr;
  [[nodiscard]] const Column& any() const { return edges != nullptr ? *edges : *triangles; }
};

bool is_alike(const Column& a, const Column& b) {
  return a.components == b.components && a.values.index() == b.values.index();
}

/// The arrays of a complex's cells, and which column each is.
struct CellColumns {
  std::vector<CellColumn> arrays;
  FileMetadata edge_names, triangle_names;  ///< columns and their arrays

  explicit CellColumns(const Complex& complex) {
    for (const Column& column : complex.edge_columns) {
      arrays.push_back({column.name, &column, nullptr});
      edge_names.emplace_back(column.name, column.name);
    }
    for (const Column& column : complex.triangle_columns) {
      const auto same =
          std::find_if(arrays.begin(), arrays.end(), [&](const CellColumn& c) { return c.name == column.name; });
      if (same != arrays.end() && same->edges != nullptr && is_alike(*same->edges, column)) {
        same->triangles = &column;
        triangle_names.emplace_back(column.name, column.name);
      } else {
        arrays.push_back({unused_name(complex, column), nullptr, &column});
        triangle_names.emplace_back(column.name, arrays.back().name);
      }
    }
  }

 private:
  /// The column's own name, unless another column of the complex's cells has it.
  [[nodiscard]] std::string unused_name(const Complex& complex, const Column& column) const {
    if (complex.edge_columns.find(column.name) == nullptr && !has(column.name)) return column.name;
    std::string name = "triangle_" + column.name;
    while (complex.edge_columns.find(name) != nullptr || complex.triangle_columns.find(name) != nullptr || has(name)) {
      name += "_";
    }
    return name;
  }
  [[nodiscard]] bool has(const std::string& name) const {
    return std::any_of(arrays.begin(), arrays.end(), [&](const CellColumn& c) { return c.name == name; });
  }
};

/// The numbers of single vertices in the type of a column of the same name, where that may hold them.
template <class T>
std::vector<T> numbers_of_verts(const Columns& columns, const std::string& name, std::size_t components,
                                std::span<const std::uint32_t> verts) {
  std::vector<T> out(verts.size() * components, fill_value<T>);
  const Column* column = columns.find(name);
  if (column == nullptr || column->components != components) return out;
  std::visit(
      [&]<class From>(const std::vector<From>& values) {
        if constexpr (std::is_floating_point_v<T> || (!std::is_floating_point_v<From> && sizeof(From) <= sizeof(T))) {
          for (std::size_t i = 0; i < out.size(); ++i) {
            out[i] = static_cast<T>(values[verts[i / components] * components + i % components]);
          }
        }
      },
      column->values);
  return out;
}

OutArray cell_array(const CellColumn& cell, const Complex& complex, std::span<const std::uint32_t> verts) {
  const Column& any = cell.any();
  const std::size_t components = any.components;
  const std::uint64_t cells = verts.size() + complex.edges.size() + complex.triangles.size();
  return {cell.name, scalar_type(any), components, cells * components,
          [&complex, cell, verts, components](const Put& put) {
            std::visit(
                [&]<class T>(const std::vector<T>&) {
                  const std::vector<T> of_verts =
                      numbers_of_verts<T>(complex.vertex_columns, cell.any().name, components, verts);
                  put_numbers(put, std::span<const T>(of_verts));
                  const auto put_column = [&](const Column* column, std::size_t rows) {
                    if (column == nullptr) return put_fill(put, fill_value<T>, rows * components);
                    put_numbers(put, std::span<const T>(std::get<std::vector<T>>(column->values)));
                  };
                  put_column(cell.edges, complex.edges.size());
                  put_column(cell.triangles, complex.triangles.size());
                },
                cell.any().values);
          }};
}

Section cells(const std::string& tag, std::uint64_t corners, std::uint64_t count,
              std::function<std::uint32_t(std::uint64_t)> corner) {
  Section section{tag, {}};
  section.arrays.push_back({"connectivity", ScalarType::i64, 1, count * corners,
                            [count, corners, corner = std::move(corner)](const Put& put) {
                              put_integers(put, count * corners, [&](std::uint64_t i) { return corner(i); });
                            }});
  section.arrays.push_back(
      {"offsets", ScalarType::i64, 1, count, [count, corners](const Put& put) {
         put_integers(put, count, [&](std::uint64_t i) { return static_cast<std::int64_t>((i + 1) * corners); });
       }});
  return section;
}

/// VTK shows the first array of one component.
std::string point_data_tag(const Columns& columns) {
  for (const Column& column : columns) {
    if (column.components == 1) return "PointData Scalars=\"" + column.name + "\"";
  }
  return "PointData";
}

/// All refer to the complex and the other arguments.
std::vector<Section> sections_of(const Complex& complex, const std::vector<CellColumn>& columns,
                                 std::span<const std::uint32_t> verts) {
  std::vector<Section> out{{point_data_tag(complex.vertex_columns), {}}, {"CellData", {}}, {"Points", {}}};
  for (const Column& column : complex.vertex_columns) out[0].arrays.push_back(whole_column(column));
  for (const CellColumn& column : columns) out[1].arrays.push_back(cell_array(column, complex, verts));
  out[2].arrays.push_back({"Points", ScalarType::f64, 3, 3 * complex.positions.size(),
                           [&complex](const Put& put) { put(std::as_bytes(std::span(complex.positions))); }});
  out.push_back(cells("Verts", 1, verts.size(), [verts](std::uint64_t i) { return verts[i]; }));
  out.push_back(
      cells("Lines", 2, complex.edges.size(), [&complex](std::uint64_t i) { return complex.edges[i / 2][i % 2]; }));
  out.push_back(cells("Polys", 3, complex.triangles.size(),
                      [&complex](std::uint64_t i) { return complex.triangles[i / 3][i % 3]; }));
  return out;
}
static_assert(sizeof(Vec3d) == 3 * sizeof(double));

std::string opening_text(const Complex& complex, std::size_t verts, const CellColumns& columns,
                         const FileMetadata& metadata) {
  std::string fields;
  if (!metadata.empty()) fields += volume_io::vtk_string_array("metadata", volume_io::to_json(metadata));
  fields += volume_io::vtk_string_array("edge_columns", volume_io::to_json(columns.edge_names));
  fields += volume_io::vtk_string_array("triangle_columns", volume_io::to_json(columns.triangle_names));
  return volume_io::vtk_opening("PolyData") + "  <PolyData>\n    <FieldData>\n" + fields +
         "    </FieldData>\n    <Piece NumberOfPoints=\"" + std::to_string(complex.positions.size()) +
         "\" NumberOfVerts=\"" + std::to_string(verts) + "\" NumberOfLines=\"" + std::to_string(complex.edges.size()) +
         "\" NumberOfStrips=\"0\" NumberOfPolys=\"" + std::to_string(complex.triangles.size()) + "\">\n";
}

}  // namespace

void write_vtp(const std::filesystem::path& path, const Complex& complex, const FileMetadata& metadata,
               const ComplexWriteOptions&, const Context& context) {
  const std::vector<std::uint32_t> verts = isolated_vertices(complex.view());
  const CellColumns columns(complex);
  const std::vector<Section> sections = sections_of(complex, columns.arrays, verts);
  std::string text = opening_text(complex, verts.size(), columns, metadata);
  std::uint64_t offset = 0;
  for (const Section& section : sections) {
    text += "      <" + section.tag + ">\n";
    for (const OutArray& array : section.arrays) {
      text += volume_io::vtk_appended_array(array.type, array.name, array.components, offset);
      offset += sizeof(std::uint64_t) + array.size();
    }
    text += "      </" + section.tag.substr(0, section.tag.find(' ')) + ">\n";
  }
  AtomicFile file(path);
  volume_io::FieldSink sink(offset, context);
  sink.write(file, text + "    </Piece>\n  </PolyData>\n  <AppendedData encoding=\"raw\">\n_");
  const Put put = [&](std::span<const std::byte> bytes) { sink.write(file, bytes); };
  for (const Section& section : sections) {
    for (const OutArray& array : section.arrays) {
      const std::uint64_t size = array.size();
      put(std::as_bytes(std::span(&size, 1)));
      array.write(put);
    }
  }
  sink.write(file, "\n  </AppendedData>\n</VTKFile>\n");
  file.commit();
}

}  // namespace blum::complex_files

namespace blum::formats {

constinit const ComplexCode complex_vtp{complex_files::read_vtp, nullptr, complex_files::write_vtp};

}  // namespace blum::formats
