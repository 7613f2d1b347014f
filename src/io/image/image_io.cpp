#include "blum/io/image_io.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <utility>

#include "blum/core/error.hpp"
#include "blum/core/exact_text.hpp"
#include "blum/io/atomic_file.hpp"
#include "io/bytes/scalar_type.hpp"
#include "io/field/field_files.hpp"
#include "io/format_table.hpp"
#include "io/image/image_files.hpp"

namespace blum {
namespace {

using namespace volume_io;

ImageFile checked(ImageFile file, ImageFormat format, const std::string& name) {
  file.format = format;
  try {
    validate(file.image);
  } catch (const InvalidImage& error) {
    throw FormatError(name + ": " + error.what());
  }
  return file;
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

ImageFile read_image_file(const std::filesystem::path& path) {
  const ImageFormat format = ImageFormat::of(path);
  const formats::ImageCode& code = formats::code_of(format);
  if (code.read_several != nullptr) {
    if (auto file = code.read_several(path)) return checked(std::move(*file), format, path.string());
  }
  return checked(code.read(FileSource(path), path), format, path.string());
}

ImageFile read_image_file(std::span<const std::byte> bytes, ImageFormat format, const std::string& name) {
  return checked(formats::code_of(format).read(MemorySource(bytes, name), {}), format, name);
}

VoxelImage read_image(const std::filesystem::path& path) {
  return read_image_file(path).image;
}

VoxelImage read_image(std::span<const std::byte> bytes, ImageFormat format, const std::string& name) {
  return read_image_file(bytes, format, name).image;
}

void write_image(const std::filesystem::path& path, const VoxelImageView& image) {
  const ImageFormat format = ImageFormat::of(path, FileAccess::write);
  validate(image);
  formats::code_of(format).write(path, image);
}

}  // namespace blum

namespace blum::volume_io {
namespace {

constexpr const char* axis_names[3] = {"x", "y", "z"};

double largest_component(const Vec3d& v) {
  return std::max({std::abs(v.x), std::abs(v.y), std::abs(v.z)});
}

/// Returns the length of a vector without overflow or underflow.
double safe_length(const Vec3d& v) {
  const double scale = largest_component(v);
  return scale > 0 ? scale * length(v / scale) : 0;
}

Vec3d unit(const Vec3d& v) {
  const Vec3d scaled = v / largest_component(v);
  return scaled / length(scaled);
}

/// Returns a unit vector perpendicular to all given unit vectors. At most two are given; they must be perpendicular to
/// each other. Prefers the world axis with the number `axis`: an x axis alone is completed by y and z.
Vec3d perpendicular(const std::array<std::optional<Vec3d>, 3>& known, std::size_t axis) {
  Vec3d best{};
  for (std::size_t k = 0; k < 3; ++k) {
    Vec3d candidate{};
    candidate[(axis + k) % 3] = 1;
    for (const auto& v : known) {
      if (v) candidate -= *v * dot(candidate, *v);
    }
    if (length(candidate) > 0.5) return unit(candidate);
    if (length(candidate) > length(best)) best = candidate;
  }
  return unit(best);
}

}  // namespace

std::string shear_text(const std::array<Vec3d, 3>& axes) {
  constexpr std::array<std::array<std::size_t, 2>, 3> pairs{{{0, 1}, {1, 2}, {0, 2}}};
  const auto is_direction = [](const Vec3d& axis) { return is_finite(axis) && largest_component(axis) > 0; };
  for (const auto& [a, b] : pairs) {
    if (!is_direction(axes[a]) || !is_direction(axes[b])) continue;
    const double cosine = dot(unit(axes[a]), unit(axes[b]));
    if (std::abs(cosine) <= frame_tolerance) continue;
    const double degrees = std::acos(std::clamp(cosine, -1.0, 1.0)) * 180 / std::numbers::pi;
    return std::string("axes ") + axis_names[a] + " and " + axis_names[b] + " form an angle of " +
           rounded_text(degrees) + " degrees";
  }
  return {};
}

double frame_distance(const GridSpec& a, const GridSpec& b) {
  double step = 0;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    if (a.size[axis] > 1 && (step == 0 || a.spacing[axis] < step)) step = a.spacing[axis];
  }
  if (step == 0) step = a.spacing.x;
  double farthest = 0;
  for (unsigned corner = 0; corner < 8; ++corner) {
    std::array<std::int64_t, 3> at{};
    for (unsigned axis = 0; axis < 3; ++axis) at[axis] = (corner >> axis & 1U) != 0 ? a.size[axis] - 1 : 0;
    const double apart = safe_length(a.position(at[0], at[1], at[2]) - b.position(at[0], at[1], at[2]));
    if (!(apart <= farthest)) farthest = apart;
  }
  return farthest / step;
}

Mat3 nearest_orthonormal(const Mat3& matrix) {
  Mat3 m = matrix;
  // Each step of Newton's iteration doubles the number of correct digits. If the error is 1e-4, three steps are enough.
  for (int step = 0; step < 8; ++step) {
    const Vec3d* c = m.columns;
    const Vec3d cofactors[3] = {cross(c[1], c[2]), cross(c[2], c[0]), cross(c[0], c[1])};
    const double determinant = dot(c[0], cofactors[0]);
    Mat3 next;
    for (std::size_t a = 0; a < 3; ++a) next.columns[a] = (c[a] + cofactors[a] / determinant) * 0.5;
    if (next == m) break;
    m = next;
  }
  return m;
}

void set_frame(GridSpec& grid, const std::array<Vec3d, 3>& unit_axes, const Vec3d& steps, const std::string& name) {
  for (std::size_t a = 0; a < 3; ++a) {
    if (!(steps[a] > 0) || !std::isfinite(steps[a])) {
      throw FormatError(name + ": the spacing along " + axis_names[a] + " is " + exact_text(steps[a]) +
                        ", but it must be positive and finite");
    }
    const bool is_unit = is_finite(unit_axes[a]) && std::abs(safe_length(unit_axes[a]) - 1) <= frame_tolerance;
    if (!is_unit) throw FormatError(name + ": the direction of axis " + axis_names[a] + " is not a unit vector");
  }
  if (const std::string shear = shear_text(unit_axes); !shear.empty()) {
    throw FormatError(name + ": its " + shear + ", but must be perpendicular; resample the image to a grid without " +
                      "shear, for example with SimpleITK.Resample or nibabel.processing.resample_to_output");
  }
  Mat3 direction;
  std::copy(unit_axes.begin(), unit_axes.end(), direction.columns);
  grid.direction = nearest_orthonormal(direction);
  grid.spacing = steps;
}

void set_frame(GridSpec& grid, const std::array<std::optional<Vec3d>, 3>& steps, const std::string& name) {
  std::array<std::optional<Vec3d>, 3> axes;
  Vec3d lengths{1, 1, 1};
  for (std::size_t a = 0; a < 3; ++a) {
    if (!steps[a]) continue;
    if (!is_finite(*steps[a]) || !(largest_component(*steps[a]) > 0)) {
      throw FormatError(name + ": the step along axis " + axis_names[a] + " is zero or not finite");
    }
    lengths[a] = safe_length(*steps[a]);
    axes[a] = unit(*steps[a]);
  }
  for (std::size_t a = 0; a < 3; ++a) {
    if (!axes[a]) axes[a] = perpendicular(axes, a);
  }
  set_frame(grid, {*axes[0], *axes[1], *axes[2]}, lengths, name);
}

void check_count(const std::array<std::int64_t, 3>& size, std::uint64_t limit, const std::string& name) {
  std::uint64_t count = 1;
  for (const std::int64_t n : size) {
    if (n < 1)
      throw FormatError(name + ": a size in the header is " + std::to_string(n) + ", but it must be at least 1");
    if (static_cast<std::uint64_t>(n) > limit / count) {
      throw FormatError(name + ": it has more than " + std::to_string(limit) + " values, which is the limit");
    }
    count *= static_cast<std::uint64_t>(n);
  }
}

}  // namespace blum::volume_io
