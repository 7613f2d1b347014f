#include "certificate/shells.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>
#include <string>

#include "blum/core/error.hpp"
#include "blum/core/random.hpp"

namespace blum::verifier {
namespace {

/// Disjoint sets, identified by their smallest members.
class Sets {
 public:
  explicit Sets(std::size_t size) : parent_(size) { std::iota(parent_.begin(), parent_.end(), 0U); }
  std::uint32_t find(std::uint32_t a) {
    while (parent_[a] != a) a = parent_[a] = parent_[parent_[a]];
    return a;
  }
  void join(std::uint32_t a, std::uint32_t b) {
    a = find(a);
    b = find(b);
    parent_[std::max(a, b)] = std::min(a, b);
  }

 private:
  std::vector<std::uint32_t> parent_;
};

/// A side of a triangle.
struct Side {
  std::uint32_t low = 0, high = 0;
  std::uint32_t corner = 0;  ///< 3 * triangle + the corner where the side begins
  bool rises = false;        ///< true if it runs from the lower vertex to the higher one
};

bool names_a_vertex_twice(const Triangle& t) {
  return t[0] == t[1] || t[1] == t[2] || t[2] == t[0];
}

/// Returns the sides of all triangles, with the sides of each edge next to each other.
std::vector<Side> sorted_sides(const MeshView& mesh, const Context& context) {
  std::vector<std::size_t> begin(mesh.vertices.size() + 1, 0);
  const auto for_each_side = [&](const auto& use) {
    for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
      const Triangle& corners = mesh.triangles[t];
      if (names_a_vertex_twice(corners)) continue;
      for (std::uint32_t k = 0; k < 3; ++k) {
        const std::uint32_t a = corners[k];
        const std::uint32_t b = corners[(k + 1) % 3];
        use(Side{std::min(a, b), std::max(a, b), 3 * t + k, a < b});
      }
    }
  };
  for_each_side([&](const Side& side) { ++begin[side.low + 1]; });
  std::partial_sum(begin.begin(), begin.end(), begin.begin());
  std::vector<Side> sides(begin.back());
  std::vector<std::size_t> next(begin.begin(), begin.end() - 1);
  for_each_side([&](const Side& side) { sides[next[side.low]++] = side; });
  for (std::size_t v = 0; v + 1 < begin.size(); ++v) {
    if (v % 65536 == 0) throw_if_cancelled(context);
    std::sort(sides.begin() + static_cast<std::ptrdiff_t>(begin[v]),
              sides.begin() + static_cast<std::ptrdiff_t>(begin[v + 1]),
              [](const Side& a, const Side& b) { return a.high != b.high ? a.high < b.high : a.corner < b.corner; });
  }
  return sides;
}

std::string named(const Side& side) {
  return "the edge between vertices " + std::to_string(side.low) + " and " + std::to_string(side.high);
}

/// Calls use(side, side) for the two sides at each edge.
template <class Use>
void for_each_edge(const std::vector<Side>& sides, const Use& use) {
  for (std::size_t begin = 0; begin < sides.size();) {
    std::size_t end = begin + 1;
    while (end < sides.size() && sides[end].low == sides[begin].low && sides[end].high == sides[begin].high) ++end;
    if (end - begin != 2) {
      throw NoPolyhedron("the mesh is not closed and manifold: " + named(sides[begin]) + " has " +
                         std::to_string(end - begin) + " triangles instead of two");
    }
    use(sides[begin], sides[begin + 1]);
    begin = end;
  }
}

/// Returns the next corner of the same triangle, both as 3 * triangle + k.
std::uint32_t after(std::uint32_t corner) {
  return corner % 3 == 2 ? corner - 2 : corner + 1;
}

/// The neighbour of a triangle across one of its sides.
struct Neighbour {
  std::uint32_t triangle = 0;
  std::int8_t agrees = 0;  ///< 1 if both face the same way, otherwise -1
};

/// Returns the neighbour across each side; side k of triangle t has index 3 * t + k.
std::vector<Neighbour> neighbours(const MeshView& mesh, const std::vector<Side>& sides) {
  std::vector<Neighbour> beside(3 * mesh.triangles.size());
  for_each_edge(sides, [&](const Side& a, const Side& b) {
    const auto agrees = static_cast<std::int8_t>(a.rises != b.rises ? 1 : -1);
    beside[a.corner] = {b.corner / 3, agrees};
    beside[b.corner] = {a.corner / 3, agrees};
  });
  return beside;
}

/// Returns 1 or -1 for each triangle: all face the same way if those with -1 are reversed. The first triangle of each
/// shell has 1.
/// @throws NoPolyhedron if a shell is one-sided.
std::vector<std::int8_t> facings(const MeshView& mesh, const std::vector<Neighbour>& beside, const Context& context) {
  throw_if_cancelled(context);
  std::vector<std::int8_t> facing(mesh.triangles.size(), 0);
  std::vector<std::uint32_t> line;
  for (std::uint32_t first = 0; first < mesh.triangles.size(); ++first) {
    if (facing[first] != 0 || names_a_vertex_twice(mesh.triangles[first])) continue;
    facing[first] = 1;
    line.push_back(first);
    while (!line.empty()) {
      const std::uint32_t t = line.back();
      line.pop_back();
      for (std::uint32_t k = 0; k < 3; ++k) {
        const Neighbour& other = beside[3 * t + k];
        const auto wanted = static_cast<std::int8_t>(facing[t] * other.agrees);
        if (facing[other.triangle] == 0) line.push_back(other.triangle);
        if (facing[other.triangle] == -wanted) {
          throw NoPolyhedron("the mesh bounds nothing: the surface around triangle " + std::to_string(t) +
                             " has only one side");
        }
        facing[other.triangle] = wanted;
      }
    }
  }
  return facing;
}

/// @throws NoPolyhedron if the triangles around a vertex are more than one fan.
void check_fans(const MeshView& mesh, Sets& corners) {
  std::vector<std::uint32_t> fan(mesh.vertices.size(), no_group);
  for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
    if (names_a_vertex_twice(mesh.triangles[t])) continue;
    for (std::uint32_t k = 0; k < 3; ++k) {
      const std::uint32_t v = mesh.triangles[t][k];
      const std::uint32_t own = corners.find(3 * t + k);
      if (fan[v] == no_group) fan[v] = own;
      if (fan[v] != own) {
        throw NoPolyhedron("the mesh is not manifold: parts of it meet only in vertex " + std::to_string(v));
      }
    }
  }
}

/// Returns the triangles of each shell.
std::vector<std::vector<std::uint32_t>> members(const ClosedShells& shells) {
  std::vector<std::vector<std::uint32_t>> lists(shells.shells.size());
  for (std::uint32_t t = 0; t < shells.of_triangle.size(); ++t) {
    if (shells.of_triangle[t] != no_group) lists[shells.of_triangle[t]].push_back(t);
  }
  return lists;
}

/// A shell, and its direction: 1 if it faces outwards, -1 if it faces inwards, 0 if rounding leaves this open.
struct Measured {
  ClosedShell shell;
  std::int8_t faces_outwards = 0;
};

/// Measures a shell: its genus from its homology, its volume from the tetrahedra between its triangles and one of its
/// vertices.
Measured measured(const MeshView& mesh, const std::vector<std::uint32_t>& triangles,
                  const std::vector<std::int8_t>& facing, std::vector<std::uint32_t>& number, const Context& context) {
  std::vector<Triangle> own;
  own.reserve(triangles.size());
  std::vector<std::uint32_t> vertices;
  const Vec3d origin = mesh.vertices[mesh.triangles[triangles.front()][0]];
  double volume = 0;
  double sum = 0;  // sum of the absolute volumes
  for (const std::uint32_t t : triangles) {
    Triangle& corners = own.emplace_back(mesh.triangles[t]);
    std::array<Vec3d, 3> at;
    for (std::size_t k = 0; k < 3; ++k) {
      at[k] = mesh.vertices[corners[k]] - origin;
      std::uint32_t& name = number[corners[k]];
      if (name == no_group) {
        name = static_cast<std::uint32_t>(vertices.size());
        vertices.push_back(corners[k]);
      }
      corners[k] = name;
    }
    const double tetrahedron = dot(at[0], cross(at[1], at[2])) / 6;
    volume += facing[t] * tetrahedron;
    sum += std::abs(tetrahedron);
  }
  const BettiNumbers betti = homology({vertices.size(), {}, own}, context);
  for (const std::uint32_t v : vertices) number[v] = no_group;
  const bool is_certain = std::abs(volume) > 1e-9 * sum;
  return {{betti[1] / 2, std::abs(volume), 0, 0}, static_cast<std::int8_t>(!is_certain ? 0 : volume > 0 ? 1 : -1)};
}

/// A part of a line between two consecutive crossings.
struct Stretch {
  double length = 0;
  std::vector<std::uint32_t> around;  ///< the shells that contain it, in ascending order
};

/// Returns the longest stretch of a line inside a shell; nullopt if the crossings are inconsistent.
std::optional<Stretch> longest_inside(const std::vector<Crossing>& crossings,
                                      const std::vector<std::uint32_t>& of_triangle, std::uint32_t shell) {
  Stretch longest;
  std::vector<std::uint32_t> around;
  for (std::size_t k = 0; k < crossings.size(); ++k) {
    const std::uint32_t crossed = of_triangle[crossings[k].triangle];
    const auto place = std::lower_bound(around.begin(), around.end(), crossed);
    if (place != around.end() && *place == crossed) {
      around.erase(place);
    } else {
      around.insert(place, crossed);
    }
    if (k + 1 == crossings.size()) break;
    const double length = crossings[k + 1].at - crossings[k].at;
    if (length > longest.length && std::binary_search(around.begin(), around.end(), shell)) longest = {length, around};
  }
  return around.empty() ? std::optional(longest) : std::nullopt;
}

/// Tries lines through random points of a shell, and returns the longest stretch of a line inside it.
class Prober {
 public:
  Prober(const MeshView& mesh, const ClosedShells& shells, const TriangleSearch& search)
      : mesh_(mesh), shells_(shells), search_(search) {}

  Stretch probe(std::uint32_t shell, const std::vector<std::uint32_t>& triangles) {
    constexpr std::uint32_t lines_wanted = 3;
    constexpr std::uint32_t most_lines = 200;
    const double enough = 1e-9 * search_.bounds().diagonal();
    Random random(shell);
    Stretch best;
    std::uint32_t seen = 0;
    for (std::uint32_t k = 0; k < most_lines && (seen < lines_wanted || best.length < enough); ++k) {
      const Triangle& corners = mesh_.triangles[triangles[random.below(triangles.size())]];
      const double s = 0.1 + 0.4 * random.uniform();
      const double t = 0.1 + 0.4 * random.uniform();
      const Vec3d a = mesh_.vertices[corners[0]];
      const Vec3d start = a + (mesh_.vertices[corners[1]] - a) * s + (mesh_.vertices[corners[2]] - a) * t;
      if (!search_.crossings(line_through(start, k), crossings_)) continue;
      std::sort(crossings_.begin(), crossings_.end(), [](const Crossing& x, const Crossing& y) {
        return x.at != y.at ? x.at < y.at : x.triangle < y.triangle;
      });
      const auto found = longest_inside(crossings_, shells_.of_triangle, shell);
      if (!found) continue;
      ++seen;
      if (found->length > best.length) best = *found;
    }
    return best;
  }

 private:
  const MeshView& mesh_;
  const ClosedShells& shells_;
  const TriangleSearch& search_;
  std::vector<Crossing> crossings_;
};

/// Returns true if `outer` contains `inner`. The two shells contain a common point and do not cross. So the larger
/// shell contains the smaller one.
bool encloses(const ClosedShell& outer, const ClosedShell& inner) {
  if (std::abs(outer.volume - inner.volume) <= 1e-12 * inner.volume) {
    throw NoPolyhedron(
        "two shells of the mesh enclose the same volume at the same place, so the void and its filling cannot be "
        "distinguished");
  }
  return outer.volume > inner.volume;
}

}  // namespace

ClosedShells cut_into_shells(const MeshView& mesh, const Context& context) {
  validate(mesh);
  Sets triangles(mesh.triangles.size());
  Sets corners(3 * mesh.triangles.size());
  const std::vector<Side> sides = sorted_sides(mesh, context);
  if (sides.empty()) throw NoPolyhedron("the mesh has no triangle with three different vertices, so it bounds nothing");
  for_each_edge(sides, [&](const Side& a, const Side& b) {
    triangles.join(a.corner / 3, b.corner / 3);
    // One side begins where the other one ends, unless the triangles face different ways.
    const bool is_opposite = a.rises != b.rises;
    corners.join(a.corner, is_opposite ? after(b.corner) : b.corner);
    corners.join(after(a.corner), is_opposite ? b.corner : after(b.corner));
  });
  throw_if_cancelled(context);
  check_fans(mesh, corners);
  const std::vector<Neighbour> beside = neighbours(mesh, sides);
  const std::vector<std::int8_t> facing = facings(mesh, beside, context);
  ClosedShells result;
  result.beside.reserve(beside.size());
  for (const Neighbour& one : beside) result.beside.push_back(one.triangle);
  result.of_triangle.assign(mesh.triangles.size(), no_group);
  for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
    if (names_a_vertex_twice(mesh.triangles[t])) continue;
    const std::uint32_t first = triangles.find(t);
    if (first == t) {
      result.of_triangle[t] = static_cast<std::uint32_t>(result.shells.size());
      result.shells.emplace_back();
    }
    result.of_triangle[t] = result.of_triangle[first];
  }
  throw_if_cancelled(context);
  const auto lists = members(result);
  std::vector<std::uint32_t> number(mesh.vertices.size(), no_group);
  result.outwards.assign(mesh.triangles.size(), 0);
  for (std::size_t s = 0; s < lists.size(); ++s) {
    const auto [shell, faces_outwards] = measured(mesh, lists[s], facing, number, context);
    result.shells[s] = shell;
    for (const std::uint32_t t : lists[s]) result.outwards[t] = static_cast<std::int8_t>(facing[t] * faces_outwards);
  }
  return result;
}

void nest(ClosedShells& shells, const MeshView& mesh, const TriangleSearch& search, const Context& context) {
  const auto lists = members(shells);
  std::vector<std::uint32_t> parent(lists.size(), no_group);
  Prober prober(mesh, shells, search);
  for (std::uint32_t s = 0; s < lists.size(); ++s) {
    throw_if_cancelled(context);
    ClosedShell& own = shells.shells[s];
    const Stretch stretch = prober.probe(s, lists[s]);
    if (!(stretch.length > 1e-13 * search.bounds().diagonal())) {
      throw NoPolyhedron("the shell that contains triangle " + std::to_string(lists[s].front()) +
                         " encloses no volume");
    }
    own.depth = 0;
    for (const std::uint32_t other : stretch.around) {
      if (other == s || !encloses(shells.shells[other], own)) continue;
      ++own.depth;
      if (parent[s] == no_group || shells.shells[other].volume < shells.shells[parent[s]].volume) parent[s] = other;
    }
  }
  shells.bodies = 0;
  for (ClosedShell& shell : shells.shells) {
    if (shell.depth % 2 == 0) shell.body = shells.bodies++;
  }
  for (std::size_t s = 0; s < lists.size(); ++s) {
    if (shells.shells[s].depth % 2 == 1) shells.shells[s].body = shells.shells[parent[s]].body;
  }
}

std::vector<BettiNumbers> betti_numbers(const ClosedShells& shells) {
  std::vector<BettiNumbers> bodies(shells.bodies);
  for (const ClosedShell& shell : shells.shells) {
    BettiNumbers& betti = bodies[shell.body];
    betti[1] += shell.genus;
    ++betti[shell.depth % 2 == 0 ? 0 : 2];
  }
  return bodies;
}

}  // namespace blum::verifier
