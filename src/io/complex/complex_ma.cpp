// Text format of Q-MAT (Li et al. 2015) and of the Blender add-on for medial meshes. The add-on treats every line after
// the first as a vertex, edge or triangle, even a comment. The writer therefore writes no comments, so the file has no
// metadata.
#include <algorithm>
#include <array>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "blum/core/error.hpp"
#include "io/complex/complex_files.hpp"
#include "io/format_table.hpp"
#include "io/text/row_writer.hpp"
#include "io/text/text_cursor.hpp"

namespace blum::complex_files {
namespace {

constexpr std::string_view radius_column = "radius";

/// Reader. Vertices, edges and triangles may be in any order, because other programs may mix them. Further text on
/// their lines is ignored.
class MaReader {
 public:
  MaReader(std::string_view text, std::string_view name) : cursor_(text, name, '#') {}

  Complex read() {
    read_counts();
    while (cursor_.skip_space()) {
      read_statement();
      cursor_.skip_line();
    }
    check_count(complex_.positions.size(), 0, "vertices");
    check_count(complex_.edges.size(), 1, "edges");
    check_count(complex_.triangles.size(), 2, "triangles");
    complex_.vertex_columns = Columns(radii_.size());
    complex_.vertex_columns.add({std::string(radius_column), 1, std::move(radii_)});
    return std::move(complex_);
  }

 private:
  void read_counts() {
    if (!cursor_.skip_space()) cursor_.fail("the file must begin with the numbers of vertices, edges and triangles");
    // Lengths in bytes of the shortest lines with their line ends. The line "v 0 0 0 1" takes 10, "e 0 1" 6 and "f 0 1
    // 2" 8. The last line may lack its line end.
    constexpr std::array<std::uint64_t, 3> least{10, 6, 8};
    constexpr std::array<const char*, 3> what{"number of vertices", "number of edges", "number of triangles"};
    std::uint64_t needed = 0;
    for (std::size_t i = 0; i < 3; ++i) {
      const std::int64_t count = cursor_.take_integer(what[i]);
      if (count < 0) cursor_.fail(std::string("a negative ") + what[i]);
      counts_[i] = static_cast<std::uint64_t>(count);
      const std::uint64_t room = cursor_.remaining() + 1 - std::min<std::uint64_t>(needed, cursor_.remaining() + 1);
      if (counts_[i] > room / least[i]) {
        cursor_.fail("the file promises " + std::to_string(count) + " as " + what[i] + ", but is too short for them");
      }
      needed += counts_[i] * least[i];
    }
    if (counts_[0] > max_id_count) cursor_.fail("too many vertices: 2^31 - 1 are the most");
    cursor_.skip_line();
    complex_.positions.reserve(counts_[0]);
    radii_.reserve(counts_[0]);
    complex_.edges.reserve(counts_[1]);
    complex_.triangles.reserve(counts_[2]);
  }

  void read_statement() {
    const char* const start = cursor_.position();
    const std::string_view keyword = cursor_.take_token();
    if (keyword == "v") {
      read_vertex();
    } else if (keyword == "e") {
      complex_.edges.push_back(read_indices<2>());
    } else if (keyword == "f") {
      complex_.triangles.push_back(read_indices<3>());
    } else {
      cursor_.fail_at(start, "a line must begin with v, e or f, not with " + in_quotes(keyword));
    }
  }

  void read_vertex() {
    Vec3d& position = complex_.positions.emplace_back();
    position.x = cursor_.take_number("x coordinate");
    position.y = cursor_.take_number("y coordinate");
    position.z = cursor_.take_number("z coordinate");
    radii_.push_back(cursor_.take_number("radius"));
    if (radii_.back() < 0) cursor_.fail("a negative radius");
  }

  template <std::size_t n>
  std::array<std::uint32_t, n> read_indices() {
    std::array<std::uint32_t, n> out{};
    for (std::size_t i = 0; i < n; ++i) {
      const std::int64_t index = cursor_.take_integer("vertex index");
      if (index < 0 || static_cast<std::uint64_t>(index) >= counts_[0]) {
        cursor_.fail("vertex index " + std::to_string(index) + " is out of range: there are " +
                     std::to_string(counts_[0]) + " vertices, counted from 0");
      }
      out[i] = static_cast<std::uint32_t>(index);
      for (std::size_t k = 0; k < i; ++k) {
        if (out[k] == out[i]) cursor_.fail("vertex " + std::to_string(index) + " is used twice");
      }
    }
    return out;
  }

  void check_count(std::size_t have, std::size_t which, const char* what) const {
    if (have == counts_[which]) return;
    cursor_.fail("the file promises " + std::to_string(counts_[which]) + " " + what + ", but has " +
                 std::to_string(have));
  }

  TextCursor cursor_;
  Complex complex_;
  std::vector<double> radii_;
  std::array<std::uint64_t, 3> counts_{};  ///< numbers of vertices, edges and triangles
};

/// Writes positions, the vertex column `radius`, edges (including the sides of triangles) and triangles.
void write_ma(const std::filesystem::path& path, const Complex& complex, const FileMetadata& metadata,
              const ComplexWriteOptions& options, const Context& context) {
  const Column* const radius = complex.vertex_columns.find(radius_column);
  if (radius == nullptr || radius->components != 1 || !std::holds_alternative<std::vector<double>>(radius->values)) {
    throw InvalidOption("'" + path.string() + "': MA files hold a radius for each vertex, but the complex has no " +
                        "column 'radius' of one float64 for each; write .vtp, .ply or .npz");
  }
  refuse_loss(path, "MA", complex, metadata, options, radius_column);
  const EdgeSet edges(complex.view(), EdgeSet::Of::edges_and_triangles, context);
  const std::span<const double> radii = std::get<std::vector<double>>(radius->values);
  RowWriter out(path, complex.positions.size() + edges.size() + complex.triangles.size(), context);
  out.text(std::to_string(complex.positions.size()) + " " + std::to_string(edges.size()) + " " +
           std::to_string(complex.triangles.size()) + "\n");
  for (std::size_t v = 0; v < complex.positions.size(); ++v) {
    out.text("v");
    out.vector(complex.positions[v]);
    out.number(radii[v]);
    out.text("\n");
    out.end_row();
  }
  edges.for_each([&](std::uint32_t a, std::uint32_t b) {
    out.text("e");
    out.number(a);
    out.number(b);
    out.text("\n");
    out.end_row();
  });
  for (const auto& triangle : complex.triangles) {
    out.text("f");
    for (const std::uint32_t v : triangle) out.number(v);
    out.text("\n");
    out.end_row();
  }
  out.finish();
}

ComplexFile read_ma(std::string_view text, std::string_view name) {
  return {MaReader(text, name).read()};
}

}  // namespace
}  // namespace blum::complex_files

namespace blum::formats {

constinit const ComplexCode complex_ma{nullptr, complex_files::read_ma, complex_files::write_ma, {}, false, false};

}  // namespace blum::formats
