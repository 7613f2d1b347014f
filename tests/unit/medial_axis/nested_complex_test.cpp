// Proves that the complex of all angles contains the axis that simplify() returns at each angle. Triangles and lines
// are at the same places and have the same components.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <map>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "blum/certificate/certificate.hpp"
#include "blum/core/union_find.hpp"
#include "blum/grid/image_generators.hpp"
#include "blum/medial_axis/medial_axis.hpp"
#include "blum/shapes/shape_catalog.hpp"
#include "support/medial_rows.hpp"

namespace blum {
namespace {

using test::AxisRows;
using test::EdgeRow;
using test::TriangleRow;
using test::VertexRow;

using Place = std::array<double, 3>;
using Line = std::array<Place, 2>;

Place place_of(const VertexRow& v) {
  return {v.position.x, v.position.y, v.position.z};
}

Line line_between(const Place& a, const Place& b) {
  return {std::min(a, b), std::max(a, b)};
}

/// A complex as a set of places. Degenerate cells count only through their sides and corners.
struct Places {
  std::set<std::array<Place, 3>> triangles;  ///< corners in ascending order
  std::set<Line> curves;                     ///< outside all triangles
  std::map<Line, int> sides;                 ///< with the number of their triangles
  std::set<Place> vertices;

  void add_triangle(std::array<Place, 3> corners) {
    std::sort(corners.begin(), corners.end());
    if (corners[0] == corners[1] || corners[1] == corners[2]) {
      add_curve(corners[0], corners[2]);
      return;
    }
    triangles.insert(corners);
    for (const auto& [a, b] : {std::pair(0U, 1U), std::pair(1U, 2U), std::pair(0U, 2U)}) {
      ++sides[{corners[a], corners[b]}];
    }
  }
  void add_curve(const Place& a, const Place& b) {
    if (a != b) curves.insert(line_between(a, b));
  }
  void finish() {
    std::erase_if(curves, [&](const Line& line) { return sides.contains(line); });
  }
  [[nodiscard]] std::set<Line> lines_with(int least, int most) const {
    std::set<Line> out;
    for (const auto& [line, count] : sides) {
      if (count >= least && count <= most) out.insert(line);
    }
    return out;
  }
};

Places places_of(const AxisRows& complex) {
  Places out;
  const auto at = [&](std::uint32_t v) { return place_of(complex.vertices[v]); };
  for (const VertexRow& v : complex.vertices) out.vertices.insert(place_of(v));
  for (const TriangleRow& t : complex.triangles) {
    out.add_triangle({at(t.vertices[0]), at(t.vertices[1]), at(t.vertices[2])});
  }
  for (const EdgeRow& e : complex.edges) out.add_curve(at(e.vertices[0]), at(e.vertices[1]));
  out.finish();
  return out;
}

std::set<Line> lines_at(const AxisRows& nested, MedialRole role, double theta) {
  std::set<Line> out;
  for (const EdgeRow& e : nested.edges) {
    if (e.role != role || !(e.from <= theta && theta < e.until)) continue;
    const bool is_new =
        out.insert(line_between(place_of(nested.vertices[e.vertices[0]]), place_of(nested.vertices[e.vertices[1]])))
            .second;
    EXPECT_TRUE(is_new) << "an edge has one role at a time";
  }
  return out;
}

void expect_same(const AxisRows& nested, const AxisRows& complex, double theta) {
  SCOPED_TRACE("theta " + std::to_string(theta));
  const Places expected = places_of(complex);
  Places found;
  for (std::size_t v = 0; v < nested.vertices.size(); ++v) {
    if (!(nested.vertices[v].until > theta)) continue;
    EXPECT_TRUE(found.vertices.insert(place_of(nested.vertices[v])).second);
  }
  for (const TriangleRow& t : nested.triangles) {
    if (!(t.until > theta)) continue;
    found.add_triangle({place_of(nested.vertices[t.vertices[0]]), place_of(nested.vertices[t.vertices[1]]),
                        place_of(nested.vertices[t.vertices[2]])});
  }
  EXPECT_EQ(found.vertices, expected.vertices);
  EXPECT_EQ(found.triangles, expected.triangles);
  EXPECT_EQ(lines_at(nested, MedialRole::curve, theta), expected.curves);
  EXPECT_EQ(lines_at(nested, MedialRole::rim, theta), found.lines_with(1, 1));
  EXPECT_EQ(lines_at(nested, MedialRole::seam, theta), found.lines_with(3, 1000000));
}

/// Components of the cells that exist at an angle.
std::size_t components_at(const AxisRows& nested, double theta) {
  detail::UnionFind joined(nested.vertices.size());
  for (const EdgeRow& e : nested.edges) {
    if (e.from <= theta && theta < e.until) joined.join(e.vertices[0], e.vertices[1]);
  }
  for (const TriangleRow& t : nested.triangles) {
    if (!(t.until > theta)) continue;
    joined.join(t.vertices[0], t.vertices[1]);
    joined.join(t.vertices[0], t.vertices[2]);
  }
  std::size_t count = 0;
  for (std::uint32_t v = 0; v < nested.vertices.size(); ++v) {
    if (nested.vertices[v].until > theta && joined.find(v) == v) ++count;
  }
  return count;
}

TEST(NestedComplex, EqualsSimplifyAtEveryAngle) {
  for (const std::string name : {"bracket", "plate", "box", "void_cube", "torus", "gear", "sphere", "torus_knot"}) {
    SCOPED_TRACE(name);
    for (const double least : {0.0, 40.0}) {
      MedialAxisOptions options;
      options.resolution = 40;
      options.least_theta = least;
      const MedialAxis axis = medial_axis(make_shape(name), options);
      const AxisRows nested = axis.nested();
      EXPECT_EQ(axis.least_theta(), least);
      for (const double theta : {0.0, 9.5, 20.0, 40.0, 60.0, 119.0, 170.0, 180.0}) {
        if (theta >= least) expect_same(nested, axis.simplify(theta), theta);
      }
      // At the angle at which a cell vanishes, it is missing in both.
      for (std::size_t t = 0; t < nested.triangles.size(); t += 1 + nested.triangles.size() / 3) {
        const double until = nested.triangles[t].until;
        if (until <= 180) expect_same(nested, axis.simplify(until), until);
      }
    }
  }
}

TEST(NestedComplex, HasOneComponentPerSeparatePart) {
  const VoxelImage image = make_image("balls_image", {{"count", 3}});
  const MedialAxis axis = medial_axis(image);
  const AxisRows nested = axis.nested();
  for (const double theta : {0.0, 60.0, 180.0}) {
    expect_same(nested, axis.simplify(theta), theta);
    EXPECT_EQ(components_at(nested, theta), static_cast<std::size_t>(axis.report().betti[0])) << theta;
  }
}

TEST(NestedComplex, SheetsAreCountedAtTheLeastAngle) {
  MedialAxisOptions options;
  options.resolution = 48;
  const MedialAxis axis = medial_axis(make_shape("box"), options);
  EXPECT_EQ(sheet_count(axis.nested()), sheet_count(axis.simplify(0)));
}

}  // namespace
}  // namespace blum
