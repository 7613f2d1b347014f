#include <algorithm>
#include <array>
#include <cstddef>
#include <utility>

#include "blum/core/error.hpp"
#include "blum/core/exact_text.hpp"
#include "blum/io/atomic_file.hpp"
#include "blum/io/collision_io.hpp"
#include "blum/io/formats.hpp"
#include "io/field_sink.hpp"
#include "io/json.hpp"
#include "io/npz.hpp"

namespace blum {
namespace {

/// Collisions of one kind as columns.
struct Columns {
  std::string name;
  std::vector<std::array<std::uint32_t, 4>> vertices;
  std::vector<double> times;
};

Columns vertex_face_of(const ContinuousCollisions& collisions, const MeshView& mesh) {
  Columns out{"vertex_face", {}, {}};
  for (const VertexFaceCollision& one : collisions.vertex_face) {
    const auto& [a, b, c] = mesh.triangles[one.face.value];
    out.vertices.push_back({one.vertex, a, b, c});
    out.times.push_back(one.time);
  }
  return out;
}

Columns edge_edge_of(const ContinuousCollisions& collisions) {
  Columns out{"edge_edge", {}, {}};
  for (const EdgeEdgeCollision& one : collisions.edge_edge) {
    out.vertices.push_back({one.first[0], one.first[1], one.second[0], one.second[1]});
    out.times.push_back(one.time);
  }
  return out;
}

void write_npz(AtomicFile& file, const ContinuousCollisions& collisions, const std::array<Columns, 2>& kinds,
               const FileMetadata& metadata, const Context& context) {
  std::vector<std::uint32_t> faces;
  for (const VertexFaceCollision& one : collisions.vertex_face) faces.push_back(one.face.value);
  const std::size_t bytes = 28 * kinds[0].times.size() + 24 * kinds[1].times.size();
  volume_io::FieldSink sink(bytes, context);
  volume_io::NpzWriter npz(file, sink, context);
  for (const Columns& kind : kinds) {
    const std::span vertices(kind.vertices);
    npz.add(kind.name, "i4", {vertices.size(), 4}, vertices);
    npz.add(kind.name + "_time", "f8", {vertices.size()}, std::span<const double>(kind.times));
  }
  npz.add("face", "i4", {faces.size()}, std::span<const std::uint32_t>(faces));
  if (!metadata.empty()) npz.add_text("metadata", volume_io::to_json(metadata));
  npz.finish();
}

void write_csv(AtomicFile& file, const std::array<Columns, 2>& kinds) {
  file.write("kind,a,b,c,d,time\n");
  for (const Columns& kind : kinds) {
    for (std::size_t n = 0; n < kind.times.size(); ++n) {
      std::string row = kind.name;
      for (const std::uint32_t v : kind.vertices[n]) row += ',' + std::to_string(v);
      file.write(row + ',' + exact_text(kind.times[n]) + '\n');
    }
  }
}

void write_json(AtomicFile& file, const std::array<Columns, 2>& kinds, const FileMetadata& metadata) {
  std::string head = metadata.empty() ? "{}" : volume_io::to_json(metadata);
  file.write("{\"metadata\": " + head);
  for (const Columns& kind : kinds) {
    file.write(",\n\"" + kind.name + "\": [");
    for (std::size_t n = 0; n < kind.times.size(); ++n) {
      std::string row = n == 0 ? "\n[" : ",\n[";
      for (const std::uint32_t v : kind.vertices[n]) row += std::to_string(v) + ", ";
      row.resize(row.size() - 2);
      file.write(row + "]");
    }
    file.write("],\n\"" + kind.name + "_time\": [");
    for (std::size_t n = 0; n < kind.times.size(); ++n) {
      file.write((n == 0 ? "" : ", ") + exact_text(kind.times[n]));
    }
    file.write("]");
  }
  file.write("}\n");
}

}  // namespace

const std::vector<std::string>& collision_extensions() {
  static const std::vector<std::string> extensions{".npz", ".csv", ".json"};
  return extensions;
}

void write_collisions(const std::filesystem::path& path, const ContinuousCollisions& collisions, const MeshView& mesh,
                      const FileMetadata& metadata, const Context& context) {
  const std::string extension = file_extension(path);
  const auto& known = collision_extensions();
  if (std::find(known.begin(), known.end(), extension) == known.end()) {
    throw InvalidOption("'" + path.string() +
                        "': collisions are written to .npz, .csv, .json files; use one of these " + "extensions");
  }
  const std::array<Columns, 2> kinds{vertex_face_of(collisions, mesh), edge_edge_of(collisions)};
  AtomicFile file(path);
  if (extension == ".npz") {
    write_npz(file, collisions, kinds, metadata, context);
  } else if (extension == ".csv") {
    write_csv(file, kinds);
  } else {
    write_json(file, kinds, metadata);
  }
  file.commit();
}

}  // namespace blum
