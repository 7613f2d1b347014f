#include "blum/grid/grid_spec.hpp"

#include <algorithm>
#include <cmath>
#include <string>

#include "blum/core/error.hpp"
#include "blum/core/exact_text.hpp"

namespace blum {
namespace {

constexpr std::int64_t max_nodes = std::int64_t{1} << 40;
/// If a side is a whole number of spacings up to this relative tolerance, it gets no additional layer.
constexpr double whole_steps_tolerance = 1e-9;

void check_box(const Box3& box) {
  if (box.is_empty()) throw InvalidGrid("the bounds are empty, so there is no box for a grid");
  if (!is_finite(box.lower) || !is_finite(box.upper)) throw InvalidGrid("the bounds are not finite");
}

double longest_side(const Box3& box) {
  const Vec3d side = box.size();
  return std::max({side.x, side.y, side.z});
}

/// Returns why a direction matrix is invalid. `product` is the scalar product of its columns a and b.
std::string direction_problem(std::size_t a, std::size_t b, double product) {
  const std::string text = "the direction matrix is not orthonormal: ";
  if (a == b) {
    return text + "the length of column " + std::to_string(a) + " is " + rounded_text(std::sqrt(product)) +
           ", but must be 1; lengths of steps belong in the spacing";
  }
  return text + "columns " + std::to_string(a) + " and " + std::to_string(b) + " have the scalar product " +
         rounded_text(product) + ", but must be perpendicular; resample an image with shear to a grid without it";
}

void check_resolution(int resolution) {
  if (resolution < 2 || resolution > 65536) {
    throw InvalidOption("resolution is " + std::to_string(resolution) + ", but must be 2 to 65536 nodes");
  }
}

Box3 padded(const Box3& box, double padding) {
  if (!(padding >= 0 && padding <= 1e6)) {
    throw InvalidOption("padding is " + exact_text(padding) +
                        ", but must be 0 to 1e6 (a fraction of the longest side)");
  }
  const double pad = padding * longest_side(box);
  return {box.lower - Vec3d{pad, pad, pad}, box.upper + Vec3d{pad, pad, pad}};
}

/// Returns the smallest grid with this spacing that covers the box. The grid is centred on the box.
GridSpec cover(const Box3& box, double spacing) {
  if (!(spacing > 0) || !std::isfinite(spacing)) throw InvalidGrid("the grid's spacing must be positive and finite");
  GridSpec grid;
  grid.spacing = {spacing, spacing, spacing};
  const Vec3d side = box.size();
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const double steps = side[axis] / spacing;
    if (!(steps < static_cast<double>(max_nodes)))
      throw InvalidGrid("the spacing is too small for the box: the grid would have more than 2^40 nodes");
    grid.size[axis] = static_cast<std::int64_t>(std::ceil(steps - whole_steps_tolerance * std::max(1.0, steps))) + 1;
    grid.origin[axis] = box.center()[axis] - 0.5 * spacing * static_cast<double>(grid.size[axis] - 1);
  }
  validate(grid);
  return grid;
}

GridSpec cover_with_resolution(const Box3& box, int resolution) {
  check_resolution(resolution);
  const double longest = longest_side(box);
  if (!(longest > 0)) {
    throw InvalidGrid("the shape is a single point, which gives a grid no size: pass bounds, or a spacing");
  }
  GridSpec grid = cover(box, longest / (resolution - 1));
  return grid;
}

}  // namespace

void validate(const GridSpec& grid) {
  double nodes = 1;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    if (grid.size[axis] < 1) throw InvalidGrid("a grid needs at least one node along each axis");
    if (!(grid.spacing[axis] > 0) || !std::isfinite(grid.spacing[axis])) {
      throw InvalidGrid("the grid's spacing must be positive and finite");
    }
    nodes *= static_cast<double>(grid.size[axis]);
  }
  if (nodes > static_cast<double>(max_nodes)) throw InvalidGrid("the grid has more than 2^40 nodes");
  if (!is_finite(grid.origin)) throw InvalidGrid("the grid's origin is not finite");
  for (std::size_t a = 0; a < 3; ++a) {
    for (std::size_t b = 0; b < 3; ++b) {
      const double product = dot(grid.direction.columns[a], grid.direction.columns[b]);
      if (!(std::abs(product - (a == b ? 1.0 : 0.0)) <= 1e-6)) throw InvalidGrid(direction_problem(a, b, product));
    }
  }
}

Box3 bounds(const GridSpec& grid) {
  Box3 box;
  for (int corner = 0; corner < 8; ++corner) {
    box.extend(grid.position((corner & 1) != 0 ? grid.size[0] - 1 : 0, (corner & 2) != 0 ? grid.size[1] - 1 : 0,
                             (corner & 4) != 0 ? grid.size[2] - 1 : 0));
  }
  return box;
}

GridSpec grid_around(const Box3& shape_bounds, int resolution, double padding) {
  check_box(shape_bounds);
  return cover_with_resolution(padded(shape_bounds, padding), resolution);
}

GridSpec grid_around_with_spacing(const Box3& shape_bounds, double spacing, double padding) {
  check_box(shape_bounds);
  return cover(padded(shape_bounds, padding), spacing);
}

GridSpec grid_in(const Box3& box, int resolution) {
  check_box(box);
  return cover_with_resolution(box, resolution);
}

GridSpec grid_in_with_spacing(const Box3& box, double spacing) {
  check_box(box);
  return cover(box, spacing);
}

}  // namespace blum
