#include <string>
#include <vector>

#include "io/format_table.hpp"
#include "io/mesh/mesh_builder.hpp"
#include "io/text/row_writer.hpp"
#include "io/text/text_cursor.hpp"

namespace blum {
namespace {

class ObjReader {
 public:
  ObjReader(std::string_view text, std::string_view name) : begin_(text.data()), cursor_(text, name, '#', '\\') {}

  MeshFile read() {
    while (cursor_.skip_space()) {
      read_statement();
      cursor_.skip_line();
    }
    if (builder_.vertex_count() == 0) cursor_.fail("the file ends without a vertex ('v x y z'): is it an OBJ mesh?");
    if (const auto bad = builder_.bad_index()) {
      cursor_.fail_at(begin_ + bad->where, "vertex " + std::to_string(bad->index + std::size_t{1}) +
                                               " is used, but the file has only " +
                                               std::to_string(builder_.vertex_count()) + " vertices");
    }
    return builder_.finish(false);
  }

 private:
  /// Reads one line. All keywords that Blum uses have one letter.
  void read_statement() {
    const std::string_view keyword = cursor_.peek_token();
    if (keyword.size() != 1) return;
    const std::size_t where = static_cast<std::size_t>(cursor_.position() - begin_);
    cursor_.take_token();
    switch (keyword.front()) {
      case 'v':
        return read_vertex();
      case 'f':
        return read_face(where);
      case 'l':
        return read_line(where);
      case 'p':
        return read_points(where);
      default:
        return;
    }
  }

  void read_vertex() {
    const double x = cursor_.take_number("x coordinate");
    const double y = cursor_.take_number("y coordinate");
    const double z = cursor_.take_number("z coordinate");
    if (builder_.vertex_count() == max_id_count) cursor_.fail("too many vertices: 2^31 - 1 are the most");
    builder_.add_vertex({x, y, z});
  }

  void read_face(std::size_t where) {
    read_indices();
    if (indices_.size() < 3) {
      cursor_.fail_at(begin_ + where,
                      "a face of " + std::to_string(indices_.size()) + " corners: it must have 3 or more");
    }
    builder_.add_face(indices_, where);
  }

  void read_line(std::size_t where) {
    read_indices();
    if (indices_.size() < 2) {
      cursor_.fail_at(begin_ + where,
                      "a line of " + std::to_string(indices_.size()) + " points: it must have 2 or more");
    }
    for (std::size_t i = 1; i < indices_.size(); ++i) builder_.add_segment(indices_[i - 1], indices_[i], where);
  }

  void read_points(std::size_t where) {
    read_indices();
    for (const std::uint32_t index : indices_) builder_.add_point(index, where);
  }

  void read_indices() {
    indices_.clear();
    while (!cursor_.at_line_end()) indices_.push_back(read_index());
  }

  /// Reads a corner i, i/t, i//n or i/t/n. Only the vertex i is used, but the other parts must be well-formed.
  std::uint32_t read_index() {
    const char* const start = cursor_.position();
    const std::int64_t number = cursor_.take_integer_prefix("vertex index");
    const std::string_view rest = cursor_.take_token();
    if (!rest.empty() && (rest.front() != '/' || rest.find_first_not_of("/+-0123456789") != std::string_view::npos)) {
      cursor_.fail_at(start, "vertex index is not of the form v, v/vt, v//vn or v/vt/vn: " +
                                 in_quotes({start, static_cast<std::size_t>(cursor_.position() - start)}));
    }
    const auto count = static_cast<std::int64_t>(builder_.vertex_count());
    if (number == 0) cursor_.fail_at(start, "vertex index 0: indices count from 1, or from -1 backwards");
    if (number < 0) {
      if (number < -count) {
        cursor_.fail_at(start, "vertex index " + std::to_string(number) + ", but only " + std::to_string(count) +
                                   " vertices come before it");
      }
      return static_cast<std::uint32_t>(count + number);
    }
    if (number > static_cast<std::int64_t>(max_id_count)) {
      cursor_.fail_at(start, "vertex index " + std::to_string(number) + " is out of range");
    }
    return static_cast<std::uint32_t>(number - 1);
  }

  const char* begin_;
  TextCursor cursor_;
  MeshBuilder builder_;
  std::vector<std::uint32_t> indices_;
};

MeshFile read_obj(std::string_view text, std::string_view name) {
  return ObjReader(text, name).read();
}

void write_obj(const std::filesystem::path& path, const MeshView& mesh) {
  RowWriter out(path);
  for (const Vec3d& v : mesh.vertices) {
    out.text("v");
    out.vector(v);
    out.text("\n");
  }
  const auto write_all = [&](std::string_view keyword, const auto& items) {
    for (const auto& item : items) {
      out.text(keyword);
      for (const std::uint32_t index : item) out.number(std::uint64_t{index} + 1);
      out.text("\n");
    }
  };
  write_all("f", mesh.triangles);
  write_all("l", mesh.segments);
  for (const std::uint32_t index : mesh.points) {
    out.text("p");
    out.number(std::uint64_t{index} + 1);
    out.text("\n");
  }
  out.finish();
}

bool begins_as_obj(std::string_view head) {
  return head.starts_with("v ") || head.find("\nv ") != std::string_view::npos;
}

}  // namespace

constinit const formats::MeshCode formats::mesh_obj{read_obj, write_obj, {begins_as_obj}};

}  // namespace blum
