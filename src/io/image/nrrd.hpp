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

/// What the header of a NRRD file says, axes without a place in space taken away.
struct NrrdHeader {
  ScalarType type = ScalarType::u8;
  std::endian order = std::endian::little;
  NrrdEncoding encoding = NrrdEncoding::raw;
  GridSpec grid;
  std::string space;             ///< as NRRD names it, with directions only; empty where it is not known
  std::string data_file;         ///< empty where the data follow the header
  std::uint64_t data_start = 0;  ///< where the header ends
  std::uint64_t line_skip = 0;
  std::int64_t byte_skip = 0;  ///< -1: the data are the last bytes of the file
  Metadata key_values;
};

/// The header of a file whose raw data follow in the machine's byte order, and the empty line after it.
/// @param space  as VoxelImage::space; left out where NRRD does not know it.
[[nodiscard]] std::string nrrd_header(ScalarType type, const GridSpec& grid, const std::string& space,
                                      const Metadata& key_values);

/// The full name that NRRD has for a space of three dimensions, given by that name or its abbreviation in any case;
/// empty for others.
[[nodiscard]] std::string nrrd_space(std::string_view name);

/// @throws FormatError.
[[nodiscard]] NrrdHeader read_nrrd_header(const ByteSource& source);
/// Reads the data of a header into memory of exactly their size, in the machine's byte order.
/// @param source  the header's file or the detached data file. @throws FormatError.
void read_nrrd_data(const ByteSource& source, const NrrdHeader& header, std::span<std::byte> out);
/// @throws FormatError unless the data file can hold what the header says; to be called before memory is taken for it.
void check_nrrd_data_size(const ByteSource& source, const NrrdHeader& header);

/// The detached data file of a header that was read from `header_path`.
[[nodiscard]] std::filesystem::path nrrd_data_path(const NrrdHeader& header, const std::filesystem::path& header_path);

/// Whether the first bytes of a file are those of a NRRD file.
[[nodiscard]] bool begins_as_nrrd(std::string_view head);

/// @param path  where the header came from, for detached data; empty: detached data are refused.
[[nodiscard]] VoxelImage read_nrrd(const ByteSource& source, const std::filesystem::path& path);

}  // namespace blum::volume_io
