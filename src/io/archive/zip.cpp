#include "io/archive/zip.hpp"

#include <zlib.h>
#include <algorithm>
#include <array>
#include <optional>

#include "blum/core/error.hpp"
#include "blum/core/parallel.hpp"

namespace blum::volume_io {
namespace {

constexpr std::uint32_t limit32 = 0xFFFFFFFFU;
constexpr std::size_t end_size = 22;
constexpr std::size_t locator_size = 20;
constexpr std::size_t central_size = 46;
constexpr std::size_t local_size = 30;
/// Longest directory accepted, in bytes. No .npz file has a longer one.
constexpr std::uint64_t largest_directory = std::uint64_t{16} << 20U;

/// Reader of the little-endian numbers of a record. Reading beyond the record's end throws FormatError.
class Record {
 public:
  Record(std::span<const std::byte> bytes, const std::string& name) : bytes_(bytes), name_(name) {}
  [[nodiscard]] std::uint64_t number(std::size_t at, std::size_t size) const {
    if (at > bytes_.size() || size > bytes_.size() - at) {
      throw FormatError(name_ + ": a record of the zip archive is cut short");
    }
    std::uint64_t value = 0;
    for (std::size_t i = size; i-- > 0;) value = value << 8U | std::to_integer<std::uint64_t>(bytes_[at + i]);
    return value;
  }
  [[nodiscard]] std::size_t u16(std::size_t at) const { return static_cast<std::size_t>(number(at, 2)); }
  [[nodiscard]] std::uint32_t u32(std::size_t at) const { return static_cast<std::uint32_t>(number(at, 4)); }
  [[nodiscard]] std::uint64_t u64(std::size_t at) const { return number(at, 8); }
  [[nodiscard]] Record part(std::size_t at, std::size_t size) const {
    if (at > bytes_.size() || size > bytes_.size() - at) {
      throw FormatError(name_ + ": a record of the zip archive is cut short");
    }
    return {bytes_.subspan(at, size), name_};
  }
  [[nodiscard]] std::string text() const { return {reinterpret_cast<const char*>(bytes_.data()), bytes_.size()}; }
  [[nodiscard]] std::size_t size() const { return bytes_.size(); }

 private:
  std::span<const std::byte> bytes_;
  const std::string& name_;
};

std::vector<std::byte> read_bytes(const ByteSource& source, std::uint64_t offset, std::uint64_t size) {
  if (offset > source.size() || size > source.size() - offset) {
    throw FormatError(source.name() + ": a record of the zip archive lies beyond the end of the file; it is cut short");
  }
  std::vector<std::byte> bytes(static_cast<std::size_t>(size));
  source.read(offset, bytes);
  return bytes;
}

struct Directory {
  std::uint64_t offset = 0;
  std::uint64_t size = 0;
  std::uint64_t entries = 0;
};

/// Returns the zip64 directory record, if there is one. Its locator is directly before the end record.
std::optional<Directory> find_directory64(const ByteSource& source, std::uint64_t end_offset) {
  if (end_offset < locator_size) return std::nullopt;
  const auto bytes = read_bytes(source, end_offset - locator_size, locator_size);
  const Record locator(bytes, source.name());
  if (locator.u32(0) != 0x07064b50U) return std::nullopt;
  const auto record_bytes = read_bytes(source, locator.u64(8), 56);
  const Record record(record_bytes, source.name());
  if (record.u32(0) != 0x06064b50U)
    throw FormatError(source.name() + ": the zip64 record is not at its stated position");
  return Directory{record.u64(48), record.u64(40), record.u64(32)};
}

Directory find_directory(const ByteSource& source) {
  const std::uint64_t tail_size = std::min<std::uint64_t>(source.size(), end_size + 0xFFFF);
  const auto bytes = read_bytes(source, source.size() - tail_size, tail_size);
  const Record tail(bytes, source.name());
  for (std::size_t at = bytes.size() < end_size ? 0 : bytes.size() - end_size + 1; at-- > 0;) {
    if (tail.u32(at) != 0x06054b50U) continue;
    if (const auto large = find_directory64(source, source.size() - tail_size + at)) return *large;
    return {tail.u32(at + 16), tail.u32(at + 12), tail.u16(at + 10)};
  }
  throw FormatError(source.name() + ": it is cut short, or not a zip archive as .npz files must be");
}

/// Fields of a central header that have their largest value are replaced by their 64-bit values from the extra field.
void apply_zip64(const Record& extra, ZipEntry& entry) {
  std::size_t at = 0;
  while (at + 4 <= extra.size()) {
    const Record field = extra.part(at + 4, extra.u16(at + 2));
    if (extra.u16(at) == 1) {
      std::size_t next = 0;
      for (std::uint64_t* value : {&entry.size, &entry.packed_size, &entry.header_offset}) {
        if (*value != limit32) continue;
        *value = field.u64(next);
        next += 8;
      }
      return;
    }
    at += 4 + field.size();
  }
}

}  // namespace

ZipReader::ZipReader(const ByteSource& source) : source_(source) {
  const Directory directory = find_directory(source);
  if (directory.size > largest_directory) throw FormatError(source.name() + ": the zip directory is too long");
  const auto bytes = read_bytes(source, directory.offset, directory.size);
  const Record records(bytes, source.name());
  std::size_t at = 0;
  for (std::uint64_t i = 0; i < directory.entries; ++i) {
    const Record head = records.part(at, central_size);
    if (head.u32(0) != 0x02014b50U) throw FormatError(source.name() + ": the zip directory is damaged");
    const std::size_t name_size = head.u16(28);
    const std::size_t extra_size = head.u16(30);
    ZipEntry entry;
    entry.name = records.part(at + central_size, name_size).text();
    if ((head.u16(8) & 1U) != 0) throw FormatError(source.name() + ": '" + entry.name + "' in it is encrypted");
    if (head.u16(10) != 0 && head.u16(10) != 8) {
      throw FormatError(source.name() + ": '" + entry.name + "' is compressed by method " +
                        std::to_string(head.u16(10)) + "; only stored and deflated entries are read");
    }
    entry.deflated = head.u16(10) == 8;
    entry.crc = head.u32(16);
    entry.packed_size = head.u32(20);
    entry.size = head.u32(24);
    entry.header_offset = head.u32(42);
    apply_zip64(records.part(at + central_size + name_size, extra_size), entry);
    entries_.push_back(std::move(entry));
    at += central_size + name_size + extra_size + head.u16(32);
  }
}

const ZipEntry* ZipReader::find(std::string_view name) const {
  const auto found = std::find_if(entries_.begin(), entries_.end(), [&](const ZipEntry& e) { return e.name == name; });
  return found == entries_.end() ? nullptr : &*found;
}

std::unique_ptr<ZipEntryStream> ZipReader::open(const ZipEntry& entry) const {
  const std::string name = source_.name() + "(" + entry.name + ")";
  const auto bytes = read_bytes(source_, entry.header_offset, local_size);
  const Record head(bytes, name);
  if (head.u32(0) != 0x04034b50U)
    throw FormatError(name + ": the entry is not at the position that the zip directory states");
  const std::uint64_t begin = entry.header_offset + local_size + head.u16(26) + head.u16(28);
  if (begin > source_.size() || entry.packed_size > source_.size() - begin) {
    throw FormatError(name + ": the entry reaches beyond the end of the file; it is cut short");
  }
  if (!entry.deflated && entry.packed_size != entry.size) {
    throw FormatError(name + ": the zip directory gives two sizes for an entry that is not compressed");
  }
  const std::uint64_t end = begin + entry.packed_size;
  std::unique_ptr<ByteStream> inner;
  if (entry.deflated) {
    inner = std::make_unique<InflateStream>(source_, begin, end, Compression::deflate);
  } else {
    inner = std::make_unique<PlainStream>(source_, begin, end);
  }
  return std::make_unique<ZipEntryStream>(std::move(inner), entry, name);
}

std::size_t ZipEntryStream::read_some(std::span<std::byte> out) {
  std::size_t done = 0;
  const std::size_t wanted = static_cast<std::size_t>(std::min<std::uint64_t>(out.size(), left_));
  // The data are written in pieces that stay in the cache while the checksum is computed.
  constexpr std::size_t piece = std::size_t{1} << 20U;
  while (done < wanted) {
    const auto part = out.subspan(done, std::min(piece, wanted - done));
    const std::size_t got = inner_->read_some(part);
    crc_ = static_cast<std::uint32_t>(crc32_z(crc_, reinterpret_cast<const Bytef*>(part.data()), got));
    done += got;
    if (got < part.size()) break;
  }
  left_ -= done;
  return done;
}

std::uint64_t ZipEntryStream::most_left() const {
  return std::min(left_, inner_->most_left());
}

void ZipEntryStream::check_finished() const {
  if (left_ != 0) {
    throw FormatError(name_ + ": after its end, as its header states it, there are " + std::to_string(left_) +
                      " more bytes");
  }
  if (crc_ != expected_crc_) throw FormatError(name_ + ": its checksum is wrong; the file is damaged");
}

namespace {

constexpr std::size_t crc_piece = std::size_t{4} << 20;
constexpr std::uint16_t version_plain = 20;
constexpr std::uint16_t version_zip64 = 45;
constexpr std::uint16_t date_1980 = 0x21;  ///< 1 January 1980; always the same, so that equal input gives equal bytes

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

/// Appends the fields that local and central headers have in common: from the required version to the lengths of name
/// and extra field.
void put_common(std::string& out, bool zip64, std::uint32_t crc, std::uint32_t size, std::size_t name_length,
                std::size_t extra_length) {
  put16(out, zip64 ? version_zip64 : version_plain);
  put16(out, 0);  // flags
  put16(out, 0);  // method: stored
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
  parallel_for(
      context, pieces, 1, "",
      [&](const WorkRange& range) {
        for (std::size_t i = range.begin; i < range.end; ++i) parts[i] = crc_of(0, piece(i));
      },
      Start::at_once);
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
    put16(header, 0x0300U | version_zip64);  // made by this version, on Unix
    put_common(header, large || far, entry.crc, clamp32(entry.size), entry.name.size(), extra.size());
    put16(header, 0);               // length of the comment
    put16(header, 0);               // number of the disk
    put16(header, 0);               // internal attributes
    put32(header, 0100644U << 16);  // regular file, readable by everyone
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
