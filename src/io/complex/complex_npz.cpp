// Indices are stored as int32. All ids of Blum fit, and NumPy accepts any integer type as index. Differences of int32
// indices are correct; differences of unsigned indices are not.
#include <algorithm>
#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "blum/core/error.hpp"
#include "blum/core/ids.hpp"
#include "io/archive/numpy.hpp"
#include "io/archive/zip.hpp"
#include "io/complex/complex_files.hpp"
#include "io/format_table.hpp"
#include "io/text/json.hpp"

namespace blum::complex_files {
namespace {

using volume_io::ByteStream;
using volume_io::NpyHeader;
using volume_io::NpzReader;
using volume_io::NpzWriter;

constexpr std::array<std::string_view, 3> kinds{"vertex_", "edge_", "triangle_"};
constexpr std::array<std::string_view, 5> own_arrays{"vertices", "edges", "triangles", "metadata", "distance"};
constexpr std::string_view further_mark = "_vertices";

/// Returns true if a vertex column's array can have the column's name without a prefix.
bool is_plain(std::string_view name, const std::vector<NamedComplexRef>& further) {
  const auto begins = [&](std::string_view start) { return name.starts_with(start); };
  return std::none_of(kinds.begin(), kinds.end(), begins) &&
         std::find(own_arrays.begin(), own_arrays.end(), name) == own_arrays.end() && !name.ends_with(further_mark) &&
         std::none_of(further.begin(), further.end(), [&](const NamedComplexRef& f) { return begins(f.name + "_"); });
}

/// Writer of the arrays of a complex. Their names start with the name of the complex.
class ComplexNpzWriter {
 public:
  ComplexNpzWriter(NpzWriter& npz, const std::vector<NamedComplexRef>& further) : npz_(npz), further_(further) {}

  void write(const std::string& prefix, const Complex& complex) {
    const std::span<const Vec3d> positions(complex.positions);
    npz_.add(prefix + "vertices", "f8", {positions.size(), 3}, positions);
    for (const Column& column : complex.vertex_columns) {
      write_column(npz_, prefix + (is_plain(column.name, further_) ? "" : "vertex_") + column.name, column);
    }
    add_cells(prefix + "edges", complex.edges);
    for (const Column& column : complex.edge_columns) write_column(npz_, prefix + "edge_" + column.name, column);
    add_cells(prefix + "triangles", complex.triangles);
    for (const Column& column : complex.triangle_columns)
      write_column(npz_, prefix + "triangle_" + column.name, column);
  }

 private:
  template <std::size_t n>
  void add_cells(const std::string& array, const std::vector<std::array<std::uint32_t, n>>& cells) {
    std::vector<std::int32_t> corners;
    corners.reserve(n * cells.size());
    for (const auto& cell : cells) {
      for (const std::uint32_t v : cell) corners.push_back(static_cast<std::int32_t>(v));
    }
    npz_.add(array, "i4", {cells.size(), n}, std::span<const std::int32_t>(corners));
  }

  NpzWriter& npz_;
  const std::vector<NamedComplexRef>& further_;
};
static_assert(sizeof(Vec3d) == 3 * sizeof(double));

std::uint64_t bytes_of(const Columns& columns) {
  std::uint64_t bytes = 0;
  for (const Column& column : columns) {
    bytes += column.rows() * column.components * volume_io::scalar_size(scalar_type(column));
  }
  return bytes;
}
std::uint64_t bytes_of(const Complex& complex) {
  return 24 * complex.positions.size() + 8 * complex.edges.size() + 12 * complex.triangles.size() +
         bytes_of(complex.vertex_columns) + bytes_of(complex.edge_columns) + bytes_of(complex.triangle_columns);
}

std::string shape_text(const std::vector<std::uint64_t>& shape) {
  std::string out;
  for (const std::uint64_t n : shape) out += (out.empty() ? "" : ", ") + std::to_string(n);
  return "[" + out + "]";
}

class ComplexNpzReader {
 public:
  explicit ComplexNpzReader(const volume_io::ByteSource& source) : source_(source), npz_(source) {}

  ComplexFile read() {
    if (npz_.has("distance") && npz_.has("vertex_distance")) {
      throw FormatError(source_.name() + ": it holds a surface map (array 'vertex_distance'), not a complex");
    }
    // Fields of meshes also have an array 'vertices', so 'distance' is tested first.
    if (npz_.has("distance")) {
      throw FormatError(source_.name() + ": it holds a distance field (array 'distance'), not a complex");
    }
    std::vector<std::string> arrays = npz_.arrays();
    check_sizes(arrays.size());
    ComplexFile file;
    for (const std::string& name : further_names(arrays)) {
      std::vector<std::string> own;  // arrays of this complex, without the complex's name as prefix
      std::erase_if(arrays, [&](const std::string& array) {
        if (!array.starts_with(name + "_")) return false;
        own.push_back(array.substr(name.size() + 1));
        return true;
      });
      file.further.push_back({name, read_complex(name + "_", own)});
    }
    file.complex = read_complex("", arrays);
    if (npz_.has("metadata")) file.metadata = volume_io::from_json(npz_.text("metadata"), source_.name());
    return file;
  }

 private:
  [[nodiscard]] std::string where(const std::string& array) const { return source_.name() + "(" + array + ".npy)"; }
  [[noreturn]] void fail(const std::string& array, const std::string& reason) const {
    throw FormatError(where(array) + ": " + reason);
  }

  /// Throws if entries overlap, because reading them could exhaust memory.
  void check_sizes(std::size_t arrays) const {
    constexpr std::size_t most = 8 * max_file_columns;
    if (arrays > most) throw FormatError(source_.name() + ": it has too many arrays");
    if (npz_.packed_size() > source_.size()) {
      throw FormatError(source_.name() + ": its entries have more bytes than the file; it is damaged");
    }
  }

  [[nodiscard]] std::vector<std::string> further_names(const std::vector<std::string>& arrays) const {
    std::vector<std::string> names;
    for (const std::string& array : arrays) {
      const auto begins = [&](std::string_view start) { return array.starts_with(start); };
      if (!array.ends_with(further_mark) || std::any_of(kinds.begin(), kinds.end(), begins)) continue;
      std::string name = array.substr(0, array.size() - further_mark.size());
      if (name.empty() || name.find('_') != std::string::npos) continue;
      check_name(name, "complex", where(array));
      if (name.size() > max_file_name) {
        fail(array.substr(0, max_file_name), "the name of a complex has more than " + std::to_string(max_file_name) +
                                                 " characters; rename it in the program that wrote the file");
      }
      names.push_back(std::move(name));
    }
    return names;
  }

  Complex read_complex(const std::string& prefix, const std::vector<std::string>& arrays) {
    Complex complex;
    const std::string vertices = prefix + "vertices";
    const VoxelImage::Values places = items(vertices, 3);
    const std::size_t count = std::visit([](const auto& v) { return v.size(); }, places) / 3;
    if (count > max_id_count) fail(vertices, "too many vertices: 2^31 - 1 are the most");
    complex.positions.resize(count);
    for_each_number(places, [&](std::size_t i, double value) { complex.positions[i / 3][i % 3] = value; });
    read_cells(prefix + "edges", complex.edges, count);
    read_cells(prefix + "triangles", complex.triangles, count);
    complex.vertex_columns = Columns(count);
    complex.edge_columns = Columns(complex.edges.size());
    complex.triangle_columns = Columns(complex.triangles.size());
    for (const std::string& array : arrays) {
      if (std::find(own_arrays.begin(), own_arrays.end(), array) != own_arrays.end()) continue;
      if (array.starts_with(kinds[0])) {
        read_column(complex.vertex_columns, prefix, array, kinds[0].size());
      } else if (array.starts_with(kinds[1])) {
        read_column(complex.edge_columns, prefix, array, kinds[1].size());
      } else if (array.starts_with(kinds[2])) {
        read_column(complex.triangle_columns, prefix, array, kinds[2].size());
      } else {
        read_column(complex.vertex_columns, prefix, array, 0);
      }
    }
    return complex;
  }

  /// Reads an array of n items with the given number of components. n can be any number.
  VoxelImage::Values items(const std::string& array, std::uint64_t components) {
    return npz_.read(array, [&](ByteStream& stream, const NpyHeader& header) {
      if (header.shape.size() != 2 || header.shape[1] != components) {
        throw FormatError(stream.name() + ": its shape is " + shape_text(header.shape) + ", but should be [n, " +
                          std::to_string(components) + "]");
      }
      return volume_io::read_npy_values(stream, header);
    });
  }

  /// Reads the corners of cells. All must be less than `count`. If the array is missing, there are no cells.
  template <std::size_t n>
  void read_cells(const std::string& array, std::vector<std::array<std::uint32_t, n>>& cells, std::size_t count) {
    if (!npz_.has(array)) return;
    const VoxelImage::Values values = items(array, n);
    cells.resize(std::visit([](const auto& v) { return v.size(); }, values) / n);
    for_each_integer(values, where(array), [&](std::size_t i, std::int64_t vertex) {
      if (vertex < 0 || std::cmp_greater_equal(vertex, count)) {
        fail(array, "vertex " + std::to_string(vertex) + " is used, but there are only " + std::to_string(count) +
                        " vertices");
      }
      cells[i / n][i % n] = static_cast<std::uint32_t>(vertex);
    });
  }

  /// @param mark  number of characters of the array's name before the column's name.
  void read_column(Columns& columns, const std::string& prefix, const std::string& array, std::size_t mark) {
    std::uint64_t components = 1;
    VoxelImage::Values values = npz_.read(prefix + array, [&](ByteStream& stream, const NpyHeader& header) {
      const std::uint64_t rows = columns.rows();
      if (header.shape.empty() || header.shape[0] != rows) {
        throw FormatError(
            stream.name() + ": its shape is " + shape_text(header.shape) + ", but should be [" + std::to_string(rows) +
            "] or [" + std::to_string(rows) + ", components]" +
            (mark > 0 ? ": by its name it is a column, one row for each " + array.substr(0, mark - 1) : ""));
      }
      for (std::size_t axis = 1; axis < header.shape.size(); ++axis) {
        components *= std::min<std::uint64_t>(header.shape[axis], max_file_columns + 1);
        components = std::min<std::uint64_t>(components, max_file_columns + 1);
      }
      if (components == 0 || components > max_file_columns) {
        throw FormatError(stream.name() + ": its shape is " + shape_text(header.shape) + "; 1 to " +
                          std::to_string(max_file_columns) + " numbers a row are read");
      }
      return volume_io::read_npy_values(stream, header);
    });
    const std::string place = where(prefix + array);
    add_column(columns, {array.substr(mark), components, widened(std::move(values), place)}, place);
  }

  const volume_io::ByteSource& source_;
  NpzReader npz_;
};

/// Tests if an archive contains a complex. Returns false for a damaged archive; the archive's reader reports the
/// damage.
bool holds_complex(std::string_view, const std::filesystem::path& path) {
  try {
    const volume_io::FileSource source(path, volume_io::PipeUse::keep);
    const NpzReader npz(source);
    return npz.has("vertices") && !npz.has("distance");
  } catch (const FormatError&) {
    return false;
  }
}

}  // namespace

void write_npz(const std::filesystem::path& path, const Complex& complex, const FileMetadata& metadata,
               const ComplexWriteOptions& options, const Context& context) {
  std::uint64_t bytes = bytes_of(complex);
  for (const NamedComplexRef& further : options.further) bytes += bytes_of(*further.complex);
  AtomicFile file(path);
  volume_io::FieldSink sink(bytes, context);
  NpzWriter npz(file, sink, context);
  ComplexNpzWriter(npz, options.further).write("", complex);
  for (const NamedComplexRef& further : options.further) {
    const std::vector<NamedComplexRef> none;
    ComplexNpzWriter(npz, none).write(further.name + "_", *further.complex);
  }
  if (!metadata.empty()) npz.add_text("metadata", volume_io::to_json(metadata));
  npz.finish();
  file.commit();
}

ComplexFile read_npz(const volume_io::ByteSource& source) {
  return ComplexNpzReader(source).read();
}

}  // namespace blum::complex_files

namespace blum::formats {

constinit const ComplexCode complex_npz{complex_files::read_npz,
                                        nullptr,
                                        complex_files::write_npz,
                                        {volume_io::begins_as_zip, complex_files::holds_complex},
                                        true};

}  // namespace blum::formats
