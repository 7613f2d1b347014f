#include <zlib.h>

#include <algorithm>
#include <limits>
#include <vector>

#include "blum/core/error.hpp"
#include "io/bytes/byte_source.hpp"

namespace blum::volume_io {
namespace {

constexpr std::size_t buffer_size = std::size_t{256} << 10;
/// One byte of deflate data expands to at most 1032 bytes (a match of 258 bytes in two bits).
constexpr std::uint64_t largest_ratio = 1032;

int window_bits(Compression compression) {
  switch (compression) {
    case Compression::gzip:
      return 15 + 16;
    case Compression::zlib:
      return 15;
    case Compression::deflate:
      break;
  }
  return -15;
}

}  // namespace

struct InflateStream::State {
  z_stream z{};
  std::vector<std::byte> input = std::vector<std::byte>(buffer_size);
  bool finished = false;
};

InflateStream::InflateStream(const ByteSource& source, std::uint64_t begin, std::uint64_t end, Compression compression)
    : source_(source), at_(begin), end_(end), compression_(compression), state_(std::make_unique<State>()) {
  if (inflateInit2(&state_->z, window_bits(compression)) != Z_OK) {
    throw OutOfMemory(name() + ": not enough memory to decompress it");
  }
}

InflateStream::~InflateStream() {
  inflateEnd(&state_->z);
}

std::uint64_t InflateStream::most_left() const {
  if (state_->finished) return 0;
  // One byte more than what is left may still be held in bits that are decoded already, and a match half copied.
  const std::uint64_t input = end_ - at_ + state_->z.avail_in + 8;
  return input > std::numeric_limits<std::uint64_t>::max() / largest_ratio ? std::numeric_limits<std::uint64_t>::max()
                                                                           : input * largest_ratio;
}

void InflateStream::refill() {
  const std::size_t count = static_cast<std::size_t>(std::min<std::uint64_t>(buffer_size, end_ - at_));
  source_.read(at_, std::span(state_->input).first(count));
  at_ += count;
  state_->z.next_in = reinterpret_cast<Bytef*>(state_->input.data());
  state_->z.avail_in = static_cast<uInt>(count);
}

/// Gzip files may be several one after the other, with zeros behind; anything else behind them is not looked at.
void InflateStream::end_of_member() {
  z_stream& z = state_->z;
  if (z.avail_in == 0 && at_ < end_) refill();
  const bool more = compression_ == Compression::gzip && z.avail_in > 0 && z.next_in[0] == 0x1f;
  if (more) {
    inflateReset(&z);
  } else {
    state_->finished = true;
  }
}

std::size_t InflateStream::read_some(std::span<std::byte> out) {
  z_stream& z = state_->z;
  std::size_t done = 0;
  while (done < out.size() && !state_->finished) {
    if (z.avail_in == 0 && at_ < end_) refill();
    const std::size_t room = std::min(out.size() - done, std::size_t{1} << 30U);
    z.next_out = reinterpret_cast<Bytef*>(out.data() + done);
    z.avail_out = static_cast<uInt>(room);
    const int status = inflate(&z, Z_NO_FLUSH);
    done += room - z.avail_out;
    if (status == Z_STREAM_END) {
      end_of_member();
    } else if (status == Z_BUF_ERROR && z.avail_in == 0 && at_ == end_) {
      throw FormatError(name() + ": the compressed data end too early; the file is cut short");
    } else if (status == Z_MEM_ERROR) {
      throw OutOfMemory(name() + ": not enough memory to decompress it");
    } else if (status != Z_OK && status != Z_BUF_ERROR) {
      throw FormatError(name() + ": the compressed data are damaged (" + (z.msg != nullptr ? z.msg : "zlib error") +
                        ")");
    }
  }
  return done;
}

}  // namespace blum::volume_io
