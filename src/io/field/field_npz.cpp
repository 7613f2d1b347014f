#include <array>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "blum/core/error.hpp"
#include "blum/io/atomic_file.hpp"
#include "io/archive/numpy.hpp"
#include "io/archive/zip.hpp"
#include "io/field/field_files.hpp"
#include "io/format_table.hpp"
#include "io/image/image_files.hpp"
#include "io/text/row_writer.hpp"

namespace blum::volume_io {
namespace {

using SiteVertices = std::vector<std::array<std::int32_t, 3>>;

/// Returns the vertices of every site of the field's mesh, in the order of site ids.
SiteVertices site_vertices(const Field& field, const FieldFileInfo& info) {
  SiteVertices out;
  if (field.site_ids == SiteIds::triangles) {
    out.reserve(info.mesh->triangles.size());
    for (const Triangle& t : info.mesh->triangles) {
      out.push_back(
          {static_cast<std::int32_t>(t[0]), static_cast<std::int32_t>(t[1]), static_cast<std::int32_t>(t[2])});
    }
    return out;
  }
  std::optional<SiteTable> own;
  const SiteTable& sites = info.sites != nullptr ? *info.sites : own.emplace(*info.mesh);
  out.reserve(sites.size());
  for (std::size_t i = 0; i < sites.size(); ++i) out.push_back(sites.vertices(SiteId(static_cast<std::uint32_t>(i))));
  return out;
}

/// @throws InvalidMesh if the field contains the id of a site that the mesh does not have.
void check_sites(const Buffer<SiteId>& sites, std::size_t site_count) {
  for (const SiteId site : sites) {
    if (!site.has_value() || site.value < site_count) continue;
    throw InvalidMesh("the field uses site " + std::to_string(site.value) + ", but the mesh given with it has only " +
                      std::to_string(site_count) + " sites: the field belongs to another mesh");
  }
}

void add_direction(NpzWriter& npz, const Mat3& direction) {
  std::array<double, 9> rows{};
  for (std::size_t row = 0; row < 3; ++row) {
    for (std::size_t column = 0; column < 3; ++column) rows[3 * row + column] = direction.columns[column][row];
  }
  npz.add("direction", "f8", {3, 3}, std::span<const double>(rows));
}

void check_shape(const ByteStream& stream, const NpyHeader& header, const GridSpec& grid) {
  if (npy_image_size(header, stream.name()) == grid.size) return;
  throw FormatError(stream.name() + ": its shape is not that of 'distance'");
}

Buffer<float> distances_of(ByteStream& stream, const NpyHeader& header) {
  if (header.fortran) return to_float(read_npy_values(stream, header));
  const std::uint64_t count = check_npy_values(stream, header);
  return read_distances(header.type, count, [&](std::span<std::byte> out) { read_npy_raw(stream, header, out); });
}

Buffer<SiteId> sites_of(ByteStream& stream, const NpyHeader& header) {
  if (header.fortran) return to_sites(read_npy_values(stream, header), stream.name());
  const std::uint64_t count = check_npy_values(stream, header);
  return read_sites(
      header.type, count, [&](std::span<std::byte> out) { read_npy_raw(stream, header, out); }, stream.name());
}

void read_geometry(NpzReader& npz, const std::string& name, GridSpec& grid) {
  const auto vector = [&](const char* array, const Vec3d& fallback) {
    if (!npz.has(array)) return fallback;
    const auto v = npz.numbers<3>(array, {3});
    return Vec3d{v[0], v[1], v[2]};
  };
  grid.origin = vector("origin", {});
  const Vec3d spacing = vector("spacing", {1, 1, 1});
  std::array<Vec3d, 3> axes{Vec3d{1, 0, 0}, Vec3d{0, 1, 0}, Vec3d{0, 0, 1}};
  if (npz.has("direction")) {
    const auto rows = npz.numbers<9>("direction", {3, 3});
    for (std::size_t c = 0; c < 3; ++c) axes[c] = {rows[c], rows[3 + c], rows[6 + c]};
  }
  set_frame(grid, axes, spacing, name);
}

}  // namespace

void write_field_npz(const std::filesystem::path& path, const Field& field, const FieldFileInfo& info,
                     const Context& context) {
  const bool has_mesh = info.mesh != nullptr && !field.site.empty() && field.site_ids != SiteIds::voxels;
  if (has_mesh) validate(*info.mesh);
  const SiteVertices corners = has_mesh ? site_vertices(field, info) : SiteVertices{};
  if (has_mesh) {
    check_sites(field.site, corners.size());
    check_sites(field.site2, corners.size());
  }
  AtomicFile file(path);
  FieldSink sink(array_size(field) + 12 * corners.size() + (has_mesh ? 24 * info.mesh->vertices.size() : 0), context);
  NpzWriter npz(file, sink, context);
  const auto& n = field.grid.size;
  const std::vector<std::uint64_t> shape{static_cast<std::uint64_t>(n[2]), static_cast<std::uint64_t>(n[1]),
                                         static_cast<std::uint64_t>(n[0])};
  npz.add("distance", "f4", shape, field.distance.span());
  if (!field.site.empty()) npz.add("site", "i4", shape, field.site.span());
  if (!field.distance2.empty()) npz.add("distance2", "f4", shape, field.distance2.span());
  if (!field.site2.empty()) npz.add("site2", "i4", shape, field.site2.span());
  npz.add_vector("origin", field.grid.origin);
  npz.add_vector("spacing", field.grid.spacing);
  add_direction(npz, field.grid.direction);
  if (has_mesh) {
    static_assert(sizeof(Vec3d) == 3 * sizeof(double));
    npz.add("vertices", "f8", {info.mesh->vertices.size(), 3}, info.mesh->vertices);
    npz.add("site_vertices", "i4", {corners.size(), 3}, std::span(std::as_const(corners)));
  }
  npz.add_text("metadata", to_json(field_metadata(field, info)));
  npz.finish();
  file.commit();
}

Field read_field_npz(const ByteSource& source, const std::filesystem::path&) {
  NpzReader npz(source);
  if (!npz.has("distance") && npz.has("vertices")) {
    throw FormatError(source.name() + ": it holds vertices, but no array 'distance': a medial axis, not a field");
  }
  if (npz.has("vertex_distance")) {
    throw FormatError(source.name() + ": it holds a surface map (array 'vertex_distance'), not a field");
  }
  if (npz.has("primitive")) {
    throw FormatError(source.name() + ": it holds pairs of primitives (array 'primitive'), not a field");
  }
  if (npz.has("vertex_face")) {
    throw FormatError(source.name() + ": it holds collisions (array 'vertex_face'), not a field");
  }
  if (npz.has("points")) throw FormatError(source.name() + ": it holds points (array 'points'), not a field");
  Field field;
  field.distance = npz.read("distance", [&](ByteStream& stream, const NpyHeader& header) {
    field.grid.size = npy_image_size(header, stream.name());
    return distances_of(stream, header);
  });
  if (npz.has("distance2")) {
    field.distance2 = npz.read("distance2", [&](ByteStream& stream, const NpyHeader& header) {
      check_shape(stream, header, field.grid);
      return distances_of(stream, header);
    });
  }
  for (const auto& [name, sites] : {std::pair{"site", &field.site}, std::pair{"site2", &field.site2}}) {
    if (!npz.has(name)) continue;
    *sites = npz.read(name, [&](ByteStream& stream, const NpyHeader& header) {
      check_shape(stream, header, field.grid);
      return sites_of(stream, header);
    });
  }
  read_geometry(npz, source.name(), field.grid);
  if (npz.has("metadata")) apply_metadata(from_json(npz.text("metadata"), source.name()), source.name(), field);
  return field;
}

}  // namespace blum::volume_io

namespace blum::formats {

using namespace volume_io;

constinit const FieldCode field_npz{read_field_npz, write_field_npz, {begins_as_zip}};

}  // namespace blum::formats
