#include "io/archive/zip_writer.hpp"

#include <zlib.h>

#include <algorithm>

#include "blum/core/parallel.hpp"

namespace blum::volume_io {
namespace {

constexpr std::uint32_t limit32 = 0xFFFFFFFFU;
constexpr std::size_t crc_piece = std::size_t{4} << 20;
constexpr std::uint16_t version_plain = 20;
constexpr std::uint16_t version_zip64 = 45;
constexpr std::uint16_t date_1980 = 0x21;  ///< the first of January 1980: equal input gives equal bytes

std::uint32_t crc_of(std::uint32_t start, std::span<const std::byte> bytes) {
  return static_cast<std::uint32_t>(crc32_z(start, reinterpret_cast<const Bytef*>(bytes.data()), bytes.size()));
}

template <class T>
void put(std::string& out, T value) {
  for (std::size_t i = 0; i < sizeof(T); ++i) {
    out += static_cast<char>((static_cast<std::uint64_t>(value) >> (8 * i)) & 0xFFU);
  }
}
void put16(std::string& out, std::size_t value) {
  put(out, static_cast<std::uint16_t>(value));
}
void put32(std::string& out, std::uint64_t value) {
  put(out, static_cast<std::uint32_t>(value));
}
void put64(std::string& out, std::uint64_t value) {
  put(out, value);
}
std::uint32_t clamp32(std::uint64_t value) {
  return static_cast<std::uint32_t>(std::min<std::uint64_t>(value, limit32));
}

/// The fields that local and central headers share, from the version needed to the lengths of name and extra.
void put_common(std::string& out, bool zip64, std::uint32_t crc, std::uint32_t size, std::size_t name_length,
                std::size_t extra_length) {
  put16(out, zip64 ? version_zip64 : version_plain);
  put16(out, 0);  // flags
  put16(out, 0);  // stored
  put16(out, 0);  // time
  put16(out, date_1980);
  put32(out, crc);
  put32(out, size);
  put32(out, size);
  put16(out, name_length);
  put16(out, extra_length);
}

}  // namespace

std::uint32_t parallel_crc32(std::span<const std::byte> bytes, const Context& context) {
  const std::size_t pieces = (bytes.size() + crc_piece - 1) / crc_piece;
  std::vector<std::uint32_t> parts(pieces);
  const auto piece = [&](std::size_t i) {
    return bytes.subspan(i * crc_piece, std::min(crc_piece, bytes.size() - i * crc_piece));
  };
  parallel_for(context, pieces, 1, "", [&](const WorkRange& range) {
    for (std::size_t i = range.begin; i < range.end; ++i) parts[i] = crc_of(0, piece(i));
  });
  std::uint32_t crc = 0;
  for (std::size_t i = 0; i < pieces; ++i) {
    crc = static_cast<std::uint32_t>(crc32_combine(crc, parts[i], static_cast<z_off_t>(piece(i).size())));
  }
  return crc;
}

void ZipWriter::write(const std::string& bytes) {
  sink_.write(file_, bytes);
  position_ += bytes.size();
}

void ZipWriter::add(const std::string& name, std::span<const std::byte> head, std::span<const std::byte> body) {
  const std::uint64_t size = std::uint64_t{head.size()} + body.size();
  const std::uint32_t head_crc = crc_of(0, head);
  const std::uint32_t crc = static_cast<std::uint32_t>(
      crc32_combine(head_crc, parallel_crc32(body, context_), static_cast<z_off_t>(body.size())));
  entries_.push_back({name, crc, size, position_});

  std::string extra;
  const bool zip64 = size >= limit32;
  if (zip64) {
    put16(extra, 1);
    put16(extra, 16);
    put64(extra, size);
    put64(extra, size);
  }
  std::string header;
  put32(header, 0x04034b50U);
  put_common(header, zip64, crc, zip64 ? limit32 : static_cast<std::uint32_t>(size), name.size(), extra.size());
  write(header + name + extra);
  sink_.write(file_, head);
  sink_.write(file_, body);
  position_ += size;
}

void ZipWriter::finish() {
  const std::uint64_t start = position_;
  for (const Entry& entry : entries_) {
    std::string extra;
    const bool large = entry.size >= limit32;
    const bool far = entry.offset >= limit32;
    if (large || far) {
      put16(extra, 1);
      put16(extra, (large ? 16U : 0U) + (far ? 8U : 0U));
      if (large) put64(extra, entry.size);
      if (large) put64(extra, entry.size);
      if (far) put64(extra, entry.offset);
    }
    std::string header;
    put32(header, 0x02014b50U);
    put16(header, 0x0300U | version_zip64);  // made on Unix
    put_common(header, large || far, entry.crc, clamp32(entry.size), entry.name.size(), extra.size());
    put16(header, 0);               // comment
    put16(header, 0);               // disk
    put16(header, 0);               // internal attributes
    put32(header, 0100644U << 16);  // a regular file that everyone may read
    put32(header, clamp32(entry.offset));
    write(header + entry.name + extra);
  }
  const std::uint64_t end = position_;
  std::string tail;
  if (end >= limit32) {
    put32(tail, 0x06064b50U);
    put64(tail, 44);
    put16(tail, 0x0300U | version_zip64);
    put16(tail, version_zip64);
    put32(tail, 0);
    put32(tail, 0);
    put64(tail, entries_.size());
    put64(tail, entries_.size());
    put64(tail, end - start);
    put64(tail, start);
    put32(tail, 0x07064b50U);
    put32(tail, 0);
    put64(tail, end);
    put32(tail, 1);
  }
  put32(tail, 0x06054b50U);
  put16(tail, 0);
  put16(tail, 0);
  put16(tail, entries_.size());
  put16(tail, entries_.size());
  put32(tail, end - start);
  put32(tail, clamp32(start));
  put16(tail, 0);
  write(tail);
}

}  // namespace blum::volume_io
