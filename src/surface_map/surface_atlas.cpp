#include "blum/surface_map/surface_atlas.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <string>
#include <tuple>
#include <vector>

#include "blum/core/exact_text.hpp"
#include "blum/core/parallel.hpp"
#include "surface_map/chart.hpp"

namespace blum {
namespace {

using surface::for_each_texel;

constexpr std::uint32_t most_a_side = 16384;
/// Texels: distance of a chart's border from the outermost middles of its texels. So rounding of texture coordinates
/// does not select other texels.
constexpr double inset = 1.0 / 64;
/// Number of texels by which the sides of a rectangle exceed the legs of its charts. Two charts share a rectangle.
constexpr std::uint32_t gutter = 3;

/// Returns the width of an additional border around a chart, texels; it is 0 for small charts. Programs that draw a
/// texture at a smaller size read beyond the texels of a chart.
double room_around(double shorter_leg) {
  return std::min(std::floor(shorter_leg / 16), 8.0);
}

/// The two legs of a triangle of the mesh: its sides except the longest one. Its chart is a right triangle with these
/// legs.
struct Legs {
  std::size_t corner = 0;  ///< opposite to the longest side
  /// Mesh units: lengths of the sides from `corner` to the next corner and to the one after that.
  std::array<double, 2> length{};
};

std::vector<Legs> legs_of(const MeshView& mesh) {
  std::vector<Legs> out(mesh.triangles.size());
  for (std::size_t t = 0; t < out.size(); ++t) {
    const std::array<Vec3d, 3> p = triangle_corners(mesh, t);
    std::array<double, 3> side{};  // opposite to corner k
    for (std::size_t k = 0; k < 3; ++k) side[k] = length(p[(k + 2) % 3] - p[(k + 1) % 3]);
    const auto corner = static_cast<std::size_t>(std::max_element(side.begin(), side.end()) - side.begin());
    out[t] = {corner, {side[(corner + 2) % 3], side[(corner + 1) % 3]}};
  }
  return out;
}

/// Returns the number of texels along a leg, rounded up, at least 1.
double texels_along(double length, double texel) {
  return std::max(std::ceil(length / texel + 2 * inset), 1.0);
}

/// Returns the approximate number of texels of the whole texture.
double texel_count(const std::vector<Legs>& legs, double texel) {
  double sum = 0;
  for (const Legs& one : legs) {
    const double first = texels_along(one.length[0], texel);
    const double second = texels_along(one.length[1], texel);
    const double room = gutter + 2 * room_around(std::min(first, second));
    sum += (first + room) * (second + room) / 2;
  }
  return sum;
}

/// A rectangle of the texture with the charts of one or two triangles.
struct Rectangle {
  std::array<std::uint32_t, 2> triangles{};
  std::size_t count = 1;
  std::uint32_t x = 0, y = 0;
  std::uint32_t along = 0, across = 0;  ///< lengths of the legs, texels
  bool is_turned = false;               ///< true if the first leg is the shorter one, which is vertical

  [[nodiscard]] std::uint32_t room() const { return static_cast<std::uint32_t>(room_around(across)); }
  [[nodiscard]] std::uint32_t width() const { return along + gutter + 2 * room(); }
  [[nodiscard]] std::uint32_t height() const { return across + gutter + 2 * room(); }
};

/// Returns the rectangles of all charts, the highest first, then the widest. Two charts of equal height share a
/// rectangle.
std::vector<Rectangle> rectangles_of(const std::vector<Legs>& legs, double texel) {
  std::vector<Rectangle> all(legs.size());
  for (std::uint32_t t = 0; t < legs.size(); ++t) {
    const auto first = static_cast<std::uint32_t>(texels_along(legs[t].length[0], texel));
    const auto second = static_cast<std::uint32_t>(texels_along(legs[t].length[1], texel));
    all[t] = {{t, t}, 1, 0, 0, std::max(first, second), std::min(first, second), first < second};
  }
  const auto rank = [](const Rectangle& r) { return std::tuple(~r.across, r.is_turned, ~r.along, r.triangles[0]); };
  std::sort(all.begin(), all.end(), [&](const Rectangle& a, const Rectangle& b) { return rank(a) < rank(b); });
  std::vector<Rectangle> out;
  out.reserve(all.size() / 2 + 1);
  for (const Rectangle& next : all) {
    const bool is_second = !out.empty() && out.back().count == 1 && out.back().across == next.across &&
                           out.back().is_turned == next.is_turned;
    if (is_second) {
      out.back().triangles[1] = next.triangles[0];
      out.back().count = 2;
    } else {
      out.push_back(next);
    }
  }
  return out;
}

/// Sets the positions of rectangles, in rows.
/// @return  width and height of the texture.
std::array<std::uint64_t, 2> place(std::vector<Rectangle>& rectangles) {
  double area = 0;
  std::uint64_t width = 1;
  for (const Rectangle& r : rectangles) {
    area += static_cast<double>(r.width()) * r.height();
    width = std::max<std::uint64_t>(width, r.width());
  }
  width = std::max(width, static_cast<std::uint64_t>(std::ceil(std::sqrt(area))));
  std::uint64_t x = 0;
  std::uint64_t y = 0;
  std::uint64_t row = 0;
  for (Rectangle& r : rectangles) {
    if (x + r.width() > width) {
      x = 0;
      y += row;
      row = 0;
    }
    r.x = static_cast<std::uint32_t>(x);
    r.y = static_cast<std::uint32_t>(y);
    x += r.width();
    row = std::max<std::uint64_t>(row, r.height());
  }
  return {width, std::max<std::uint64_t>(y + row, 1)};
}

/// Returns the chart of triangle `which` of a rectangle. The second chart is the first one, turned by half a turn.
std::array<TexturePlace, 3> chart_in(const Rectangle& r, std::size_t which, std::size_t corner) {
  const double along = r.along - 2 * inset;
  const double across = r.across - 2 * inset;
  std::array<TexturePlace, 3> out;
  out[corner] = {r.is_turned ? along : 0, 0};
  out[(corner + 1) % 3] = r.is_turned ? TexturePlace{along, across} : TexturePlace{along, 0};
  out[(corner + 2) % 3] = r.is_turned ? TexturePlace{0, 0} : TexturePlace{0, across};
  // The right angle of the first chart is at a corner of the rectangle, so that the long sides of both charts face each
  // other.
  const double left = r.room() + (r.is_turned ? gutter - 1 : 0);
  for (TexturePlace& at : out) {
    at = {at.x + left + 0.5 + inset, at.y + r.room() + 0.5 + inset};
    if (which == 1) at = {r.width() - at.x, r.height() - at.y};
    at = {at.x + r.x, at.y + r.y};
  }
  return out;
}

[[noreturn]] void throw_too_large(double texel, const std::vector<Legs>& legs) {
  double longest = 0;
  for (const Legs& one : legs) longest = std::max({longest, one.length[0], one.length[1]});
  double fits = std::max(texel, longest / (most_a_side - 32));
  for (int step = 0; step < 200 && texel_count(legs, fits) > 0.98 * most_a_side * most_a_side; ++step) fits *= 1.1;
  throw InvalidOption("texels with a side of " + exact_text(texel) + " make a texture of more than " +
                      std::to_string(most_a_side) + " x " + std::to_string(most_a_side) +
                      " texels: use texels with a side of about " + exact_text(fits) + " or more");
}

void check(const MeshView& mesh) {
  validate(mesh);
  if (mesh.triangles.empty()) throw InvalidMesh("the mesh has no triangles, so there is no surface for a texture");
}

SurfaceAtlas packed(const MeshView& mesh, const std::vector<Legs>& legs, double texel, const Context& context) {
  double longest = 0;
  for (const Legs& one : legs) longest = std::max({longest, one.length[0], one.length[1]});
  const double most = most_a_side;
  if (longest / texel > most || texel_count(legs, texel) > most * most) throw_too_large(texel, legs);
  std::vector<Rectangle> rectangles = rectangles_of(legs, texel);
  const auto [width, height] = place(rectangles);
  if (width > most_a_side || height > most_a_side) throw_too_large(texel, legs);
  SurfaceAtlas out;
  out.width = static_cast<std::uint32_t>(width);
  out.height = static_cast<std::uint32_t>(height);
  out.corners.resize(mesh.triangles.size());
  out.triangle = Buffer<TriangleId>(width * height, TriangleId::none());
  parallel_for(context, rectangles.size(), 256, "", [&](const WorkRange& range) {
    for (std::size_t k = range.begin; k < range.end; ++k) {
      const Rectangle& r = rectangles[k];
      for (std::size_t which = 0; which < r.count; ++which) {
        const std::uint32_t t = r.triangles[which];
        out.corners[t] = chart_in(r, which, legs[t].corner);
        for_each_texel(out.corners[t], out.width, out.height, [&](std::size_t x, std::size_t y, double /*outside*/) {
          TriangleId& owner = out.triangle[y * out.width + x];
          if (!owner.has_value()) owner = TriangleId(t);
        });
      }
    }
  });
  return out;
}

}  // namespace

std::array<std::array<float, 2>, 3> SurfaceAtlas::texture_coordinates(TriangleId of) const {
  std::array<std::array<float, 2>, 3> out{};
  for (std::size_t k = 0; k < 3; ++k) {
    const TexturePlace& at = corners[of.value][k];
    out[k] = {static_cast<float>(at.x / width), static_cast<float>(at.y / height)};
  }
  return out;
}

SurfaceAtlas surface_atlas(const MeshView& mesh, double texel, const Context& context) {
  check(mesh);
  if (!(texel > 0 && std::isfinite(texel))) {
    throw InvalidOption("texel is " + exact_text(texel) + ", but must be above 0");
  }
  return packed(mesh, legs_of(mesh), texel, context);
}

SurfaceAtlas surface_atlas_of_size(const MeshView& mesh, std::size_t texels, const Context& context) {
  check(mesh);
  const std::vector<Legs> legs = legs_of(mesh);
  double high = 0;
  for (const Legs& one : legs) high = std::max({high, one.length[0], one.length[1]});
  high = high > 0 ? 2 * high : 1;
  double low = high;
  const double wanted = std::min(static_cast<double>(texels), 0.9 * most_a_side * most_a_side);
  const double smallest = high / most_a_side;
  while (low > smallest && texel_count(legs, low) < wanted) low /= 2;
  for (int step = 0; step < 20; ++step) {
    const double middle = std::sqrt(low) * std::sqrt(high);
    (texel_count(legs, middle) < wanted ? high : low) = middle;
  }
  return packed(mesh, legs, high, context);
}

SurfaceAtlas surface_atlas_from(const MeshView& mesh, std::span<const TexturePlace> coordinates,
                                std::span<const Triangle> corners, std::uint32_t width, std::uint32_t height,
                                const Context& context) {
  check(mesh);
  if (width < 1 || height < 1 || width > most_a_side || height > most_a_side) {
    throw InvalidOption("a texture of " + std::to_string(width) + " x " + std::to_string(height) +
                        " texels is requested; it must have 1 to " + std::to_string(most_a_side) + " per side");
  }
  if (corners.size() != mesh.triangles.size()) {
    throw InvalidOption("there are texture coordinates for " + std::to_string(corners.size()) + " triangles of " +
                        std::to_string(mesh.triangles.size()));
  }
  SurfaceAtlas out;
  out.width = width;
  out.height = height;
  out.is_separate = false;
  out.corners.resize(corners.size());
  for (std::size_t t = 0; t < corners.size(); ++t) {
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t index = corners[t][k];
      const bool is_there = index < coordinates.size();
      const TexturePlace at = is_there ? coordinates[index] : TexturePlace{};
      if (!is_there || !(at.x >= 0 && at.y >= 0 && at.x <= width && at.y <= height)) {
        throw InvalidOption(
            "corner " + std::to_string(k) + " of triangle " + std::to_string(t) +
            (is_there ? " lies outside the texture" : " uses a texture coordinate that does not exist"));
      }
      out.corners[t][k] = at;
    }
  }
  const std::size_t count = static_cast<std::size_t>(width) * height;
  out.triangle = Buffer<TriangleId>(count, TriangleId::none());
  Buffer<float> best(count, HUGE_VALF);
  constexpr double surely_inside = -1e-6;
  for (std::uint32_t t = 0; t < corners.size(); ++t) {
    if (context.cancel.stop_requested()) throw Cancelled();
    if (!surface::has_area(out.corners[t])) continue;
    std::uint32_t twin = t;
    for_each_texel(out.corners[t], width, height, [&](std::size_t x, std::size_t y, double outside) {
      const std::size_t at = y * width + x;
      if (outside < surely_inside && best[at] < surely_inside) twin = out.triangle[at].value;
      if (!(outside < best[at])) return;
      best[at] = static_cast<float>(outside);
      out.triangle[at] = TriangleId(t);
    });
    if (twin != t) {
      throw InvalidOption("triangles " + std::to_string(twin) + " and " + std::to_string(t) +
                          " cover the same texel: maps need texture coordinates that do not overlap");
    }
  }
  return out;
}

}  // namespace blum
