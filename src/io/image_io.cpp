#include "blum/io/image_io.hpp"

#include <optional>
#include <string>
#include <system_error>

#include "blum/core/error.hpp"
#include "blum/io/atomic_file.hpp"
#include "io/image_files.hpp"
#include "io/npy.hpp"
#include "io/nrrd.hpp"
#include "io/scalar_type.hpp"
#include "io/text_scan.hpp"

namespace blum {
namespace {

using namespace volume_io;

[[noreturn]] void fail_extension(const std::filesystem::path& path, const char* known) {
  throw InvalidOption("'" + path.string() + "': images have one of the extensions " + known);
}

bool is_there(const std::filesystem::path& path) {
  std::error_code error;
  return std::filesystem::exists(path, error);
}

/// One half of a NIfTI pair, compressed or not.
std::filesystem::path half_of_pair(const std::filesystem::path& stem, const char* extension) {
  std::filesystem::path plain = stem;
  plain += extension;
  std::filesystem::path packed = plain;
  packed += ".gz";
  return !is_there(plain) && is_there(packed) ? packed : plain;
}

VoxelImage read_nifti_pair(const std::filesystem::path& stem) {
  const FileSource header(half_of_pair(stem, ".hdr"));
  const FileSource data(half_of_pair(stem, ".img"));
  return read_nifti(header, &data);
}

VoxelImage checked(VoxelImage image, const std::string& name) {
  try {
    validate(image);
  } catch (const InvalidImage& error) {
    throw FormatError(name + ": " + error.what());
  }
  return image;
}

VoxelImage read_source(const ByteSource& source, ImageFormat format, const std::filesystem::path& path) {
  switch (format) {
    case ImageFormat::nrrd:
      return read_nrrd(source, path);
    case ImageFormat::nifti:
      return read_nifti(source, nullptr);
    case ImageFormat::npy: {
      PlainStream stream(source);
      return read_npy(stream);
    }
    case ImageFormat::vol:
      break;
  }
  return read_vol(source);
}

void write_values(AtomicFile& file, const VoxelImageView& image) {
  const auto bytes = as_bytes(image.values);
  file.write(bytes.data(), bytes.size());
  file.commit();
}

}  // namespace

VoxelImage read_image(const std::filesystem::path& path) {
  const std::string name = path.string();
  std::filesystem::path plain = path;  // without .gz, for NIfTI
  const bool packed = lower_case(path.extension().string()) == ".gz";
  if (packed) plain.replace_extension();
  const std::string extension = lower_case(plain.extension().string());
  if (extension == ".hdr" || extension == ".img") return checked(read_nifti_pair(plain.replace_extension()), name);
  std::optional<ImageFormat> format;
  if (extension == ".nii") format = ImageFormat::nifti;
  if (!packed && (extension == ".nrrd" || extension == ".nhdr")) format = ImageFormat::nrrd;
  if (!packed && extension == ".npy") format = ImageFormat::npy;
  if (!packed && extension == ".vol") format = ImageFormat::vol;
  if (!format) fail_extension(path, ".nrrd, .nhdr, .nii, .nii.gz, .hdr, .img, .npy, .vol");
  return checked(read_source(FileSource(path), *format, path), name);
}

VoxelImage read_image(std::span<const std::byte> bytes, ImageFormat format, const std::string& name) {
  return checked(read_source(MemorySource(bytes, name), format, {}), name);
}

void write_image(const std::filesystem::path& path, const VoxelImageView& image) {
  const std::string extension = lower_case(path.extension().string());
  const ScalarType type = scalar_type(image.values);
  validate(image);
  std::string header;
  if (extension == ".nrrd") {
    header = nrrd_header(type, image.grid, image.space, {});
  } else if (extension == ".npy") {
    const auto& n = image.grid.size;
    header = npy_header(npy_dtype(type), {static_cast<std::uint64_t>(n[2]), static_cast<std::uint64_t>(n[1]),
                                          static_cast<std::uint64_t>(n[0])});
  } else {
    fail_extension(path, ".nrrd, .npy (for writing)");
  }
  AtomicFile file(path);
  file.write(header);
  write_values(file, image);
}

}  // namespace blum
