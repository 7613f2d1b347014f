// Blum: the table of file formats. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace blum {

/// What a file holds. Medial axes are complexes.
enum class FileContent : std::uint8_t { mesh, image, field, complex };

/// "mesh", "image", "field" or "complex".
[[nodiscard]] std::string_view to_string(FileContent content);

/// A format of files of one content. A name that stands for several contents (.ply) has a row for each.
struct FileFormat {
  FileContent content = FileContent::mesh;
  std::string_view name;                         ///< "PLY"
  std::span<const std::string_view> extensions;  ///< lower case, with their dots; the usual one first
  std::span<const std::string_view> written;     ///< those that can be written as well
  std::string_view holds;                        ///< what a file can hold, for people
  std::string_view opens_in;                     ///< other programs, for people
  /// Whether the first bytes of a file (8 KiB or all) are those of this format; null where nothing tells.
  bool (*begins)(std::string_view head) = nullptr;
};

/// All formats: those of one content in the order of its enumeration (MeshFormat, ImageFormat, FieldFormat,
/// MedialFormat).
[[nodiscard]] std::span<const FileFormat> file_formats();

/// The last extension of a name in lower case, with its dot; ".nii.gz", ".hdr.gz" and ".img.gz" count as one.
[[nodiscard]] std::string file_extension(const std::filesystem::path& path);

/// The place among the formats of this content of the one that the extension stands for; nullopt for none.
[[nodiscard]] std::optional<std::size_t> format_by_name(FileContent content, const std::filesystem::path& path);
/// The same by the first bytes.
[[nodiscard]] std::optional<std::size_t> format_by_head(FileContent content, std::string_view head);

/// The name of a format, by its place among those of its content; "unknown" for none.
[[nodiscard]] std::string_view format_name(FileContent content, std::size_t place);

enum class FileAccess : std::uint8_t { read, write };

/// The extensions of a content's formats, as they come in the table.
[[nodiscard]] std::vector<std::string> file_extensions(FileContent content, FileAccess access);
/// The same as a text, for example ".obj .off .stl .ply".
[[nodiscard]] std::string extension_list(FileContent content, FileAccess access, std::string_view between = " ");

}  // namespace blum
