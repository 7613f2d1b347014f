#include <algorithm>
#include <string>
#include <vector>

#include "io/format_table.hpp"
#include "io/mesh/mesh_builder.hpp"
#include "io/text/row_writer.hpp"
#include "io/text/text_cursor.hpp"

namespace blum {
namespace {

class OffReader {
 public:
  OffReader(std::string_view text, std::string_view name) : begin_(text.data()), cursor_(text, name, '#') {}

  MeshFile read() {
    read_header();
    const std::size_t vertices = read_count("number of vertices");
    const std::size_t faces = read_count("number of faces");
    cursor_.skip_line();  // the number of edges, which is not needed
    if (vertices == 0) cursor_.fail("the mesh has no vertices");
    // Every vertex takes at least 6 bytes, and every face at least 8 (the last one 7). So headers that promise too much
    // are rejected before memory is allocated.
    if (vertices > max_id_count || vertices > cursor_.remaining() / 6 + 1) too_many("vertices", vertices);
    builder_.reserve_vertices(vertices);
    for (std::size_t i = 0; i < vertices; ++i) read_vertex(i, vertices);
    if (faces > cursor_.remaining() / 7 + 1) too_many("faces", faces);
    builder_.reserve_triangles(faces);
    for (std::size_t i = 0; i < faces; ++i) read_face(i, faces);
    if (cursor_.skip_space()) {
      cursor_.fail("the file goes on after the last of " + std::to_string(faces) +
                   " faces: the counts in its header are wrong, or a line is broken in two");
    }
    return builder_.finish(false);
  }

 private:
  /// Reads the keyword [ST][C][N][4][n]OFF. The keyword may be missing. Points with more than 3 dimensions are
  /// rejected.
  void read_header() {
    if (!cursor_.skip_space()) cursor_.fail("the file is empty");
    const char* const start = cursor_.position();
    const std::string_view keyword = cursor_.take_token();
    if (!keyword.ends_with("OFF")) {
      if (keyword.find_first_not_of("0123456789") != std::string_view::npos) {
        cursor_.fail_at(start, "an OFF file must begin with 'OFF', but it begins with " + in_quotes(keyword));
      }
      cursor_.set_position(start);
      return;
    }
    std::string_view prefix = keyword.substr(0, keyword.size() - 3);
    for (const std::string_view part : {"ST", "C", "N"}) {
      if (prefix.starts_with(part)) prefix.remove_prefix(part.size());
    }
    if (prefix == "4" || prefix == "n" || prefix == "4n") {
      cursor_.fail_at(start, in_quotes(keyword) + " holds points of more than 3 dimensions, which Blum does not read");
    }
    if (!prefix.empty()) cursor_.fail_at(start, "unknown kind of OFF file: " + in_quotes(keyword));
    cursor_.skip_blanks();
    if (cursor_.peek_token() == "BINARY") {
      cursor_.fail("binary OFF is not supported: convert the file to text OFF or to PLY");
    }
  }

  std::size_t read_count(std::string_view what) {
    cursor_.skip_space();
    const std::int64_t count = cursor_.take_integer(what);
    if (count < 0) cursor_.fail(std::string(what) + " is negative: " + std::to_string(count));
    return static_cast<std::size_t>(count);
  }

  [[noreturn]] void too_many(std::string_view what, std::size_t count) const {
    cursor_.fail("the header promises " + std::to_string(count) + " " + std::string(what) +
                 ", but the file is too short for them");
  }

  void require_more(std::string_view what, std::size_t done, std::size_t count) {
    if (cursor_.skip_space()) return;
    cursor_.fail("the file ends after " + std::to_string(done) + " of " + std::to_string(count) + " " +
                 std::string(what));
  }

  void read_vertex(std::size_t index, std::size_t count) {
    require_more("vertices", index, count);
    const double x = cursor_.take_number("x coordinate");
    const double y = cursor_.take_number("y coordinate");
    const double z = cursor_.take_number("z coordinate");
    builder_.add_vertex({x, y, z});
    cursor_.skip_line();  // skips normals and colours
  }

  void read_face(std::size_t index, std::size_t count) {
    require_more("faces", index, count);
    const char* const start = cursor_.position();
    const std::int64_t corners = cursor_.take_integer("number of corners");
    if (corners < 3) {
      cursor_.fail_at(start, "a face of " + std::to_string(corners) + " corners: it must have 3 or more");
    }
    if (static_cast<std::uint64_t>(corners) > cursor_.remaining() / 2 + 1) {
      cursor_.fail_at(start, "a face of " + std::to_string(corners) + " corners, but the file is too short for them");
    }
    indices_.clear();
    for (std::int64_t i = 0; i < corners; ++i) indices_.push_back(read_index());
    builder_.add_face(indices_, static_cast<std::size_t>(start - begin_));
    cursor_.skip_line();  // skips colours
  }

  std::uint32_t read_index() {
    cursor_.skip_space();  // the indices of a long face may be on several lines
    const char* const start = cursor_.position();
    const std::int64_t vertex = cursor_.take_integer("vertex index");
    if (vertex < 0 || static_cast<std::uint64_t>(vertex) >= builder_.vertex_count()) {
      cursor_.fail_at(start, "vertex index " + std::to_string(vertex) + " is out of range: indices go from 0 to " +
                                 std::to_string(builder_.vertex_count() - 1));
    }
    return static_cast<std::uint32_t>(vertex);
  }

  const char* begin_;
  TextCursor cursor_;
  MeshBuilder builder_;
  std::vector<std::uint32_t> indices_;
};

MeshFile read_off(std::string_view text, std::string_view name) {
  return OffReader(text, name).read();
}

void write_off(const std::filesystem::path& path, const MeshView& mesh) {
  if (!mesh.segments.empty()) cannot_hold(path, "OFF", "segments");
  refuse_points(path, "OFF", mesh);
  RowWriter out(path);
  out.text("OFF\n" + std::to_string(mesh.vertices.size()) + " " + std::to_string(mesh.triangles.size()) + " 0\n");
  for (const Vec3d& v : mesh.vertices) {
    out.vector(v);
    out.text("\n");
  }
  for (const Triangle& t : mesh.triangles) {
    out.text("3");
    for (const std::uint32_t index : t) out.number(index);
    out.text("\n");
  }
  out.finish();
}

bool begins_as_off(std::string_view head) {
  return head.starts_with("OFF") || head.starts_with("COFF") || head.starts_with("NOFF");
}

}  // namespace

constinit const formats::MeshCode formats::mesh_off{read_off, write_off, {begins_as_off}};

}  // namespace blum
