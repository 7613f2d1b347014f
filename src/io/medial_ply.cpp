#include <array>
#include <string>

#include "io/medial_files.hpp"
#include "io/row_writer.hpp"

namespace blum::medial_files {
namespace {

/// Metadata as comments, each a JSON object of one pair: no line becomes longer than readers of PLY like.
std::string comments_text(const MedialMetadata& metadata) {
  std::string out;
  for (const auto& pair : to_pairs(metadata)) out += "comment blum " + volume_io::to_json({pair}) + "\n";
  return out;
}

std::string header_text(const MedialComplex& complex, const MedialMetadata& metadata) {
  std::string out = "ply\nformat binary_little_endian 1.0\n" + comments_text(metadata);
  out += "element vertex " + std::to_string(complex.vertices.size()) + "\n";
  for (const char* name : {"x", "y", "z", "radius", "separation_angle", "footprint_0_x", "footprint_0_y",
                           "footprint_0_z", "footprint_1_x", "footprint_1_y", "footprint_1_z"}) {
    out += std::string("property double ") + name + "\n";
  }
  // MeshLab colours by `quality`.
  out += "property int site_0\nproperty int site_1\nproperty uchar role\nproperty float quality\nelement face " +
         std::to_string(complex.triangles.size()) +
         "\nproperty list uchar int vertex_indices\nproperty float separation_angle\nproperty int sheet\n";
  // Readers such as trimesh's take all that is in `edge` for corners.
  const std::string edges = std::to_string(complex.edges.size());
  out += "element edge " + edges + "\nproperty int vertex1\nproperty int vertex2\nelement edge_attributes " + edges +
         "\nproperty float separation_angle\nproperty uchar role\n";
  return out + "end_header\n";
}

void write_vector(RowWriter& out, const Vec3d& v) {
  for (std::size_t axis = 0; axis < 3; ++axis) out.bytes(v[axis]);
}

}  // namespace

void write_ply(const std::filesystem::path& path, const MedialComplex& complex, const MedialMetadata& metadata,
               const Context& context) {
  RowWriter out(path, complex.vertices.size() + complex.triangles.size() + 2 * complex.edges.size(), context);
  out.text(header_text(complex, metadata));
  for (const MedialVertex& v : complex.vertices) {
    write_vector(out, v.position);
    out.bytes(v.radius);
    out.bytes(v.separation_angle);
    for (const Vec3d& footprint : v.footprints) write_vector(out, footprint);
    for (const SiteId site : v.sites) out.bytes(site.to_file());
    out.bytes(static_cast<std::uint8_t>(v.role));
    out.bytes(static_cast<float>(v.radius));
    out.end_row();
  }
  for (const MedialTriangle& t : complex.triangles) {
    out.bytes(std::uint8_t{3});
    for (const std::uint32_t v : t.vertices) out.bytes(v);
    out.bytes(t.separation_angle);
    out.bytes(t.sheet);
    out.end_row();
  }
  for (const MedialEdge& e : complex.edges) {
    for (const std::uint32_t v : e.vertices) out.bytes(v);
    out.end_row();
  }
  for (const MedialEdge& e : complex.edges) {
    out.bytes(e.separation_angle);
    out.bytes(static_cast<std::uint8_t>(e.role));
    out.end_row();
  }
  out.finish();
}

}  // namespace blum::medial_files
