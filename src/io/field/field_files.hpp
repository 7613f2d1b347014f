// Blum: shared functions of readers and writers of fields. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <span>
#include <string>
#include <string_view>

#include "blum/core/context.hpp"
#include "blum/field/field.hpp"
#include "blum/grid/voxel_image.hpp"
#include "blum/io/field_io.hpp"
#include "io/bytes/byte_source.hpp"
#include "io/bytes/scalar_type.hpp"
#include "io/text/json.hpp"

namespace blum::volume_io {

/// Arrays of a field that are stored in separate NRRD files next to the file of the distances, in the order of
/// beside_arrays.
enum class BesideArray : std::uint8_t { site, distance2, site2 };
inline constexpr std::array beside_arrays{BesideArray::site, BesideArray::distance2, BesideArray::site2};
/// Returns "site", "distance2" or "site2".
[[nodiscard]] std::string_view name_of(BesideArray array);
/// Returns the path of the file for an array. For distances in OUT.nrrd it is OUT.site.nrrd and so on.
[[nodiscard]] std::filesystem::path beside_path(const std::filesystem::path& path, BesideArray array);
/// Returns true if that file exists and states OUT.nrrd as the file of its distances.
[[nodiscard]] bool has_own_beside(const std::filesystem::path& path, BesideArray array);

void write_field_nrrd(const std::filesystem::path& path, const Field& field, const FieldFileInfo& info,
                      const Context& context);
void write_field_npz(const std::filesystem::path& path, const Field& field, const FieldFileInfo& info,
                     const Context& context);
void write_field_vti(const std::filesystem::path& path, const Field& field, const FieldFileInfo& info,
                     const Context& context);

/// @param path  path of the source. The files of the other arrays are next to it. If empty, they are not read.
[[nodiscard]] Field read_field_nrrd(const ByteSource& source, const std::filesystem::path& path);
[[nodiscard]] Field read_field_npz(const ByteSource& source, const std::filesystem::path& path);
[[nodiscard]] Field read_field_vti(const ByteSource& source, const std::filesystem::path& path);

/// Returns the bytes of the distances, in the machine's byte order.
[[nodiscard]] inline std::span<const std::byte> distance_bytes(const Field& field) {
  return std::as_bytes(field.distance.span());
}
[[nodiscard]] inline std::span<const std::byte> site_bytes(const Field& field) {
  return std::as_bytes(field.site.span());
}
[[nodiscard]] inline std::span<const std::byte> distance2_bytes(const Field& field) {
  return std::as_bytes(field.distance2.span());
}
[[nodiscard]] inline std::span<const std::byte> site2_bytes(const Field& field) {
  return std::as_bytes(field.site2.span());
}
/// Returns the number of bytes of all arrays of a field.
[[nodiscard]] inline std::uint64_t array_size(const Field& field) {
  return distance_bytes(field).size() + site_bytes(field).size() + distance2_bytes(field).size() +
         site2_bytes(field).size();
}

/// Reads the next `bytes.size()` bytes of values of a file, in the machine's byte order.
using ReadValues = std::function<void(std::span<std::byte> bytes)>;

/// Reads distances of any scalar type. Values of type float32 are not copied. Callers must have checked that the file
/// is large enough for `count` values.
[[nodiscard]] Buffer<float> read_distances(ScalarType type, std::uint64_t count, const ReadValues& read);
/// Reads site ids of any integer type. Values of type int32 are not copied. Callers must have checked that the file is
/// large enough for `count` values.
/// @throws FormatError with `name` if a value is neither an index nor -1.
[[nodiscard]] Buffer<SiteId> read_sites(ScalarType type, std::uint64_t count, const ReadValues& read,
                                        const std::string& name);
[[nodiscard]] Buffer<SiteId> to_sites(const VoxelImage::Values& values, const std::string& name);

/// Metadata of a field. Numbers are written with as few digits as identify them exactly.
using Metadata = FileMetadata;

/// Returns a sentence that explains site ids to people who read the file.
[[nodiscard]] std::string site_sentence(SiteIds ids);

[[nodiscard]] Metadata field_metadata(const Field& field, const FieldFileInfo& info);

/// Sets the members of a field that are stored as metadata: band, sign rule and kind of site ids. Unknown keys are
/// ignored.
/// @throws FormatError with `name` if a known key has an invalid value.
void apply_metadata(const Metadata& metadata, const std::string& name, Field& field);

}  // namespace blum::volume_io
