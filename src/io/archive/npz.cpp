#include "io/archive/npz.hpp"

namespace blum::volume_io {

void NpzWriter::add_text(const std::string& name, const std::string& text) {
  const std::vector<std::uint32_t> characters(text.begin(), text.end());
  add(name, "U" + std::to_string(text.size()), {}, std::span<const std::uint32_t>(characters));
}

std::vector<std::string> NpzReader::arrays() const {
  constexpr std::string_view extension = ".npy";
  std::vector<std::string> names;
  for (const ZipEntry& entry : zip_.entries()) {
    if (!entry.name.ends_with(extension)) continue;
    names.push_back(entry.name.substr(0, entry.name.size() - extension.size()));
  }
  return names;
}

std::uint64_t NpzReader::packed_size() const {
  std::uint64_t sum = 0;
  for (const ZipEntry& entry : zip_.entries()) {
    sum = entry.packed_size > UINT64_MAX - sum ? UINT64_MAX : sum + entry.packed_size;
  }
  return sum;
}

std::string NpzReader::text(const std::string& array) {
  return read(array, [&](ByteStream& stream, const NpyHeader& header) {
    if (header.kind != NpyHeader::Kind::text || header.count(stream.name()) != 1) {
      throw FormatError(stream.name() + ": it should be one string");
    }
    stream.check_left(std::uint64_t{4} * header.text_length, "the text");
    std::vector<std::uint32_t> characters(header.text_length);
    const auto bytes = std::as_writable_bytes(std::span(characters));
    stream.read(bytes, "the text");
    to_native(bytes, ScalarType::u32, header.order);
    std::string out;
    for (const std::uint32_t c : characters) {
      if (c == 0) break;
      if (c > 0x7F) throw FormatError(stream.name() + ": only ASCII text is understood");
      out += static_cast<char>(static_cast<unsigned char>(c));
    }
    return out;
  });
}

}  // namespace blum::volume_io
