#include <bit>
#include <string>

#include "io/format_table.hpp"
#include "io/mesh/mesh_builder.hpp"
#include "io/mesh/mesh_stl.hpp"
#include "io/text/row_writer.hpp"
#include "io/text/text_cursor.hpp"

namespace blum {
namespace {

constexpr std::size_t header_size = 84;    // in bytes: 80 arbitrary bytes, and the number of triangles
constexpr std::size_t triangle_size = 50;  // in bytes: normal and corners as 12 floats, and 2 arbitrary bytes

std::uint32_t little_endian_word(const char* bytes) {
  std::uint32_t value = 0;
  for (int i = 3; i >= 0; --i) value = value << 8 | static_cast<unsigned char>(bytes[i]);
  return value;
}

float little_endian_float(const char* bytes) {
  return std::bit_cast<float>(little_endian_word(bytes));
}

class BinaryStlReader {
 public:
  BinaryStlReader(std::string_view bytes, std::string_view name) : bytes_(bytes), name_(name) {}

  MeshFile read() {
    const std::size_t count = little_endian_word(bytes_.data() + 80);
    const std::size_t expected = header_size + triangle_size * count;
    if (bytes_.size() != expected) {
      fail(bytes_.size(), "the header promises " + std::to_string(count) + " triangles, so " +
                              std::to_string(expected) + " bytes, but the file has " + std::to_string(bytes_.size()));
    }
    if (count == 0) fail(80, "the mesh has no triangles");
    if (3 * count > max_id_count) fail(80, "too many triangles: " + std::to_string(count));
    builder_.reserve_vertices(3 * count);
    builder_.reserve_triangles(count);
    for (std::size_t i = 0; i < count; ++i) read_triangle(header_size + i * triangle_size);
    return builder_.finish(true);
  }

 private:
  void read_triangle(std::size_t offset) {
    const auto first = static_cast<std::uint32_t>(builder_.vertex_count());
    for (std::size_t corner = 0; corner < 3; ++corner) {
      const std::size_t place = offset + 12 + 12 * corner;
      const char* const p = bytes_.data() + place;
      const Vec3d vertex{little_endian_float(p), little_endian_float(p + 4), little_endian_float(p + 8)};
      if (!is_finite(vertex)) {
        fail(place, "a coordinate of triangle " + std::to_string(first / 3) + " (counted from 0) is not finite");
      }
      builder_.add_vertex(vertex);
    }
    builder_.add_triangle({first, first + 1, first + 2}, offset);
  }

  [[noreturn]] void fail(std::size_t offset, const std::string& message) const {
    throw FormatError("'" + std::string(name_) + "', byte " + std::to_string(offset) + ": " + message);
  }

  std::string_view bytes_;
  std::string_view name_;
  MeshBuilder builder_;
};

bool same_word(std::string_view a, std::string_view lower_case) {
  if (a.size() != lower_case.size()) return false;
  for (std::size_t i = 0; i < a.size(); ++i) {
    const char c = a[i] >= 'A' && a[i] <= 'Z' ? static_cast<char>(a[i] - 'A' + 'a') : a[i];
    if (c != lower_case[i]) return false;
  }
  return true;
}

class TextStlReader {
 public:
  TextStlReader(std::string_view text, std::string_view name) : begin_(text.data()), cursor_(text, name, 0) {}

  MeshFile read() {
    cursor_.skip_space();
    do {
      read_solid();
    } while (cursor_.skip_space());
    if (builder_.face_count() == 0) cursor_.fail("the mesh has no triangles");
    return builder_.finish(false);
  }

 private:
  void read_solid() {
    expect("solid");
    cursor_.skip_line();  // the name of the solid
    while (true) {
      const std::string_view word = next_word("'facet' or 'endsolid'");
      if (same_word(word, "endsolid")) break;
      if (!same_word(word, "facet")) fail_word(word, "'facet' or 'endsolid'");
      read_facet();
    }
    cursor_.skip_line();  // the name of the solid
  }

  void read_facet() {
    expect("normal");
    // The normal is ignored: it is often wrong or not a number, and the corners define it.
    for (int i = 0; i < 3; ++i) next_word("a normal");
    expect("outer");
    expect("loop");
    if (builder_.vertex_count() + 3 > max_id_count) cursor_.fail("too many triangles");
    const auto first = static_cast<std::uint32_t>(builder_.vertex_count());
    for (int corner = 0; corner < 3; ++corner) {
      expect("vertex");
      Vec3d vertex;
      for (std::size_t axis = 0; axis < 3; ++axis) {
        cursor_.skip_space();
        vertex[axis] = cursor_.take_number("coordinate");
      }
      builder_.add_vertex(vertex);
    }
    builder_.add_triangle({first, first + 1, first + 2}, static_cast<std::size_t>(cursor_.position() - begin_));
    expect("endloop");
    expect("endfacet");
  }

  std::string_view next_word(std::string_view expected) {
    if (!cursor_.skip_space()) cursor_.fail("the file ends where " + std::string(expected) + " should be");
    return cursor_.take_token();
  }

  void expect(std::string_view word) {
    const std::string name = in_quotes(word);
    const std::string_view found = next_word(name);
    if (!same_word(found, word)) fail_word(found, name);
  }

  [[noreturn]] void fail_word(std::string_view found, std::string_view expected) const {
    cursor_.fail_at(found.data(), "expected " + std::string(expected) + ", found " + in_quotes(found));
  }

  const char* begin_;
  TextCursor cursor_;
  MeshBuilder builder_;
};

/// Returns true if a file has the size that follows from the number of triangles in its header.
bool has_stated_size(std::string_view head, std::uint64_t size) {
  return head.size() >= header_size &&
         size == header_size + std::uint64_t{triangle_size} * little_endian_word(head.data() + 80);
}

/// Returns true if the text begins with the word "solid".
bool begins_with_solid(std::string_view bytes) {
  TextCursor cursor(bytes.substr(0, 4096), "", 0);
  return cursor.skip_space() && same_word(cursor.take_token(), "solid");
}

/// Returns true if a file is binary. A file whose size agrees with the number of triangles in its header is binary,
/// even if it starts with "solid". Any other file is text if it starts with "solid" and has no zero byte near its
/// start.
bool is_binary(std::string_view bytes) {
  if (has_stated_size(bytes, bytes.size())) return true;
  if (!begins_with_solid(bytes)) return true;
  return bytes.substr(0, 1024).find('\0') != std::string_view::npos;
}

MeshFile read_stl(std::string_view bytes, std::string_view name) {
  if (!is_binary(bytes)) return TextStlReader(bytes, name).read();
  if (bytes.size() < header_size) {
    throw FormatError("'" + std::string(name) + "', byte " + std::to_string(bytes.size()) +
                      ": the file is neither text STL (it does not begin with 'solid') nor binary STL (it is shorter "
                      "than a header of 84 bytes)");
  }
  return BinaryStlReader(bytes, name).read();
}

/// Returns the unit normal of a triangle; zero if the triangle is degenerate.
Vec3d normal_of(const Vec3d& a, const Vec3d& b, const Vec3d& c) {
  const Vec3d u = b - a;
  const Vec3d v = c - a;
  const double size =
      std::max({std::abs(u.x), std::abs(u.y), std::abs(u.z), std::abs(v.x), std::abs(v.y), std::abs(v.z)});
  if (!(size > 0) || !std::isfinite(size)) return {};
  const Vec3d normal = cross(u / size, v / size);
  const double norm = length(normal);
  return norm > 0 ? normal / norm : Vec3d{};
}

void write_stl(const std::filesystem::path& path, const MeshView& mesh) {
  if (!mesh.segments.empty()) cannot_hold(path, "STL", "segments");
  if (!mesh.points.empty()) cannot_hold(path, "STL", "points");
  for (const Triangle& t : mesh.triangles) {
    for (const std::uint32_t index : t) {
      const Vec3d& v = mesh.vertices[index];
      if (std::max({std::abs(v.x), std::abs(v.y), std::abs(v.z)}) <= double{std::numeric_limits<float>::max()})
        continue;
      throw FileError("cannot write '" + path.string() + "': vertex " + std::to_string(index) +
                      " is too far from the origin for the single precision of STL; write PLY instead");
    }
  }
  RowWriter out(path);
  std::string header = "binary STL, single precision";  // must not begin with "solid", as text STL does
  header.resize(80, ' ');
  out.text(header);
  out.bytes(static_cast<std::uint32_t>(mesh.triangles.size()));
  const auto write_vector = [&](const Vec3d& v) {
    for (std::size_t axis = 0; axis < 3; ++axis) out.bytes(static_cast<float>(v[axis]));
  };
  for (const Triangle& t : mesh.triangles) {
    write_vector(normal_of(mesh.vertices[t[0]], mesh.vertices[t[1]], mesh.vertices[t[2]]));
    for (const std::uint32_t index : t) write_vector(mesh.vertices[index]);
    out.bytes(std::uint16_t{0});
  }
  out.finish();
}

}  // namespace

bool volume_io::is_binary_stl(std::string_view head, std::uint64_t size) {
  return size > header_size && has_stated_size(head, size);
}

namespace {

bool begins_as_stl(std::string_view head) {
  return head.starts_with("solid ") && head.find("facet") != std::string_view::npos;
}

}  // namespace

constinit const formats::MeshCode formats::mesh_stl{read_stl, write_stl, {begins_as_stl}};

}  // namespace blum
