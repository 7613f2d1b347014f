// Blum: NRRD files. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <bit>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <string_view>

#include "blum/grid/voxel_image.hpp"
#include "io/bytes/byte_source.hpp"
#include "io/bytes/scalar_type.hpp"
#include "io/field/field_files.hpp"

namespace blum::volume_io {

enum class NrrdEncoding : std::uint8_t { raw, gzip, text };

/// Header of a NRRD file, without axes that have no position in space.
struct NrrdHeader {
  ScalarType type = ScalarType::u8;
  std::endian order = std::endian::little;
  NrrdEncoding encoding = NrrdEncoding::raw;
  GridSpec grid;
  std::string space;             ///< NRRD name, set only with directions; empty if unknown
  std::string data_file;         ///< empty if the data follow the header
  std::uint64_t data_start = 0;  ///< end of the header
  std::uint64_t line_skip = 0;
  std::int64_t byte_skip = 0;  ///< -1: the data are the last bytes of the file
  Metadata key_values;
};

/// Returns the header, including the empty line after it, of a file whose raw data follow in the machine's byte order.
/// @param space  as VoxelImage::space; omitted if NRRD does not know it.
[[nodiscard]] std::string nrrd_header(ScalarType type, const GridSpec& grid, const std::string& space,
                                      const Metadata& key_values);

/// Returns the full NRRD name of a space of three dimensions. `name` is that name or its abbreviation, in any case.
/// Returns an empty text for other names.
[[nodiscard]] std::string nrrd_space(std::string_view name);

/// Reads the header of a file. @throws FormatError.
[[nodiscard]] NrrdHeader read_nrrd_header(const ByteSource& source);
/// Reads the data of a header into memory of exactly their size, in the machine's byte order.
/// @param source  the header's file or the detached data file. @throws FormatError.
void read_nrrd_data(const ByteSource& source, const NrrdHeader& header, std::span<std::byte> out);
/// Checks the size before memory is allocated for the data.
/// @throws FormatError unless the data file can hold the values that the header promises.
void check_nrrd_data_size(const ByteSource& source, const NrrdHeader& header);

/// Returns the path of the detached data file of a header that was read from `header_path`.
[[nodiscard]] std::filesystem::path nrrd_data_path(const NrrdHeader& header, const std::filesystem::path& header_path);

/// Returns true if the first bytes of a file are those of a NRRD file.
[[nodiscard]] bool begins_as_nrrd(std::string_view head);

/// @param path  path of the header, to find detached data; if empty, detached data are refused.
[[nodiscard]] VoxelImage read_nrrd(const ByteSource& source, const std::filesystem::path& path);

}  // namespace blum::volume_io
