#include <array>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "blum/core/error.hpp"
#include "blum/io/atomic_file.hpp"
#include "io/field/field_files.hpp"
#include "io/format_table.hpp"
#include "io/image/image_files.hpp"
#include "io/image/nrrd.hpp"
#include "io/text/row_writer.hpp"

namespace blum::volume_io {
namespace {

/// Returns the key whose value is the file name of an array. A file left over from an earlier run is ignored, because
/// no key refers to it.
std::string key_of(BesideArray array) {
  return std::string(name_of(array)) + "_file";
}
/// Key in the file of another array. Its value is the file name of the distances.
constexpr const char* distances_key = "distance_file";
/// Key in the file of another array. Its value is the name of the array; without it, the array is "site".
constexpr const char* array_key = "array";

/// @throws FormatError if the file contains another array of a field. Without this check it would be read as distances.
void check_holds_distances(const NrrdHeader& header, const std::string& name) {
  const std::string_view distances = find_value(header.key_values, distances_key);
  if (distances.empty()) return;
  const bool is_second = find_value(header.key_values, array_key) == name_of(BesideArray::distance2);
  throw FormatError(name + ": it holds the " + (is_second ? "second distances" : "site ids") +
                    " of a field, not its distances; open the file of the distances, '" + std::string(distances) +
                    "': " + (is_second ? "second distances and sites" : "sites") + " are read with it");
}

Buffer<float> nrrd_distances(const ByteSource& data, const NrrdHeader& header) {
  check_nrrd_data_size(data, header);
  return read_distances(header.type, header.grid.node_count(),
                        [&](std::span<std::byte> out) { read_nrrd_data(data, header, out); });
}

/// Reads an array from its separate file.
void read_beside(const std::filesystem::path& path, BesideArray array, Field& field) {
  const FileSource source(path, PipeUse::refuse);
  const NrrdHeader header = read_nrrd_header(source);
  if (header.grid.size != field.grid.size) {
    throw FormatError(source.name() + ": it holds " +
                      (array == BesideArray::distance2 ? "second distances" : "site ids") +
                      " for another grid than that of the file with the distances");
  }
  if (!header.data_file.empty()) throw FormatError(source.name() + ": its data are in another file");
  if (array == BesideArray::distance2) {
    field.distance2 = nrrd_distances(source, header);
    return;
  }
  check_nrrd_data_size(source, header);
  (array == BesideArray::site ? field.site : field.site2) = read_sites(
      header.type, header.grid.node_count(), [&](std::span<std::byte> out) { read_nrrd_data(source, header, out); },
      source.name());
}

std::span<const std::byte> bytes_of(const Field& field, BesideArray array) {
  if (array == BesideArray::distance2) return distance2_bytes(field);
  return array == BesideArray::site ? site_bytes(field) : site2_bytes(field);
}

}  // namespace

std::string_view name_of(BesideArray array) {
  constexpr std::array<std::string_view, beside_arrays.size()> names{"site", "distance2", "site2"};
  return names[static_cast<std::size_t>(array)];
}

bool has_own_beside(const std::filesystem::path& path, BesideArray array) {
  try {
    const NrrdHeader header = read_nrrd_header(FileSource(beside_path(path, array), PipeUse::refuse));
    return find_value(header.key_values, distances_key) == path.filename().string();
  } catch (const Error&) {
    return false;  // no such file exists, or it was not written by Blum
  }
}

std::filesystem::path beside_path(const std::filesystem::path& path, BesideArray array) {
  std::filesystem::path out = path;
  out.replace_extension();
  out += "." + std::string(name_of(array)) + ".nrrd";
  return out;
}

void write_field_nrrd(const std::filesystem::path& path, const Field& field, const FieldFileInfo& info,
                      const Context& context) {
  Metadata metadata = field_metadata(field, info);
  AtomicFile distances(path);
  std::array<std::optional<AtomicFile>, beside_arrays.size()> others;
  FieldSink sink(array_size(field), context);
  const Metadata of_field = metadata;
  for (const BesideArray array : beside_arrays) {
    const std::span<const std::byte> bytes = bytes_of(field, array);
    if (bytes.empty()) continue;
    Metadata of_array = of_field;
    of_array.emplace_back(distances_key, path.filename().string());
    if (array != BesideArray::site) of_array.emplace_back(array_key, name_of(array));
    metadata.emplace_back(key_of(array), beside_path(path, array).filename().string());
    AtomicFile& file = others[static_cast<std::size_t>(array)].emplace(beside_path(path, array));
    const ScalarType type = array == BesideArray::distance2 ? ScalarType::f32 : ScalarType::i32;
    sink.write(file, nrrd_header(type, field.grid, info.space, of_array));
    sink.write(file, bytes);
  }
  sink.write(distances, nrrd_header(ScalarType::f32, field.grid, info.space, metadata));
  sink.write(distances, distance_bytes(field));
  distances.finish();
  for (std::optional<AtomicFile>& other : others) {
    if (other) other->finish();
  }
  throw_if_cancelled(context);
  for (std::optional<AtomicFile>& other : others) {
    if (other) other->commit();
  }
  distances.commit();
  // Removes the files of an earlier field. If this fails, they are ignored, because the new file does not refer to
  // them.
  std::error_code ignored;
  for (const BesideArray array : beside_arrays) {
    const bool is_written = others[static_cast<std::size_t>(array)].has_value();
    if (!is_written && has_own_beside(path, array)) std::filesystem::remove(beside_path(path, array), ignored);
  }
}

Field read_field_nrrd(const ByteSource& source, const std::filesystem::path& path) {
  const NrrdHeader header = read_nrrd_header(source);
  check_holds_distances(header, source.name());
  Field field;
  field.grid = header.grid;
  field.warnings = header.warnings;
  if (header.data_file.empty()) {
    field.distance = nrrd_distances(source, header);
  } else if (path.empty()) {
    throw FormatError(source.name() + ": its data are in another file, '" + header.data_file + "'");
  } else {
    field.distance = nrrd_distances(FileSource(nrrd_data_path(header, path), PipeUse::refuse), header);
  }
  apply_metadata(header.key_values, source.name(), field);
  for (const BesideArray array : beside_arrays) {
    if (path.empty() || find_value(header.key_values, key_of(array)).empty()) continue;
    std::error_code error;
    if (std::filesystem::exists(beside_path(path, array), error)) read_beside(beside_path(path, array), array, field);
  }
  return field;
}

namespace {

/// Returns true if the header of a NRRD file marks it as a field written by Blum.
bool holds_field(std::string_view head, const std::filesystem::path&) {
  return head.substr(0, head.find("\n\n")).find("sign_rule:=") != std::string_view::npos;
}

}  // namespace

}  // namespace blum::volume_io

namespace blum::formats {

using namespace volume_io;

constinit const FieldCode field_nrrd{read_field_nrrd, write_field_nrrd, {begins_as_nrrd, holds_field}};

}  // namespace blum::formats
