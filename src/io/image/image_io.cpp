#include "blum/io/image_io.hpp"

#include <algorithm>
#include <cmath>
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

bool is_perpendicular(const std::array<Vec3d, 3>& axes) {
  for (const Vec3d& axis : axes) {
    if (!is_finite(axis) || !(largest_component(axis) > 0)) return false;
  }
  for (std::size_t a = 0; a < 3; ++a) {
    if (!(std::abs(dot(unit(axes[a]), unit(axes[(a + 1) % 3]))) <= frame_tolerance)) return false;
  }
  return true;
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
  if (!is_perpendicular(unit_axes)) {
    throw FormatError(name +
                      ": the axes are not perpendicular to each other; resample the image to a grid without shear");
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
