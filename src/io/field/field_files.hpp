// Blum: what readers and writers of fields share. SPDX-License-Identifier: Apache-2.0
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

/// The arrays of a field that have a NRRD file of their own beside the distances, in the order of array_path().
enum class BesideArray : std::uint8_t { site, distance2, site2 };
inline constexpr std::array beside_arrays{BesideArray::site, BesideArray::distance2, BesideArray::site2};
/// "site", "distance2" or "site2".
[[nodiscard]] std::string_view name_of(BesideArray array);
/// The file of an array that goes with OUT.nrrd: OUT.site.nrrd and so on.
[[nodiscard]] std::filesystem::path beside_path(const std::filesystem::path& path, BesideArray array);
/// Whether that file is there and says that it holds an array of OUT.nrrd.
[[nodiscard]] bool has_own_beside(const std::filesystem::path& path, BesideArray array);

void write_field_nrrd(const std::filesystem::path& path, const Field& field, const FieldFileInfo& info,
                      const Context& context);
void write_field_npz(const std::filesystem::path& path, const Field& field, const FieldFileInfo& info,
                     const Context& context);
void write_field_vti(const std::filesystem::path& path, const Field& field, const FieldFileInfo& info,
                     const Context& context);

/// @param path  where the source came from, to find the sites; empty: they are not looked for.
[[nodiscard]] Field read_field_nrrd(const ByteSource& source, const std::filesystem::path& path);
[[nodiscard]] Field read_field_npz(const ByteSource& source, const std::filesystem::path& path);
[[nodiscard]] Field read_field_vti(const ByteSource& source, const std::filesystem::path& path);

/// The bytes of a field's arrays, in the machine's order.
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
/// How many bytes all of them are.
[[nodiscard]] inline std::uint64_t array_size(const Field& field) {
  return distance_bytes(field).size() + site_bytes(field).size() + distance2_bytes(field).size() +
         site2_bytes(field).size();
}

/// Copies `bytes.size()` bytes of values, in the machine's byte order, out of a file.
using ReadValues = std::function<void(std::span<std::byte> bytes)>;

/// Reads distances of any scalar type; float32 without a copy. The count must have been checked against the file.
[[nodiscard]] Buffer<float> read_distances(ScalarType type, std::uint64_t count, const ReadValues& read);
/// Reads site ids of any integer type; int32 without a copy. The count must have been checked against the file.
/// @throws FormatError with `name` when a value is neither an index nor -1.
[[nodiscard]] Buffer<SiteId> read_sites(ScalarType type, std::uint64_t count, const ReadValues& read,
                                        const std::string& name);
[[nodiscard]] Buffer<SiteId> to_sites(const VoxelImage::Values& values, const std::string& name);

/// Numbers are in their shortest exact form.
using Metadata = FileMetadata;

/// What site ids number, for people who read the file.
[[nodiscard]] std::string site_sentence(SiteIds ids);

[[nodiscard]] Metadata field_metadata(const Field& field, const FieldFileInfo& info);

/// Sets the band, sign rule and kind of site values of a field as its metadata say; unknown keys are left alone.
/// @throws FormatError with `name` when a known key has a value that it cannot have.
void apply_metadata(const Metadata& metadata, const std::string& name, Field& field);

}  // namespace blum::volume_io
