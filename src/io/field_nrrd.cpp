#include <optional>
#include <string>

#include "blum/core/error.hpp"
#include "blum/io/atomic_file.hpp"
#include "io/field_files.hpp"
#include "io/field_metadata.hpp"
#include "io/field_sink.hpp"
#include "io/format_table.hpp"
#include "io/image_geometry.hpp"
#include "io/nrrd.hpp"

namespace blum::volume_io {
namespace {

/// The key that says that a second file holds the sites: one left over from another run is not taken for it.
constexpr const char* sites_key = "site_file";
/// The key that marks the file of the sites, and names that of the distances.
constexpr const char* distances_key = "distance_file";

/// @throws FormatError for the file of a field's sites, which looks like one of distances.
void check_holds_distances(const NrrdHeader& header, const std::string& name) {
  const std::string_view distances = find_value(header.key_values, distances_key);
  if (distances.empty()) return;
  throw FormatError(name + ": it holds the site ids of a field, not its distances; open the file of the distances, '" +
                    std::string(distances) + "', which finds its sites by itself");
}

Buffer<float> nrrd_distances(const ByteSource& data, const NrrdHeader& header) {
  check_nrrd_data_size(data, header);
  return read_distances(header.type, header.grid.node_count(),
                        [&](std::span<std::byte> out) { read_nrrd_data(data, header, out); });
}

Buffer<SiteId> nrrd_sites(const std::filesystem::path& path, const GridSpec& grid) {
  const FileSource source(path);
  const NrrdHeader header = read_nrrd_header(source);
  if (header.grid.size != grid.size) {
    throw FormatError(source.name() + ": it holds site ids for another grid than the distances beside it");
  }
  if (!header.data_file.empty()) throw FormatError(source.name() + ": its data are in another file");
  check_nrrd_data_size(source, header);
  return read_sites(
      header.type, header.grid.node_count(), [&](std::span<std::byte> out) { read_nrrd_data(source, header, out); },
      source.name());
}

}  // namespace

bool has_own_sites_beside(const std::filesystem::path& path) {
  try {
    const NrrdHeader header = read_nrrd_header(FileSource(site_path(path)));
    return find_value(header.key_values, distances_key) == path.filename().string();
  } catch (const Error&) {
    return false;  // there is none, or it is none of Blum's
  }
}

std::filesystem::path site_path(const std::filesystem::path& path) {
  std::filesystem::path out = path;
  out.replace_extension();
  out += ".site.nrrd";
  return out;
}

void write_field_nrrd(const std::filesystem::path& path, const Field& field, const FieldFileInfo& info,
                      const Context& context) {
  Metadata metadata = field_metadata(field, info);
  AtomicFile distances(path);
  std::optional<AtomicFile> sites;
  FieldSink sink(distance_bytes(field).size() + site_bytes(field).size(), context);
  if (!field.site.empty()) {
    Metadata of_sites = metadata;
    of_sites.emplace_back(distances_key, path.filename().string());
    metadata.emplace_back(sites_key, site_path(path).filename().string());
    sites.emplace(site_path(path));
    sink.write(*sites, nrrd_header(ScalarType::i32, field.grid, info.space, of_sites));
    sink.write(*sites, site_bytes(field));
  }
  sink.write(distances, nrrd_header(ScalarType::f32, field.grid, info.space, metadata));
  sink.write(distances, distance_bytes(field));
  distances.finish();
  if (sites) sites->finish();
  throw_if_cancelled(context);
  if (sites) sites->commit();
  distances.commit();
  // Those of the field that was there; should they stay, the new file does not name them.
  std::error_code ignored;
  if (!sites && has_own_sites_beside(path)) std::filesystem::remove(site_path(path), ignored);
}

Field read_field_nrrd(const ByteSource& source, const std::filesystem::path& path) {
  const NrrdHeader header = read_nrrd_header(source);
  check_holds_distances(header, source.name());
  Field field;
  field.grid = header.grid;
  if (header.data_file.empty()) {
    field.distance = nrrd_distances(source, header);
  } else if (path.empty()) {
    throw FormatError(source.name() + ": its data are in another file, '" + header.data_file + "'");
  } else {
    field.distance = nrrd_distances(FileSource(nrrd_data_path(header, path)), header);
  }
  apply_metadata(header.key_values, source.name(), field);
  if (!path.empty() && !find_value(header.key_values, sites_key).empty()) {
    std::error_code error;
    if (std::filesystem::exists(site_path(path), error)) field.site = nrrd_sites(site_path(path), field.grid);
  }
  return field;
}

namespace {

/// A NRRD file whose header says that it is one of Blum's fields.
bool holds_field(std::string_view head, const std::filesystem::path&) {
  return head.substr(0, head.find("\n\n")).find("sign_rule:=") != std::string_view::npos;
}

}  // namespace

}  // namespace blum::volume_io

namespace blum::formats {

using namespace volume_io;

constinit const FieldCode field_nrrd{read_field_nrrd, write_field_nrrd, {begins_as_nrrd, holds_field}};

}  // namespace blum::formats
