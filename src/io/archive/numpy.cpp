#include "io/archive/numpy.hpp"

#include <algorithm>
#include <charconv>
#include <limits>

#include "blum/core/error.hpp"
#include "blum/core/ids.hpp"
#include "io/format_table.hpp"
#include "io/image/image_files.hpp"

namespace blum::volume_io {
namespace {

constexpr std::string_view magic = "\x93NUMPY";
/// Longest header accepted, in bytes. Only structured types have longer ones, and image files do not use these.
constexpr std::uint64_t largest_header = 65536;
constexpr std::array<std::string_view, 10> dtypes{"u1", "i1", "u2", "i2", "u4", "i4", "u8", "i8", "f4", "f8"};

/// Parser of the Python dictionary in a header. Its values are strings, True and False, and a tuple of integers.
class HeaderReader {
 public:
  HeaderReader(std::string_view text, const std::string& name) : text_(text), name_(name) {}

  NpyHeader read() {
    NpyHeader header;
    bool has_type = false;
    bool has_order = false;
    bool has_shape = false;
    expect('{');
    while (!accept('}')) {
      const std::string_view key = string();
      expect(':');
      if (key == "descr") {
        set_type(header, string());
        has_type = true;
      } else if (key == "fortran_order") {
        header.fortran = boolean();
        has_order = true;
      } else if (key == "shape") {
        header.shape = tuple();
        has_shape = true;
      } else {
        fail("it has the unknown key '" + std::string(key) + "'");
      }
      if (!accept(',')) {
        expect('}');
        break;
      }
    }
    if (!has_type || !has_order || !has_shape) fail("it needs 'descr', 'fortran_order' and 'shape'");
    return header;
  }

 private:
  [[noreturn]] void fail(const std::string& reason) const {
    throw FormatError(name_ + ": the header of the array cannot be used: " + reason);
  }
  void skip_space() {
    while (at_ < text_.size() && (text_[at_] == ' ' || text_[at_] == '\n')) ++at_;
  }
  bool accept(char c) {
    skip_space();
    if (at_ >= text_.size() || text_[at_] != c) return false;
    ++at_;
    return true;
  }
  void expect(char c) {
    if (!accept(c)) fail(std::string("'") + c + "' is expected at character " + std::to_string(at_));
  }
  std::string_view string() {
    skip_space();
    const char quote = at_ < text_.size() ? text_[at_] : '\0';
    if (quote == '[') fail("the values are records; save one plain array of numbers");
    if (quote != '\'' && quote != '"') fail("a string is expected at character " + std::to_string(at_));
    const std::size_t end = text_.find(quote, at_ + 1);
    if (end == std::string_view::npos) fail("a string does not end");
    const std::string_view out = text_.substr(at_ + 1, end - at_ - 1);
    at_ = end + 1;
    return out;
  }
  bool boolean() {
    skip_space();
    for (const std::string_view word : {"True", "False"}) {
      if (text_.substr(at_).starts_with(word)) {
        at_ += word.size();
        return word == "True";
      }
    }
    fail("fortran_order is neither True nor False");
  }
  std::vector<std::uint64_t> tuple() {
    std::vector<std::uint64_t> out;
    expect('(');
    while (!accept(')')) {
      skip_space();
      std::uint64_t value = 0;
      const auto [end, error] = std::from_chars(text_.data() + at_, text_.data() + text_.size(), value);
      if (error != std::errc()) fail("the shape is not a tuple of numbers");
      at_ = static_cast<std::size_t>(end - text_.data());
      out.push_back(value);
      if (out.size() > 32) fail("it has more than 32 axes");
      if (!accept(',')) {
        expect(')');
        break;
      }
    }
    return out;
  }

  void set_type(NpyHeader& header, std::string_view descr) const {
    const std::string shown = "values of type '" + std::string(descr) + "' are not read; ";
    std::string_view type = descr;
    if (!type.empty() && std::string_view("<>=|").find(type.front()) != std::string_view::npos) {
      header.order = type.front() == '<'   ? std::endian::little
                     : type.front() == '>' ? std::endian::big
                                           : std::endian::native;
      type.remove_prefix(1);
    }
    if (type == "b1") type = "u1";
    const auto found = std::find(dtypes.begin(), dtypes.end(), type);
    if (found != dtypes.end()) {
      header.type = static_cast<ScalarType>(found - dtypes.begin());
      return;
    }
    if (!type.starts_with('U')) fail(shown + "save bool, integers of 8 to 64 bits, float32 or float64");
    header.kind = NpyHeader::Kind::text;
    const char* last = type.data() + type.size();
    const auto [end, error] = std::from_chars(type.data() + 1, last, header.text_length);
    if (error != std::errc() || end != last || header.text_length > (std::size_t{1} << 24U))
      fail(shown + "save numbers, or a text of at most 2^24 characters");
  }

  std::string_view text_;
  const std::string& name_;
  std::size_t at_ = 0;
};

/// Converts an array in which the first axis is the fastest to C order. `shape` has at most three axes.
template <class T>
std::vector<T> transposed(const std::vector<T>& values, const std::vector<std::uint64_t>& shape) {
  std::array<std::size_t, 3> n{1, 1, 1};  // the shape, padded with ones at the front, so that axis 2 is x
  for (std::size_t i = 0; i < shape.size(); ++i) n[3 - shape.size() + i] = static_cast<std::size_t>(shape[i]);
  std::vector<T> out(values.size());
  std::size_t at = 0;
  for (std::size_t x = 0; x < n[2]; ++x) {
    for (std::size_t y = 0; y < n[1]; ++y) {
      for (std::size_t z = 0; z < n[0]; ++z) out[(z * n[1] + y) * n[2] + x] = values[at++];
    }
  }
  return out;
}

}  // namespace

std::string_view npy_dtype(ScalarType type) {
  return dtypes[static_cast<std::size_t>(type)];
}

std::string npy_header(std::string_view dtype, const std::vector<std::uint64_t>& shape) {
  std::string out = "{'descr': '";
  if (dtype == "u1" || dtype == "i1") {
    out += '|';
  } else {
    out += std::endian::native == std::endian::little ? '<' : '>';
  }
  out += std::string(dtype) + "', 'fortran_order': False, 'shape': (";
  for (std::size_t i = 0; i < shape.size(); ++i) {
    out += std::to_string(shape[i]);
    if (i + 1 < shape.size() || shape.size() == 1) out += ",";
    if (i + 1 < shape.size()) out += " ";
  }
  out += "), }";
  constexpr std::size_t start = 10;
  const std::size_t total = (start + out.size() + 1 + 63) / 64 * 64;
  out.append(total - start - out.size() - 1, ' ');
  out += '\n';
  std::string head(magic);
  head += '\x01';
  head += '\0';
  head += static_cast<char>(out.size() & 0xFFU);
  head += static_cast<char>(out.size() >> 8U);
  return head + out;
}

std::uint64_t NpyHeader::count(const std::string& name) const {
  std::uint64_t product = 1;
  for (const std::uint64_t n : shape) {
    if (n != 0 && product > max_field_nodes / n) throw FormatError(name + ": the array has more than 2^40 values");
    product *= n;
  }
  return product;
}

NpyHeader read_npy_header(ByteStream& stream) {
  std::array<unsigned char, 8> start{};
  stream.read(std::as_writable_bytes(std::span(start)), "the start of the array");
  if (!std::equal(magic.begin(), magic.end(), start.begin(),
                  [](char a, unsigned char b) { return static_cast<unsigned char>(a) == b; })) {
    throw FormatError(stream.name() + ": it does not begin as a NumPy array");
  }
  if (start[6] < 1 || start[6] > 3) {
    throw FormatError(stream.name() + ": version " + std::to_string(start[6]) +
                      " of the format is not read; versions 1 to 3 are");
  }
  std::array<unsigned char, 4> length_bytes{};
  const std::size_t length_size = start[6] == 1 ? 2 : 4;
  stream.read(std::as_writable_bytes(std::span(length_bytes)).first(length_size), "the length of the header");
  const std::uint64_t length = length_bytes[0] | std::uint64_t{length_bytes[1]} << 8U |
                               std::uint64_t{length_bytes[2]} << 16U | std::uint64_t{length_bytes[3]} << 24U;
  if (length > largest_header) throw FormatError(stream.name() + ": the header of the array is too long");
  std::string text(static_cast<std::size_t>(length), '\0');
  stream.read(std::as_writable_bytes(std::span(text)), "the header of the array");
  return HeaderReader(text, stream.name()).read();
}

std::uint64_t check_npy_values(const ByteStream& stream, const NpyHeader& header) {
  if (header.kind != NpyHeader::Kind::scalar) throw FormatError(stream.name() + ": it holds text, not numbers");
  const std::uint64_t count = header.count(stream.name());
  stream.check_left(count * scalar_size(header.type), "the values");
  return count;
}

void read_npy_raw(ByteStream& stream, const NpyHeader& header, std::span<std::byte> out) {
  stream.read(out, "the values");
  to_native(out, header.type, header.order);
}

VoxelImage::Values read_npy_values(ByteStream& stream, const NpyHeader& header) {
  const std::uint64_t count = check_npy_values(stream, header);
  VoxelImage::Values values = make_values(header.type, static_cast<std::size_t>(count));
  read_npy_raw(stream, header, as_bytes(values));
  if (!header.fortran || header.shape.size() < 2) return values;
  if (header.shape.size() > 3) {
    throw FormatError(stream.name() + ": Fortran order is read for up to three axes only");
  }
  return std::visit([&](const auto& v) { return VoxelImage::Values(transposed(v, header.shape)); }, values);
}

std::array<std::int64_t, 3> npy_image_size(const NpyHeader& header, const std::string& name) {
  if (header.shape.empty() || header.shape.size() > 3) {
    throw FormatError(name + ": the array has " + std::to_string(header.shape.size()) +
                      " axes; an image has one to three, [z, y, x]");
  }
  std::array<std::int64_t, 3> size{1, 1, 1};
  for (std::size_t i = 0; i < header.shape.size(); ++i) {
    const std::uint64_t n = header.shape[header.shape.size() - 1 - i];
    if (n > max_field_nodes) throw FormatError(name + ": the array has more than 2^40 values");
    size[i] = static_cast<std::int64_t>(n);
  }
  check_count(size, max_field_nodes, name);
  return size;
}

namespace {

bool begins_as_npy(std::string_view head) {
  return head.starts_with("\x93NUMPY");
}

ImageFile read_npy(const ByteSource& source, const std::filesystem::path&) {
  PlainStream stream(source);
  const NpyHeader header = read_npy_header(stream);
  VoxelImage image;
  image.grid.size = npy_image_size(header, stream.name());
  check_count(image.grid.size, max_id_count, stream.name());
  image.values = read_npy_values(stream, header);
  return {std::move(image)};
}

void write_npy(const std::filesystem::path& path, const VoxelImageView& image) {
  const auto& n = image.grid.size;
  const std::vector<std::uint64_t> shape{static_cast<std::uint64_t>(n[2]), static_cast<std::uint64_t>(n[1]),
                                         static_cast<std::uint64_t>(n[0])};
  write_values_after(path, npy_header(npy_dtype(scalar_type(image.values)), shape), image);
}

}  // namespace

}  // namespace blum::volume_io

namespace blum::formats {

using namespace volume_io;

constinit const ImageCode image_npy{read_npy, write_npy, {begins_as_npy}};

}  // namespace blum::formats

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
      throw FormatError(stream.name() + ": it must be one string");
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
