// Blum: the image formats that have no header of their own. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <memory>

#include "blum/grid/voxel_image.hpp"
#include "io/bytes/byte_source.hpp"

namespace blum::volume_io {

/// @param data_source  the .img file of a pair; null where the data must follow the header. Each may be
/// gzip-compressed.
[[nodiscard]] VoxelImage read_nifti(const ByteSource& source, const ByteSource* data_source);
[[nodiscard]] VoxelImage read_vol(const ByteSource& source);

/// Writes a header and the values after it, in the machine's byte order; the file appears when it is complete.
void write_values_after(const std::filesystem::path& path, const std::string& header, const VoxelImageView& image);

/// The bytes of a source, decompressed where they begin as a gzip file does.
[[nodiscard]] std::unique_ptr<ByteStream> open_plain_or_gzip(const ByteSource& source);

}  // namespace blum::volume_io
