#include <algorithm>
#include <string>
#include <vector>

#include "io/format_table.hpp"
#include "io/mesh/mesh_builder.hpp"
#include "io/text/ply.hpp"
#include "io/text/row_writer.hpp"
#include "io/text/text_cursor.hpp"

namespace blum {
namespace {

/// Meaning of a property for the mesh.
enum class Role { ignored, x, y, z, corners, first, second };

/// Reader of the elements of a PLY file. `Source` is PlyText or PlyBinary, which reads the values.
template <class Source>
class PlyReader {
 public:
  PlyReader(const PlyHeader& header, Source source) : header_(header), source_(source) {}

  MeshFile read() {
    for (const PlyElement& element : header_.elements) read_element(element);
    source_.expect_end();
    if (builder_.vertex_count() == 0) source_.fail("the mesh has no vertices");
    if (const auto bad = builder_.bad_index()) {
      source_.fail_at(bad->where, "vertex " + std::to_string(bad->index) + " is used, but the file has only " +
                                      std::to_string(builder_.vertex_count()) + " vertices (counted from 0)");
    }
    return builder_.finish(header_.encoding != PlyEncoding::text);
  }

 private:
  void read_element(const PlyElement& element) {
    if (element.properties.empty()) return;  // entries take no bytes, whatever their number
    const std::size_t least = std::max<std::size_t>(source_.least_size(element), 1);
    if (element.count > (source_.remaining() + 1) / least) {
      source_.fail("the header promises " + std::to_string(element.count) + " of element " + in_quotes(element.name) +
                   ", but the file is too short for them");
    }
    if (element.name == "vertex") return read_vertices(element);
    if (element.name == "face") return read_faces(element, false);
    if (element.name == "tristrips") return read_faces(element, true);
    if (element.name == "edge") return read_edges(element);
    for (std::size_t i = 0; i < element.count; ++i) {
      for (const PlyProperty& property : element.properties) source_.skip(property);
    }
  }

  void read_vertices(const PlyElement& element) {
    const std::vector<Role> roles = roles_of(element, {{"x", Role::x}, {"y", Role::y}, {"z", Role::z}}, false);
    if (element.count > max_id_count) source_.fail("too many vertices: 2^31 - 1 are the most");
    builder_.reserve_vertices(element.count);
    for (std::size_t i = 0; i < element.count; ++i) {
      Vec3d vertex;
      for (std::size_t k = 0; k < roles.size(); ++k) {
        if (roles[k] == Role::ignored) {
          source_.skip(element.properties[k]);
        } else {
          vertex[static_cast<std::size_t>(roles[k]) - static_cast<std::size_t>(Role::x)] =
              source_.number(element.properties[k].type, "coordinate");
        }
      }
      builder_.add_vertex(vertex);
    }
  }

  void read_faces(const PlyElement& element, bool strips) {
    const std::vector<Role> roles =
        roles_of(element, {{"vertex_indices", Role::corners}, {"vertex_index", Role::corners}}, true);
    if (!strips) builder_.reserve_triangles(element.count);
    for (std::size_t i = 0; i < element.count; ++i) {
      const std::size_t where = source_.where();
      for (std::size_t k = 0; k < roles.size(); ++k) {
        if (roles[k] == Role::ignored) {
          source_.skip(element.properties[k]);
        } else if (strips) {
          read_strip(element.properties[k], where);
        } else {
          read_face(element.properties[k], where);
        }
      }
    }
  }

  void read_face(const PlyProperty& property, std::size_t where) {
    const std::size_t count = source_.list_count(property);
    if (count < 3) {
      source_.fail_at(where, "a face of " + std::to_string(count) + " corners: it must have 3 or more");
    }
    if (count == 3) {
      const std::uint32_t a = index(property.type);
      const std::uint32_t b = index(property.type);
      const std::uint32_t c = index(property.type);
      return builder_.add_triangle({a, b, c}, where);
    }
    corners_.clear();
    for (std::size_t i = 0; i < count; ++i) corners_.push_back(index(property.type));
    builder_.add_face(corners_, where);
  }

  /// Reads strips of triangles, separated by -1. Each triangle shares an edge with the one before. In a strip, every
  /// other triangle has the opposite orientation.
  void read_strip(const PlyProperty& property, std::size_t where) {
    const std::size_t count = source_.list_count(property);
    std::size_t length = 0;
    Triangle last{};
    for (std::size_t i = 0; i < count; ++i) {
      const std::int64_t value = source_.integer(property.type, "vertex index");
      if (value == -1) {
        length = 0;
        continue;
      }
      last = {last[1], last[2], checked_index(value)};
      ++length;
      if (length < 3 || last[0] == last[1] || last[1] == last[2] || last[2] == last[0]) continue;
      builder_.add_triangle(length % 2 == 1 ? last : Triangle{last[1], last[0], last[2]}, where);
    }
  }

  void read_edges(const PlyElement& element) {
    const std::vector<Role> roles = roles_of(element, {{"vertex1", Role::first}, {"vertex2", Role::second}}, false);
    for (std::size_t i = 0; i < element.count; ++i) {
      const std::size_t where = source_.where();
      Segment ends{};
      for (std::size_t k = 0; k < roles.size(); ++k) {
        if (roles[k] == Role::ignored) {
          source_.skip(element.properties[k]);
        } else {
          ends[roles[k] == Role::first ? 0 : 1] = index(element.properties[k].type);
        }
      }
      builder_.add_segment(ends[0], ends[1], where);
    }
  }

  std::uint32_t index(PlyType type) { return checked_index(source_.integer(type, "vertex index")); }

  std::uint32_t checked_index(std::int64_t value) const {
    if (value < 0 || value >= static_cast<std::int64_t>(max_id_count)) {
      source_.fail("vertex index " + std::to_string(value) + " is out of range");
    }
    return static_cast<std::uint32_t>(value);
  }

  struct NamedRole {
    std::string_view name;
    Role role;
  };

  /// Returns the role of each property of an element.
  /// @throws FormatError if a role occurs twice or is missing, or if its property has the wrong type.
  std::vector<Role> roles_of(const PlyElement& element, const std::vector<NamedRole>& known, bool list) const {
    std::vector<Role> roles;
    for (const PlyProperty& property : element.properties) {
      Role role = Role::ignored;
      for (const NamedRole& candidate : known) {
        if (candidate.name == property.name) role = candidate.role;
      }
      if (role != Role::ignored) check_kind(element, property, list, list || element.name == "edge");
      roles.push_back(role);
    }
    for (const NamedRole& needed : known) {
      const auto count = std::count(roles.begin(), roles.end(), needed.role);
      if (count == 1) continue;
      source_.fail("element " + in_quotes(element.name) + " has " + (count == 0 ? "no" : "more than one") +
                   " property " + in_quotes(needed.name));
    }
    return roles;
  }

  void check_kind(const PlyElement& element, const PlyProperty& property, bool list, bool whole) const {
    const std::string where = "property " + in_quotes(property.name) + " of element " + in_quotes(element.name);
    if (property.is_list != list) source_.fail(where + (list ? " must be a list" : " must not be a list"));
    if (whole && is_floating(property.type)) source_.fail(where + " must be of a whole-number type");
  }

  const PlyHeader& header_;
  Source source_;
  MeshBuilder builder_;
  std::vector<std::uint32_t> corners_;
};

MeshFile read_ply(std::string_view bytes, std::string_view name) {
  const PlyHeader header = read_ply_header(bytes, name);
  if (header.encoding == PlyEncoding::text) return PlyReader<PlyText>(header, PlyText(bytes, header, name)).read();
  return PlyReader<PlyBinary>(header, PlyBinary(bytes, header, name)).read();
}

void write_ply(const std::filesystem::path& path, const MeshView& mesh) {
  refuse_points(path, "PLY", mesh);
  RowWriter out(path);
  out.text("ply\nformat binary_little_endian 1.0\nelement vertex " + std::to_string(mesh.vertices.size()) +
           "\nproperty double x\nproperty double y\nproperty double z\n");
  if (!mesh.triangles.empty()) {
    out.text("element face " + std::to_string(mesh.triangles.size()) + "\nproperty list uchar int vertex_indices\n");
  }
  if (!mesh.segments.empty()) {
    out.text("element edge " + std::to_string(mesh.segments.size()) + "\nproperty int vertex1\nproperty int vertex2\n");
  }
  out.text("end_header\n");
  for (const Vec3d& v : mesh.vertices) {
    for (std::size_t axis = 0; axis < 3; ++axis) out.bytes(v[axis]);
  }
  for (const Triangle& t : mesh.triangles) {
    out.bytes(std::uint8_t{3});
    for (const std::uint32_t index : t) out.bytes(index);
  }
  for (const Segment& s : mesh.segments) {
    for (const std::uint32_t index : s) out.bytes(index);
  }
  out.finish();
}

bool begins_as_ply(std::string_view head) {
  return head.starts_with("ply\n") || head.starts_with("ply\r");
}

}  // namespace

constinit const formats::MeshCode formats::mesh_ply{read_ply, write_ply, {begins_as_ply}};

}  // namespace blum
