// Blum has its own parser. It must accept bytes from memory, limit its memory by the file's length, and survive any
// input. The header is a fixed record of 348 or 540 bytes.
#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstring>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <type_traits>
#include <variant>
#include <vector>

#include "blum/core/error.hpp"
#include "blum/core/exact_text.hpp"
#include "blum/core/ids.hpp"
#include "io/bytes/scalar_type.hpp"
#include "io/format_table.hpp"
#include "io/image/image_files.hpp"
#include "io/text/text_cursor.hpp"

namespace blum::volume_io {
namespace {

constexpr std::size_t size_1 = 348;
constexpr std::size_t size_2 = 540;

/// Header data that both versions of the format have.
struct NiftiHeader {
  std::endian order = std::endian::native;
  std::size_t size = 0;  ///< size of the header in bytes
  bool detached = false;
  std::array<std::int64_t, 8> dim{};
  std::int64_t datatype = 0;
  std::array<double, 8> pixdim{};
  double data_offset = 0;
  double slope = 0;
  double intercept = 0;
  std::int64_t qform_code = 0;
  std::int64_t sform_code = 0;
  Vec3d quaternion{};  ///< components b, c, d
  Vec3d qoffset{};
  std::array<std::array<double, 4>, 3> srow{};
};

/// Record of numbers in the file's byte order.
class Record {
 public:
  Record(std::span<const std::byte> bytes, std::endian order) : bytes_(bytes), order_(order) {}
  template <class T>
  [[nodiscard]] T get(std::size_t offset) const {
    std::array<std::byte, sizeof(T)> raw{};
    std::copy_n(bytes_.begin() + static_cast<std::ptrdiff_t>(offset), sizeof(T), raw.begin());
    if (order_ != std::endian::native) std::reverse(raw.begin(), raw.end());
    return std::bit_cast<T>(raw);
  }
  template <class T, std::size_t n, class Out = double>
  [[nodiscard]] std::array<Out, n> array(std::size_t offset) const {
    std::array<Out, n> out{};
    for (std::size_t i = 0; i < n; ++i) out[i] = static_cast<Out>(get<T>(offset + i * sizeof(T)));
    return out;
  }

 private:
  std::span<const std::byte> bytes_;
  std::endian order_;
};

/// Offsets of a header's fields. The two versions differ only in these offsets and in the types of fields (nifti1.h,
/// nifti2.h).
struct Layout {
  std::size_t dim, datatype, pixdim, data_offset, slope, intercept, qform, sform, quaternion, qoffset, srow;
};
constexpr Layout layout_1{40, 70, 76, 108, 112, 116, 252, 254, 256, 268, 280};
constexpr Layout layout_2{16, 12, 104, 168, 176, 184, 344, 348, 352, 376, 400};

template <class Dim, class Offset, class Code, class Real>
void read_fields(const Record& record, const Layout& at, NiftiHeader& header) {
  header.dim = record.array<Dim, 8, std::int64_t>(at.dim);
  header.datatype = record.get<std::int16_t>(at.datatype);
  header.pixdim = record.array<Real, 8>(at.pixdim);
  header.data_offset = static_cast<double>(record.get<Offset>(at.data_offset));
  header.slope = static_cast<double>(record.get<Real>(at.slope));
  header.intercept = static_cast<double>(record.get<Real>(at.intercept));
  header.qform_code = record.get<Code>(at.qform);
  header.sform_code = record.get<Code>(at.sform);
  const auto quaternion = record.array<Real, 3>(at.quaternion);
  const auto qoffset = record.array<Real, 3>(at.qoffset);
  header.quaternion = {quaternion[0], quaternion[1], quaternion[2]};
  header.qoffset = {qoffset[0], qoffset[1], qoffset[2]};
  for (std::size_t row = 0; row < 3; ++row) {
    header.srow[row] = record.array<Real, 4>(at.srow + row * 4 * sizeof(Real));
  }
}

NiftiHeader read_header(ByteStream& stream) {
  std::vector<std::byte> bytes(size_2);
  stream.read(std::span(bytes).first(size_1), "the header");
  NiftiHeader header;
  const std::endian other = std::endian::native == std::endian::little ? std::endian::big : std::endian::little;
  for (const std::endian order : {std::endian::native, other}) {
    const auto size = Record(bytes, order).get<std::int32_t>(0);
    if (size != std::int32_t{size_1} && size != std::int32_t{size_2}) continue;
    header.order = order;
    header.size = static_cast<std::size_t>(size);
  }
  if (header.size == 0) throw FormatError(stream.name() + ": it does not begin as a NIfTI file");
  const bool second = header.size == size_2;
  if (second) stream.read(std::span(bytes).subspan(size_1), "the header");
  const char* magic = reinterpret_cast<const char*>(bytes.data()) + (second ? 4 : 344);
  const std::string_view version = second ? "2" : "1";
  if (magic[0] != 'n' || (magic[1] != '+' && magic[1] != 'i') || magic[2] != version[0] || magic[3] != '\0') {
    throw FormatError(stream.name() + ": the mark of a NIfTI file is missing; Analyze files are not read");
  }
  header.detached = magic[1] == 'i';
  const Record record(bytes, header.order);
  if (second) {
    read_fields<std::int64_t, std::int64_t, std::int32_t, double>(record, layout_2, header);
  } else {
    read_fields<std::int16_t, float, std::int16_t, float>(record, layout_1, header);
  }
  return header;
}

ScalarType type_of(std::int64_t code, const std::string& name) {
  switch (code) {
    case 2:
      return ScalarType::u8;
    case 256:
      return ScalarType::i8;
    case 512:
      return ScalarType::u16;
    case 4:
      return ScalarType::i16;
    case 768:
      return ScalarType::u32;
    case 8:
      return ScalarType::i32;
    case 1280:
      return ScalarType::u64;
    case 1024:
      return ScalarType::i64;
    case 16:
      return ScalarType::f32;
    case 64:
      return ScalarType::f64;
    default:
      throw FormatError(name + ": values of NIfTI type " + std::to_string(code) +
                        " are not read; integers of 8 to 64 bits, float and double are (no colour, no complex)");
  }
}

std::array<std::int64_t, 3> image_size(const NiftiHeader& header, const std::string& name) {
  if (header.dim[0] < 1 || header.dim[0] > 7) {
    throw FormatError(name + ": the number of dimensions is " + std::to_string(header.dim[0]) +
                      ", but it must be 1 to 7");
  }
  std::array<std::int64_t, 3> size{1, 1, 1};
  for (std::size_t d = 1; d <= static_cast<std::size_t>(header.dim[0]); ++d) {
    if (d <= 3) {
      size[d - 1] = header.dim[d];
    } else if (header.dim[d] != 1 && header.dim[d] != 0) {  // some writers leave the sizes of unused axes at 0
      throw FormatError(name + ": it has " + std::to_string(header.dim[d]) + " images along dimension " +
                        std::to_string(d) + "; extract one of them first");
    }
  }
  check_count(size, max_id_count, name);
  return size;
}

/// Returns the columns of the rotation of a unit quaternion (a, b, c, d) with a >= 0 (nifti1.h, method 2).
std::array<Vec3d, 3> rotation(const Vec3d& q, const std::string& name) {
  double b = q.x;
  double c = q.y;
  double d = q.z;
  const double rest = 1 - dot(q, q);
  if (!(rest > -1e-5)) throw FormatError(name + ": the quaternion of the qform is longer than 1");
  double a = std::sqrt(std::max(rest, 0.0));
  const double norm = std::sqrt(a * a + dot(q, q));
  a /= norm;
  b /= norm;
  c /= norm;
  d /= norm;
  return {Vec3d{a * a + b * b - c * c - d * d, 2 * (b * c + a * d), 2 * (b * d - a * c)},
          Vec3d{2 * (b * c - a * d), a * a + c * c - b * b - d * d, 2 * (c * d + a * b)},
          Vec3d{2 * (b * d + a * c), 2 * (c * d - a * b), a * a + d * d - c * c - b * b}};
}

/// Returns the steps along the axes, from the header's spacings. For an axis with one layer, the spacing may be
/// missing.
Vec3d spacings(const NiftiHeader& header, const GridSpec& grid) {
  Vec3d out{};
  for (std::size_t a = 0; a < 3; ++a) {
    out[a] = std::abs(header.pixdim[a + 1]);
    if (grid.size[a] == 1 && !(out[a] > 0 && std::isfinite(out[a]))) out[a] = 1;
  }
  return out;
}

void set_sform(const NiftiHeader& header, GridSpec& grid, const std::string& name) {
  std::array<std::optional<Vec3d>, 3> steps;
  for (std::size_t a = 0; a < 3; ++a) {
    const Vec3d column{header.srow[0][a], header.srow[1][a], header.srow[2][a]};
    if (grid.size[a] > 1 || column != Vec3d{}) steps[a] = column;
  }
  set_frame(grid, steps, name);
  grid.origin = {header.srow[0][3], header.srow[1][3], header.srow[2][3]};
}

void set_qform(const NiftiHeader& header, GridSpec& grid, const std::string& name) {
  std::array<Vec3d, 3> axes = rotation(header.quaternion, name);
  if (header.pixdim[0] < 0) axes[2] = -axes[2];
  set_frame(grid, axes, spacings(header, grid), name);
  grid.origin = header.qoffset;
}

/// Returns the reason why set_sform() failed.
std::string sform_problem(const NiftiHeader& header) {
  std::array<Vec3d, 3> axes;
  for (std::size_t a = 0; a < 3; ++a) axes[a] = {header.srow[0][a], header.srow[1][a], header.srow[2][a]};
  const std::string shear = shear_text(axes);
  return shear.empty() ? "has a step that is zero or not finite" : "has shear: its " + shear;
}

/// Sets the frame of a file with two frames. The sform is used if it is valid.
void read_both(const NiftiHeader& header, ImageFile& file, const std::string& name) {
  GridSpec& grid = file.image.grid;
  GridSpec other = grid;
  const auto add = [&](const std::string& text) {
    file.warnings.emplace_back(WarningCode::left_out, name + ": " + text);
  };
  try {
    set_sform(header, grid, name);
  } catch (const FormatError&) {
    // Registration may have put shear into the sform. If the sform has shear, the qform, which has the scanner's grid,
    // is used.
    set_qform(header, grid, name);
    add("the sform " + sform_problem(header) + "; the qform is used instead");
    return;
  }
  try {
    set_qform(header, other, name);
  } catch (const FormatError&) {
    add("the qform is invalid; the sform is used");
    return;
  }
  const double apart = frame_distance(grid, other);
  if (apart <= largest_frame_distance) return;
  add("the sform and the qform disagree: they place corners of the image up to " + rounded_text(apart) +
      " voxels apart; the sform is used, and the qform is ignored");
}

/// Warns if the steps of the sform, which is the only form, disagree with the header's spacings. Spacings that are
/// missing agree with everything.
void compare_spacings(const NiftiHeader& header, ImageFile& file, const std::string& name) {
  const GridSpec& grid = file.image.grid;
  const Vec3d other = spacings(header, grid);
  for (std::size_t a = 0; a < 3; ++a) {
    const double last = static_cast<double>(grid.size[a] - 1);  // index of the last voxel
    const double step = grid.spacing[a];
    const bool is_stated = other[a] > 0 && std::isfinite(other[a]);
    if (!is_stated || std::abs(other[a] - step) * last <= largest_frame_distance * step) continue;
    const auto text = [](const Vec3d& v) {
      return "(" + rounded_text(v.x) + ", " + rounded_text(v.y) + ", " + rounded_text(v.z) + ")";
    };
    file.warnings.emplace_back(WarningCode::left_out, name + ": the sform has the steps " + text(grid.spacing) +
                                                          ", but the spacings (pixdim) are " + text(other) +
                                                          "; the sform is used");
    return;
  }
}

void read_frame(const NiftiHeader& header, ImageFile& file, const std::string& name) {
  GridSpec& grid = file.image.grid;
  if (header.sform_code > 0 && header.qform_code > 0) {
    read_both(header, file, name);
  } else if (header.sform_code > 0) {
    set_sform(header, grid, name);
    compare_spacings(header, file, name);
  } else if (header.qform_code > 0) {
    set_qform(header, grid, name);
  } else {
    set_frame(grid, {Vec3d{1, 0, 0}, Vec3d{0, 1, 0}, Vec3d{0, 0, 1}}, spacings(header, grid), name);
  }
  if (!is_finite(grid.origin)) throw FormatError(name + ": the origin is not finite");
}

VoxelImage::Values scaled(const VoxelImage::Values& values, double slope, double intercept) {
  return std::visit(
      [&](const auto& v) {
        std::vector<double> out(v.size());
        std::transform(v.begin(), v.end(), out.begin(),
                       [&](auto value) { return slope * static_cast<double>(value) + intercept; });
        return VoxelImage::Values(std::move(out));
      },
      values);
}

/// Returns the number of bytes to skip before the data. The number is counted from the start of a separate data file,
/// or from the end of the header.
std::uint64_t gap(const NiftiHeader& header, const std::string& name) {
  // Some writers leave the offset at 0. The data then follow the header and its four bytes of extension flags.
  const bool unset = !header.detached && header.data_offset == 0;
  const double least = header.detached ? 0.0 : static_cast<double>(header.size + 4);
  const double offset = unset ? least : header.data_offset;
  if (!(offset >= least && offset <= 1e15) || offset != std::floor(offset)) {
    throw FormatError(name + ": the data cannot begin at byte " + exact_text(offset));
  }
  return static_cast<std::uint64_t>(offset) - (header.detached ? 0 : header.size);
}

}  // namespace

std::unique_ptr<ByteStream> open_plain_or_gzip(const ByteSource& source) {
  std::array<std::byte, 2> start{};
  if (source.size() >= 2) source.read(0, start);
  if (start[0] == std::byte{0x1f} && start[1] == std::byte{0x8b}) {
    return std::make_unique<InflateStream>(source, 0, source.size(), Compression::gzip);
  }
  return std::make_unique<PlainStream>(source);
}

ImageFile read_nifti(const ByteSource& source, const ByteSource* data_source) {
  const std::string& name = source.name();
  std::unique_ptr<ByteStream> stream = open_plain_or_gzip(source);
  const NiftiHeader header = read_header(*stream);
  const ScalarType type = type_of(header.datatype, name);
  ImageFile file;
  VoxelImage& image = file.image;
  image.grid.size = image_size(header, name);
  read_frame(header, file, name);
  if (header.sform_code > 0 || header.qform_code > 0) image.space = "right-anterior-superior";
  const bool scales = std::isfinite(header.slope) && header.slope != 0 && (header.slope != 1 || header.intercept != 0);
  if (scales && !std::isfinite(header.intercept))
    throw FormatError(name + ": the intercept of the values is not finite");
  if (header.detached) {
    if (data_source == nullptr) throw FormatError(name + ": its data are in another file; open the .hdr and .img pair");
    stream = open_plain_or_gzip(*data_source);
  }
  stream->skip(gap(header, name), "the part before the data");
  stream->check_left(image.grid.node_count() * scalar_size(type), "the data");
  image.values = make_values(type, image.grid.node_count());
  stream->read(as_bytes(image.values), "the data");
  stream->check_end();
  to_native(as_bytes(image.values), type, header.order);
  if (scales) image.values = scaled(image.values, header.slope, header.intercept);
  return file;
}

namespace {

bool begins_as_plain_nifti(std::string_view head) {
  return head.size() >= 348 && (head.substr(344, 3) == "n+1" || head.substr(4, 3) == "n+2");
}

/// Returns true if the first bytes are those of NIfTI, or the first bytes of a gzip file with NIfTI inside.
bool begins_as_nifti(std::string_view head) {
  if (!head.starts_with("\x1f\x8b")) return begins_as_plain_nifti(head);
  std::string inside(348, '\0');
  try {
    const MemorySource packed(std::as_bytes(std::span(head)), "");
    InflateStream stream(packed, 0, packed.size(), Compression::gzip);
    stream.read(std::as_writable_bytes(std::span(inside)), "the header");
  } catch (const FormatError&) {
    return false;
  }
  return begins_as_plain_nifti(inside);
}

ImageFile read(const ByteSource& source, const std::filesystem::path&) {
  return read_nifti(source, nullptr);
}

bool is_there(const std::filesystem::path& path) {
  std::error_code error;
  return std::filesystem::exists(path, error);
}

/// Returns the path of one file of a pair. The file may be compressed.
std::filesystem::path half_of_pair(const std::filesystem::path& stem, const char* extension) {
  std::filesystem::path plain = stem;
  plain += extension;
  std::filesystem::path packed = plain;
  packed += ".gz";
  return !is_there(plain) && is_there(packed) ? packed : plain;
}

/// Reads an image whose header and data are in two files. The path is that of either file.
std::optional<ImageFile> read_pair(const std::filesystem::path& path) {
  std::filesystem::path stem = path;
  if (lower_case(stem.extension().string()) == ".gz") stem.replace_extension();
  const std::string extension = lower_case(stem.extension().string());
  if (extension != ".hdr" && extension != ".img") return std::nullopt;
  stem.replace_extension();
  const FileSource header(half_of_pair(stem, ".hdr"), PipeUse::refuse);
  const FileSource data(half_of_pair(stem, ".img"), PipeUse::refuse);
  return read_nifti(header, &data);
}

}  // namespace

}  // namespace blum::volume_io

namespace blum::formats {

using namespace volume_io;

constinit const ImageCode image_nifti{read, nullptr, {begins_as_nifti}, read_pair};

}  // namespace blum::formats
