#include "view/scene_blob.hpp"

#include <zlib.h>

#include <bit>
#include <cstring>
#include <string>

#include "blum/core/error.hpp"

namespace blum::cli {
namespace {

static_assert(std::endian::native == std::endian::little, "scenes are little endian");

constexpr std::size_t alignment = 8;
constexpr std::size_t worth_deflating = 256;  // bytes; smaller arrays are not compressed
constexpr std::size_t most_at_once = std::size_t{1} << 30;

std::size_t aligned(std::size_t size) {
  return (size + alignment - 1) / alignment * alignment;
}

/// Encodes numbers as differences, and groups the bytes of equal rank. Neighbouring numbers differ little, so such
/// bytes compress well.
std::vector<std::byte> delta(std::span<const std::byte> bytes) {
  const std::size_t count = bytes.size() / 4;
  std::vector<std::byte> out(bytes.size());
  std::uint32_t last = 0;
  for (std::size_t i = 0; i < count; ++i) {
    std::uint32_t value = 0;
    std::memcpy(&value, bytes.data() + 4 * i, 4);
    const std::uint32_t difference = value - last;
    last = value;
    for (std::size_t b = 0; b < 4; ++b) out[b * count + i] = static_cast<std::byte>(difference >> (8 * b));
  }
  return out;
}

/// Compresses bytes with zlib at its fastest level. Other levels need several times as long to save a few per cent.
std::vector<std::byte> deflated(std::span<const std::byte> bytes) {
  z_stream stream = {};
  if (deflateInit(&stream, Z_BEST_SPEED) != Z_OK) throw OutOfMemory("no memory to compress the scene");
  std::vector<std::byte> out(deflateBound(&stream, static_cast<uLong>(bytes.size())));
  std::size_t read = 0;
  std::size_t written = 0;
  int status = Z_OK;
  while (status == Z_OK) {
    const std::size_t in_now = std::min(most_at_once, bytes.size() - read);
    const std::size_t out_now = std::min(most_at_once, out.size() - written);
    // The cast is safe, because zlib only reads through this pointer.
    stream.next_in = reinterpret_cast<Bytef*>(const_cast<std::byte*>(bytes.data() + read));  // NOLINT(*-const-cast)
    stream.avail_in = static_cast<uInt>(in_now);
    stream.next_out = reinterpret_cast<Bytef*>(out.data() + written);
    stream.avail_out = static_cast<uInt>(out_now);
    status = deflate(&stream, read + in_now == bytes.size() ? Z_FINISH : Z_NO_FLUSH);
    read += in_now - stream.avail_in;
    written += out_now - stream.avail_out;
  }
  deflateEnd(&stream);
  if (status != Z_STREAM_END) throw Error("the scene could not be compressed");
  out.resize(written);
  return out;
}

}  // namespace

Json SceneBlob::add_bytes(std::span<const std::byte> bytes, const char* type, std::size_t count, std::size_t width) {
  const char* coding = "raw";
  std::vector<std::byte> stored;
  if (compresses_ && bytes.size() >= worth_deflating) {
    coding = width == 4 ? "delta" : "deflate";
    stored = deflated(width == 4 ? std::span<const std::byte>(delta(bytes)) : bytes);
  } else {
    stored.assign(bytes.begin(), bytes.end());
  }
  const Json entry = {
      {"type", type}, {"count", count}, {"offset", size_}, {"bytes", stored.size()}, {"coding", coding}};
  stored.resize(aligned(stored.size()));
  size_ += stored.size();
  arrays_.push_back(std::move(stored));
  return entry;
}

std::string SceneBlob::head(const Json& header) {
  std::string text = header.dump();
  text.resize(aligned(text.size()), ' ');
  std::string head = "BLUMVIEW";
  for (const std::uint32_t number : {std::uint32_t{2}, static_cast<std::uint32_t>(text.size())}) {
    for (unsigned shift = 0; shift < 32; shift += 8) head += static_cast<char>(number >> shift & 0xffU);
  }
  return head + text;
}

std::vector<std::string_view> SceneBlob::arrays() const {
  std::vector<std::string_view> out;
  out.reserve(arrays_.size());
  for (const std::vector<std::byte>& array : arrays_) {
    out.emplace_back(reinterpret_cast<const char*>(array.data()), array.size());
  }
  return out;
}

}  // namespace blum::cli
