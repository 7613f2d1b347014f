#include "blum/io/image_io.hpp"

#include <string>
#include <utility>

#include "blum/core/error.hpp"
#include "blum/io/atomic_file.hpp"
#include "io/bytes/scalar_type.hpp"
#include "io/format_table.hpp"
#include "io/image/image_files.hpp"

namespace blum {
namespace {

using namespace volume_io;

VoxelImage checked(VoxelImage image, const std::string& name) {
  try {
    validate(image);
  } catch (const InvalidImage& error) {
    throw FormatError(name + ": " + error.what());
  }
  return image;
}

}  // namespace

void volume_io::write_values_after(const std::filesystem::path& path, const std::string& header,
                                   const VoxelImageView& image) {
  AtomicFile file(path);
  file.write(header);
  const auto bytes = as_bytes(image.values);
  file.write(bytes.data(), bytes.size());
  file.commit();
}

VoxelImage read_image(const std::filesystem::path& path) {
  const formats::ImageCode& code = formats::code_of(ImageFormat::of(path));
  if (code.read_several != nullptr) {
    if (auto image = code.read_several(path)) return checked(std::move(*image), path.string());
  }
  return checked(code.read(FileSource(path), path), path.string());
}

VoxelImage read_image(std::span<const std::byte> bytes, ImageFormat format, const std::string& name) {
  return checked(formats::code_of(format).read(MemorySource(bytes, name), {}), name);
}

void write_image(const std::filesystem::path& path, const VoxelImageView& image) {
  const ImageFormat format = ImageFormat::of(path, FileAccess::write);
  validate(image);
  formats::code_of(format).write(path, image);
}

}  // namespace blum
