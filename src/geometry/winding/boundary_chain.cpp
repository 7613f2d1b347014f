#include "geometry/winding/boundary_chain.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <numbers>
#include <numeric>
#include <tuple>
#include <utility>

#include "blum/geometry/space_order.hpp"
#include "geometry/lanes.hpp"

namespace blum {
namespace {

/// Edges are divided into pieces of at most this length, so that their boxes are small. The scaled mesh is about 1
/// long.
constexpr double piece_length = 1.0 / 32;

/// Edge, directed from its smaller to its larger vertex, with a multiplicity.
struct ChainEdge {
  std::uint32_t from = 0, to = 0;
  std::int64_t multiplicity = 0;
};

/// Returns the sum of the directed edges of all triangles. Edges with the same vertex indices are combined.
std::vector<ChainEdge> net_edges(const MeshView& mesh, const SiteTable& sites) {
  std::vector<std::int32_t> net(sites.edge_count(), 0);
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const Triangle& triangle = mesh.triangles[t];
    for (std::size_t k = 0; k < 3; ++k) {
      const EdgeId edge = sites.triangle_edges()[t][k];
      if (edge.has_value()) net[edge.value] += triangle[k] < triangle[(k + 1) % 3] ? 1 : -1;
    }
  }
  std::vector<ChainEdge> chain;
  for (std::size_t e = 0; e < net.size(); ++e) {
    if (net[e] != 0) chain.push_back({sites.edges()[e][0], sites.edges()[e][1], net[e]});
  }
  return chain;
}

/// Replaces vertices at the same position by one, so that their edges cancel.
void weld_chain(const MeshView& mesh, std::vector<ChainEdge>& chain) {
  std::vector<std::uint32_t> vertices;
  for (const ChainEdge& edge : chain) vertices.insert(vertices.end(), {edge.from, edge.to});
  const auto key = [&](std::uint32_t v) {
    const Vec3d& p = mesh.vertices[v];
    return std::tuple(p.x, p.y, p.z);
  };
  std::sort(vertices.begin(), vertices.end(), [&](std::uint32_t a, std::uint32_t b) { return key(a) < key(b); });
  vertices.erase(
      std::unique(vertices.begin(), vertices.end(), [&](std::uint32_t a, std::uint32_t b) { return key(a) == key(b); }),
      vertices.end());
  const auto representative = [&](std::uint32_t v) {
    return *std::lower_bound(vertices.begin(), vertices.end(), v,
                             [&](std::uint32_t a, std::uint32_t b) { return key(a) < key(b); });
  };
  for (ChainEdge& edge : chain) {
    edge.from = representative(edge.from);
    edge.to = representative(edge.to);
    if (edge.from > edge.to) {
      std::swap(edge.from, edge.to);
      edge.multiplicity = -edge.multiplicity;
    }
  }
  const auto ends = [](const ChainEdge& edge) { return std::pair(edge.from, edge.to); };
  std::sort(chain.begin(), chain.end(), [&](const ChainEdge& a, const ChainEdge& b) { return ends(a) < ends(b); });
  std::size_t kept = 0;
  for (std::size_t i = 0; i < chain.size();) {
    ChainEdge sum = chain[i];
    for (++i; i < chain.size() && ends(chain[i]) == ends(sum); ++i) sum.multiplicity += chain[i].multiplicity;
    if (sum.multiplicity != 0 && sum.from != sum.to) chain[kept++] = sum;
  }
  chain.resize(kept);
}

struct Piece {
  Vec3d from, to;
  double multiplicity = 0;  ///< multiplicity > 0; the edge has the direction of the surface's boundary

  [[nodiscard]] Vec3d center() const { return (from + to) * 0.5; }
};

std::vector<BoundaryChain::Edge> directed(const MeshView& mesh, const std::vector<ChainEdge>& chain, double scale) {
  std::vector<BoundaryChain::Edge> edges;
  for (const ChainEdge& edge : chain) {
    const Vec3d a = mesh.vertices[edge.from] * scale;
    const Vec3d b = mesh.vertices[edge.to] * scale;
    if (edge.multiplicity > 0) {
      edges.push_back({a, b, edge.multiplicity});
    } else {
      edges.push_back({b, a, -edge.multiplicity});
    }
  }
  return edges;
}

std::vector<Piece> cut_into_pieces(const std::vector<BoundaryChain::Edge>& edges) {
  std::vector<Piece> pieces;
  for (const auto& [a, b, multiplicity] : edges) {
    const double whole = length(b - a);
    const int count = static_cast<int>(std::ceil(std::clamp(whole / piece_length, 1.0, 1000.0)));
    Vec3d last = a;
    for (int i = 1; i <= count; ++i) {
      const Vec3d next = i == count ? b : a + (b - a) * (static_cast<double>(i) / count);
      pieces.push_back({last, next, static_cast<double>(multiplicity)});
      last = next;
    }
  }
  return pieces;
}

/// Returns the distance between two boxes.
double box_distance(const Box3& a, const Box3& b) {
  return length(max(max(a.lower - b.upper, b.lower - a.upper), Vec3d{}));
}

}  // namespace

BoundaryChain::Cluster BoundaryChain::merge(const Cluster* children, std::size_t count) {
  Cluster out;
  for (std::size_t i = 0; i < count; ++i) {
    out.weight += children[i].weight;
    out.vector += children[i].vector;
    out.center += children[i].center * children[i].weight;
    out.box.extend(children[i].box);
  }
  out.center = out.weight > 0 ? out.center / out.weight : out.box.center();
  for (std::size_t i = 0; i < count; ++i) {
    const double shift = length(children[i].center - out.center);
    out.moment += children[i].moment + shift * children[i].weight;
    out.radius = std::max(out.radius, shift + children[i].radius);
  }
  return out;
}

BoundaryChain::BoundaryChain(const MeshView& mesh, const SiteTable& sites, double scale, const Context& context) {
  std::vector<ChainEdge> chain = net_edges(mesh, sites);
  if (chain.empty()) return;
  weld_chain(mesh, chain);
  edges_ = directed(mesh, chain, scale);
  const std::vector<Piece> pieces = cut_into_pieces(edges_);
  if (pieces.empty()) return;
  std::int64_t count = 0;
  for (const Edge& edge : edges_) count += edge.multiplicity;
  if (count > most_edges) edges_ = {};
  std::vector<Cluster>& level = levels_.emplace_back();
  for (const std::uint32_t i : space_order(pieces.size(), [&](std::size_t k) { return pieces[k].center(); }, context)) {
    const Piece& piece = pieces[i];
    const Vec3d along = piece.to - piece.from;
    const double weight = length(along) * piece.multiplicity;
    Cluster& cluster = level.emplace_back();
    cluster = {piece.center(),
               along * piece.multiplicity,
               weight,
               weight * length(along) / 4,
               length(along) / 2 * (1 + 1e-12),
               piece.multiplicity,
               {}};
    cluster.box.extend(piece.from);
    cluster.box.extend(piece.to);
  }
  while (levels_.back().size() > 1) {
    const std::vector<Cluster>& below = levels_.back();
    std::vector<Cluster> above;
    for (std::size_t i = 0; i < below.size(); i += lanes) {
      above.push_back(merge(&below[i], std::min(lanes, below.size() - i)));
    }
    levels_.push_back(std::move(above));
  }
}

double BoundaryChain::gradient_bound(const Box3& box, double enough) const {
  if (levels_.empty()) return 0;
  struct Item {
    std::uint32_t index;
    std::uint32_t level;
  };
  const Vec3d center = box.center();
  const double half = box.diagonal() / 2;
  std::array<Item, 128> stack;  // the stack contains at most seven siblings from each of at most eleven levels
  std::size_t size = 0;
  stack[size++] = {0, static_cast<std::uint32_t>(levels_.size() - 1)};
  Vec3d field;      // sum of fields, at the box's centre
  double rest = 0;  // bound on contributions not included in `field`
  const auto bound_of = [](double sum) { return sum * (1 + 1e-9) / (4 * std::numbers::pi); };
  while (size > 0) {
    const Item item = stack[--size];
    const Cluster& cluster = levels_[item.level][item.index];
    const Vec3d offset = cluster.center - center;
    const double distance = length(offset);
    const double least = distance - cluster.radius - half;  // lower bound on the distance between box and cluster
    const double missing = cluster.moment + half * cluster.weight;
    const bool is_piece = item.level == 0;
    // Opening a cluster reduces only the error due to the cluster's extent, not that due to the box's extent.
    const bool is_compact =
        least > 0 && (cluster.moment <= 0.2 * cluster.weight * least || cluster.moment <= 0.25 * half * cluster.weight);
    if (!is_piece && !is_compact) {
      const std::size_t end = std::min(std::size_t{item.index + 1} * lanes, levels_[item.level - 1].size());
      for (std::size_t child = std::size_t{item.index} * lanes; child < end; ++child) {
        stack[size++] = {static_cast<std::uint32_t>(child), item.level - 1};
      }
      continue;
    }
    const double apart = std::max(least, box_distance(box, cluster.box));
    if (!(apart > 0)) return HUGE_VAL;
    const double plain = is_piece ? std::min(cluster.weight / (apart * apart), 2 * cluster.multiplicity / apart)
                                  : cluster.weight / (apart * apart);
    const double bound = least > 0 ? 2 * missing / (least * least * least) : HUGE_VAL;
    if (bound < plain) {
      field += cross(cluster.vector, offset) / (distance * distance * distance);
      rest += bound;
    } else {
      rest += plain;
    }
    // The factor is a margin, so that callers may compare multiples of both values.
    if (bound_of(rest) > 1.001 * enough) return bound_of(rest);
  }
  return bound_of(length(field) + rest);
}

}  // namespace blum
