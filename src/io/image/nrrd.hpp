// Blum: NRRD files. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <bit>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <string_view>

#include "blum/io/image_io.hpp"
#include "io/bytes/byte_source.hpp"
#include "io/bytes/scalar_type.hpp"
#include "io/field/field_files.hpp"

namespace blum::volume_io {

enum class NrrdEncoding : std::uint8_t { raw, gzip, text };

/// Header of a NRRD file. Axes without a position in space are left out.
struct NrrdHeader {
  ScalarType type = ScalarType::u8;
  std::endian order = std::endian::little;
  NrrdEncoding encoding = NrrdEncoding::raw;
  GridSpec grid;
  std::string space;             ///< NRRD's name of the space; set only if there are directions, and empty if unknown
  std::string data_file;         ///< path of the data file; empty if the data follow the header
  std::uint64_t data_start = 0;  ///< position after the header
  std::uint64_t line_skip = 0;
  std::int64_t byte_skip = 0;  ///< number of bytes to skip; -1 if the data are the last bytes of the file
  Metadata key_values;
  std::vector<Warning> warnings;  ///< frames that disagree, see ImageFile
};

/// Returns the header of a file whose raw data follow in the machine's byte order. The header includes the empty line
/// at its end.
/// @param space  same meaning as VoxelImage::space. The space is left out if NRRD does not know it.
[[nodiscard]] std::string nrrd_header(ScalarType type, const GridSpec& grid, const std::string& space,
                                      const Metadata& key_values);

/// Returns the full NRRD name of a space with three dimensions. `name` may be the full name or the abbreviation, in
/// upper or lower case. For other names, returns an empty text.
[[nodiscard]] std::string nrrd_space(std::string_view name);

/// Reads the header of a file. @throws FormatError.
[[nodiscard]] NrrdHeader read_nrrd_header(const ByteSource& source);
/// Reads the data of a file in the machine's byte order. `out` must have exactly their size.
/// @param source  the file with the header, or the detached data file. @throws FormatError.
void read_nrrd_data(const ByteSource& source, const NrrdHeader& header, std::span<std::byte> out);
/// Checks the size of the data file, so that callers can allocate memory for the data safely.
/// @throws FormatError if the data file is too small for the values that the header promises.
void check_nrrd_data_size(const ByteSource& source, const NrrdHeader& header);

/// Returns the path of the detached data file. `header_path` is the path of its header.
[[nodiscard]] std::filesystem::path nrrd_data_path(const NrrdHeader& header, const std::filesystem::path& header_path);

/// Returns true if the first bytes of a file are those of a NRRD file.
[[nodiscard]] bool begins_as_nrrd(std::string_view head);

/// @param path  path of the header. Detached data are looked for next to it. If empty, detached data are rejected.
[[nodiscard]] ImageFile read_nrrd(const ByteSource& source, const std::filesystem::path& path);

}  // namespace blum::volume_io
