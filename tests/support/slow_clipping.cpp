#include "support/slow_clipping.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <utility>

#include "blum/core/union_find.hpp"
#include "blum/geometry/orient2d.hpp"

namespace blum::test {
namespace {

using Point2 = std::array<double, 2>;

/// A loop or shell that encloses less than this part of the square or cube of its size may be inverted by rounding.
constexpr double least_part = 1e-13;

/// One connected part of a face.
struct Region {
  const VertexLoop* outline = nullptr;
  std::vector<const VertexLoop*> holes;
};

/// The face that closes a cut, seen from outside.
class Cap {
 public:
  Cap(const std::vector<Vec3d>& vertices, std::size_t axis, bool faces_up)
      : vertices_(vertices), first_((axis + (faces_up ? 1U : 2U)) % 3), second_((axis + (faces_up ? 2U : 1U)) % 3) {}

  /// @return  nullopt if rounding makes the nesting of the loops ambiguous.
  [[nodiscard]] std::optional<std::vector<Region>> regions(const std::vector<VertexLoop>& loops) const {
    std::vector<Region> out;
    for (const VertexLoop& loop : loops) {
      if (!(std::abs(area(loop)) > least_part * squared_size(loop))) return std::nullopt;
      if (area(loop) > 0) out.push_back({&loop, {}});
    }
    for (const VertexLoop& loop : loops) {
      if (area(loop) > 0) continue;
      Region* around = nullptr;
      for (Region& region : out) {
        if (!holds(*region.outline, loop.front())) continue;
        if (around == nullptr || area(*region.outline) < area(*around->outline)) around = &region;
      }
      if (around == nullptr) return std::nullopt;
      around->holes.push_back(&loop);
    }
    return out;
  }

 private:
  [[nodiscard]] Point2 at(std::uint32_t vertex) const {
    return {vertices_[vertex][first_], vertices_[vertex][second_]};
  }
  [[nodiscard]] double area(const VertexLoop& loop) const {
    double sum = 0;
    const Point2 o = at(loop.front());
    for (std::size_t k = 0; k < loop.size(); ++k) {
      const Point2 p = at(loop[k]);
      const Point2 q = at(loop[(k + 1) % loop.size()]);
      sum += (p[0] - o[0]) * (q[1] - o[1]) - (p[1] - o[1]) * (q[0] - o[0]);
    }
    return sum / 2;
  }
  [[nodiscard]] double squared_size(const VertexLoop& loop) const {
    double size = 0;
    for (const std::uint32_t v : loop) size = std::max(size, squared_length(vertices_[v] - vertices_[loop.front()]));
    return size;
  }
  [[nodiscard]] bool holds(const VertexLoop& loop, std::uint32_t vertex) const {
    bool is_in = false;
    const Point2 p = at(vertex);
    for (std::size_t k = 0; k < loop.size(); ++k) {
      const Point2 a = at(loop[k]);
      const Point2 b = at(loop[(k + 1) % loop.size()]);
      if ((a[1] > p[1]) == (b[1] > p[1])) continue;
      if ((detail::orient2d(a, b, p) > 0) == (b[1] > a[1])) is_in = !is_in;
    }
    return is_in;
  }

  const std::vector<Vec3d>& vertices_;
  std::size_t first_;
  std::size_t second_;
};

/// Cuts the faces of a solid by a plane.
class Cutter {
 public:
  Cutter(const SolidPart& part, std::size_t axis, double plane, bool keep_above)
      : axis_(axis), plane_(plane), keep_above_(keep_above) {
    out_.is_sure = part.is_sure;
    out_.vertices = part.vertices;
    for (const FlatFace& face : part.faces) cut(face);
    close();
  }
  SolidPart take() { return std::move(out_); }

 private:
  /// A point at which a loop passes the plane; `at` is its place along the cut.
  struct Pass {
    double at = 0;
    std::uint32_t vertex = 0;
    bool leaves = false;  ///< true if the loop leaves the kept part
    [[nodiscard]] bool operator<(const Pass& other) const { return at < other.at; }
  };

  [[nodiscard]] bool is_kept(std::uint32_t v) const { return (out_.vertices[v][axis_] >= plane_) == keep_above_; }

  std::uint32_t vertex_between(std::uint32_t one, std::uint32_t other) {
    const std::pair<std::uint32_t, std::uint32_t> key = std::minmax(one, other);
    const auto [at, is_new] = vertex_of_edge_.try_emplace(key, static_cast<std::uint32_t>(out_.vertices.size()));
    if (is_new) {
      const Vec3d a = out_.vertices[key.first];
      const Vec3d b = out_.vertices[key.second];
      Vec3d p = a + (b - a) * ((plane_ - a[axis_]) / (b[axis_] - a[axis_]));
      p[axis_] = plane_;
      out_.vertices.push_back(p);
    }
    return at->second;
  }

  void cut(const FlatFace& face) {
    FlatFace kept{face.axis, {}};
    std::vector<Pass> passes;
    std::map<std::uint32_t, VertexLoop> chains;  // keys: first vertices
    for (const VertexLoop& loop : face.loops) {
      const auto outside = std::find_if(loop.begin(), loop.end(), [&](std::uint32_t v) { return !is_kept(v); });
      if (outside == loop.end()) {
        kept.loops.push_back(loop);
        continue;
      }
      const auto first = static_cast<std::size_t>(outside - loop.begin());
      VertexLoop chain;
      for (std::size_t k = 0; k < loop.size(); ++k) {
        const std::uint32_t a = loop[(first + k) % loop.size()];
        const std::uint32_t b = loop[(first + k + 1) % loop.size()];
        if (is_kept(a)) chain.push_back(a);
        if (is_kept(a) == is_kept(b)) continue;
        const std::uint32_t v = vertex_between(a, b);
        chain.push_back(v);
        // Parts of triangles are convex: the order of both passes along the cut does not matter.
        passes.push_back({face.axis < 3 ? out_.vertices[v][3 - axis_ - face.axis] : 0, v, is_kept(a)});
        if (is_kept(a)) {
          const std::uint32_t begin = chain.front();
          chains[begin] = std::move(chain);
          chain = {};
        }
      }
    }
    join(passes, chains, kept);
    if (!kept.loops.empty()) out_.faces.push_back(std::move(kept));
  }

  /// Joins passes in pairs along the cut. The cut lies in the face between the two passes of a pair.
  void join(std::vector<Pass>& passes, std::map<std::uint32_t, VertexLoop>& chains, FlatFace& kept) {
    std::sort(passes.begin(), passes.end());
    std::map<std::uint32_t, std::uint32_t> link;
    for (std::size_t k = 0; k + 1 < passes.size(); k += 2) {
      const bool is_first = passes[k].leaves;
      if (is_first == passes[k + 1].leaves) out_.is_sure = false;
      const std::uint32_t from = passes[is_first ? k : k + 1].vertex;
      const std::uint32_t to = passes[is_first ? k + 1 : k].vertex;
      link[from] = to;
      around_cap_[to] = from;
    }
    while (!chains.empty()) {
      VertexLoop& loop = kept.loops.emplace_back();
      for (auto at = chains.begin(); at != chains.end(); at = chains.find(link[loop.back()])) {
        loop.insert(loop.end(), at->second.begin(), at->second.end());
        chains.erase(at);
      }
    }
  }

  void close() {
    FlatFace cap{axis_, {}};
    while (!around_cap_.empty()) {
      VertexLoop& loop = cap.loops.emplace_back();
      for (auto at = around_cap_.begin(); at != around_cap_.end();) {
        loop.push_back(at->first);
        const std::uint32_t next = at->second;
        around_cap_.erase(at);
        at = around_cap_.find(next);
      }
    }
    if (!cap.loops.empty()) out_.faces.push_back(std::move(cap));
  }

  std::size_t axis_;
  double plane_;
  bool keep_above_;
  SolidPart out_;
  std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> vertex_of_edge_;
  std::map<std::uint32_t, std::uint32_t> around_cap_;
};

/// Removes vertices that belong to no face.
void compact(SolidPart& part) {
  constexpr std::uint32_t nothing = 0xffffffffU;
  std::vector<std::uint32_t> place(part.vertices.size(), nothing);
  std::vector<Vec3d> kept;
  for (FlatFace& face : part.faces) {
    for (VertexLoop& loop : face.loops) {
      for (std::uint32_t& v : loop) {
        if (place[v] == nothing) {
          place[v] = static_cast<std::uint32_t>(kept.size());
          kept.push_back(part.vertices[v]);
        }
        v = place[v];
      }
    }
  }
  part.vertices = std::move(kept);
}

/// Six times the volume between a loop and a point.
double volume(const std::vector<Vec3d>& vertices, const VertexLoop& loop, const Vec3d& o) {
  double sum = 0;
  for (std::size_t k = 2; k < loop.size(); ++k) {
    sum += dot(vertices[loop[0]] - o, cross(vertices[loop[k - 1]] - o, vertices[loop[k]] - o));
  }
  return sum;
}

}  // namespace

SolidPart whole_solid(const TriangleMesh& mesh) {
  SolidPart out;
  out.vertices = mesh.vertices;
  for (const auto& [a, b, c] : mesh.triangles) out.faces.push_back({3, {{a, b, c}}});
  return out;
}

SolidPart cut_by_plane(const SolidPart& part, std::size_t axis, double plane, bool keep_above) {
  SolidPart out = Cutter(part, axis, plane, keep_above).take();
  compact(out);
  return out;
}

bool PartShape::passes() const {
  bool out = voids == 0;
  for (const int euler : shells) out = out && euler == 2;
  for (const auto& side : sides) {
    for (const int euler : side) out = out && euler == 1;
  }
  return out;
}

PartShape shape_of(const SolidPart& part, const Vec3d& high) {
  PartShape out;
  out.is_sure = part.is_sure;
  const auto& vertices = part.vertices;
  detail::UnionFind joined(vertices.size());
  const auto join = [&](const VertexLoop& loop) {
    for (const std::uint32_t v : loop) joined.join(loop.front(), v);
  };
  std::map<std::uint32_t, int> twice_euler;  // of each shell; keys: any of its vertices
  for (std::uint32_t v = 0; v < vertices.size(); ++v) twice_euler[v] = 2;
  for (const FlatFace& face : part.faces) {
    for (const VertexLoop& loop : face.loops) {
      join(loop);
      twice_euler[loop.front()] += (face.axis == 3 ? 2 : 0) - static_cast<int>(loop.size());
    }
    if (face.axis == 3) continue;
    const bool is_above = vertices[face.loops[0][0]][face.axis] == high[face.axis];
    const auto regions = Cap(vertices, face.axis, is_above).regions(face.loops);
    if (!regions) {
      out.is_sure = false;
      return out;
    }
    for (const Region& region : *regions) {
      const int euler = 1 - static_cast<int>(region.holes.size());
      twice_euler[region.outline->front()] += 2 * euler;
      out.sides[2 * face.axis + (is_above ? 1 : 0)].push_back(euler);
      for (const VertexLoop* hole : region.holes) joined.join(region.outline->front(), hole->front());
    }
  }
  std::map<std::uint32_t, std::pair<int, double>> shells;  // twice the Euler number, and size
  for (const auto& [v, twice] : twice_euler) {
    auto& [sum, size] = shells[joined.find(v)];
    sum += twice;
    size = std::max(size, length(vertices[v] - vertices[joined.find(v)]));
  }
  for (const auto& [first, shell] : shells) {
    double sum = 0;
    for (const FlatFace& face : part.faces) {
      for (const VertexLoop& loop : face.loops) {
        if (joined.find(loop.front()) == first) sum += volume(vertices, loop, vertices[first]);
      }
    }
    const auto& [twice, size] = shell;
    out.is_sure = out.is_sure && std::abs(sum) > least_part * size * size * size;
    out.shells.push_back(twice / 2);
    ++(sum > 0 ? out.components : out.voids);
  }
  return out;
}

void for_each_cube(const TriangleMesh& mesh, const detail::GridPlanes& planes,
                   const std::function<void(const detail::Place&, const PartShape&)>& visit) {
  const auto between = [&](const SolidPart& part, std::size_t axis, std::int32_t at) {
    return cut_by_plane(cut_by_plane(part, axis, planes.at(axis, at), true), axis, planes.at(axis, at + 1), false);
  };
  const SolidPart whole = whole_solid(mesh);
  for (std::int32_t i = 0; i + 1 < planes.count(0); ++i) {
    const SolidPart slab = between(whole, 0, i);
    for (std::int32_t j = 0; j + 1 < planes.count(1); ++j) {
      const SolidPart rod = between(slab, 1, j);
      for (std::int32_t k = 0; k + 1 < planes.count(2); ++k) {
        const detail::Place place{i, j, k};
        visit(place, shape_of(between(rod, 2, k), planes.node({i + 1, j + 1, k + 1})));
      }
    }
  }
}

}  // namespace blum::test
