#include <algorithm>
#include <map>
#include <memory>
#include <string>

#include "blum/core/error.hpp"
#include "blum/core/ids.hpp"
#include "io/bytes/scalar_type.hpp"
#include "io/format_table.hpp"
#include "io/image/image_files.hpp"
#include "io/text/text_cursor.hpp"

namespace blum::volume_io {
namespace {

constexpr std::uint64_t largest_header = 65536;

struct VolHeader {
  std::map<std::string, std::string, std::less<>> fields;
  std::uint64_t end = 0;
};

/// Reads lines of the form `Key: value`, up to a line that contains only a dot.
VolHeader read_header(const ByteSource& source) {
  std::string text(static_cast<std::size_t>(std::min(source.size(), largest_header)), '\0');
  source.read(0, std::as_writable_bytes(std::span(text)));
  VolHeader header;
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t end = text.find('\n', at);
    if (end == std::string::npos) break;
    const std::string_view line = trim(std::string_view(text).substr(at, end - at));
    at = end + 1;
    if (line == ".") {
      header.end = at;
      return header;
    }
    const std::size_t colon = line.find(':');
    if (colon == std::string_view::npos) break;
    header.fields.insert_or_assign(std::string(trim(line.substr(0, colon))), trim(line.substr(colon + 1)));
  }
  throw FormatError(source.name() + ": it does not begin with lines 'Key: value' up to a line '.', as Vol files do");
}

std::int64_t number(const VolHeader& header, std::string_view key, const std::string& name) {
  const auto found = header.fields.find(key);
  if (found == header.fields.end()) throw FormatError(name + ": the field '" + std::string(key) + "' is missing");
  const auto value = parse_number<std::int64_t>(found->second);
  if (!value) throw FormatError(name + ": the field '" + std::string(key) + "' is not a whole number");
  return *value;
}

}  // namespace

VoxelImage read_vol(const ByteSource& source) {
  const std::string& name = source.name();
  const VolHeader header = read_header(source);
  VoxelImage image;
  image.grid.size = {number(header, "X", name), number(header, "Y", name), number(header, "Z", name)};
  check_count(image.grid.size, max_id_count, name);
  if (header.fields.contains("Voxel-Size") && number(header, "Voxel-Size", name) != 1) {
    throw FormatError(name + ": only voxels of one byte are read");
  }
  const std::int64_t version = number(header, "Version", name);
  if (version != 2 && version != 3) throw FormatError(name + ": only versions 2 and 3 of the format are read");
  std::unique_ptr<ByteStream> data;
  if (version == 3) {
    data = std::make_unique<InflateStream>(source, header.end, source.size(), Compression::zlib);
  } else {
    data = std::make_unique<PlainStream>(source, header.end, source.size());
  }
  data->check_left(image.grid.node_count(), "the data");
  image.values = make_values(ScalarType::u8, image.grid.node_count());
  data->read(as_bytes(image.values), "the data");
  data->check_end();
  return image;
}

namespace {

bool begins_as_vol(std::string_view head) {
  return head.starts_with("X: ") || head.starts_with("Center-X:");
}

ImageFile read(const ByteSource& source, const std::filesystem::path&) {
  return {read_vol(source)};
}

}  // namespace

}  // namespace blum::volume_io

namespace blum::formats {

using namespace volume_io;

constinit const ImageCode image_vol{read, nullptr, {begins_as_vol}};

}  // namespace blum::formats
