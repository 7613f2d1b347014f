#include "geometry/boundary_chain.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <numbers>
#include <numeric>
#include <tuple>
#include <utility>

#include "geometry/space_order.hpp"

namespace blum {
namespace {

/// Edges are cut into pieces of at most this length (the mesh is about 1 long), so that their boxes are tight.
constexpr double piece_length = 1.0 / 32;

/// A directed edge from the smaller to the larger vertex, times its multiplicity.
struct ChainEdge {
  std::uint32_t from = 0, to = 0;
  std::int64_t multiplicity = 0;
};

/// Adds up the directed edges of all triangles, told apart by vertex index.
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

/// Lets vertices at the same position cancel each other's edges.
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
  Box3 box;
  double weight = 0;
  double multiplicity = 0;
};

std::vector<Piece> cut_into_pieces(const MeshView& mesh, const std::vector<ChainEdge>& chain, double scale) {
  std::vector<Piece> pieces;
  for (const ChainEdge& edge : chain) {
    const Vec3d a = mesh.vertices[edge.from] * scale;
    const Vec3d b = mesh.vertices[edge.to] * scale;
    const double whole = length(b - a);
    const int count = static_cast<int>(std::ceil(std::clamp(whole / piece_length, 1.0, 1000.0)));
    const double multiplicity = static_cast<double>(std::abs(edge.multiplicity));
    Vec3d last = a;
    for (int i = 1; i <= count; ++i) {
      const Vec3d next = i == count ? b : a + (b - a) * (static_cast<double>(i) / count);
      Piece& piece = pieces.emplace_back();
      piece.box.extend(last);
      piece.box.extend(next);
      piece.weight = multiplicity * whole / count;
      piece.multiplicity = multiplicity;
      last = next;
    }
  }
  return pieces;
}

/// Squared distances between a box and eight boxes.
BLUM_LANE_LOOPS void squared_box_distances(const BoxBlock& block, const Box3& box, double (&out)[lanes]) {
  for (std::size_t i = 0; i < lanes; ++i) {
    const double x = std::max(std::max(block.lower[0][i] - box.upper.x, box.lower.x - block.upper[0][i]), 0.0);
    const double y = std::max(std::max(block.lower[1][i] - box.upper.y, box.lower.y - block.upper[1][i]), 0.0);
    const double z = std::max(std::max(block.lower[2][i] - box.upper.z, box.lower.z - block.upper[2][i]), 0.0);
    out[i] = x * x + y * y + z * z;
  }
}

}  // namespace

BoundaryChain::BoundaryChain(const MeshView& mesh, const SiteTable& sites, double scale, const Context& context) {
  std::vector<ChainEdge> chain = net_edges(mesh, sites);
  if (chain.empty()) return;
  weld_chain(mesh, chain);
  const std::vector<Piece> pieces = cut_into_pieces(mesh, chain, scale);
  const std::vector<std::uint32_t> order =
      space_order(pieces.size(), [&](std::size_t i) { return pieces[i].box.center(); }, context);
  std::vector<Box3> boxes;
  std::vector<double> weights;
  for (const std::uint32_t i : order) {
    boxes.push_back(pieces[i].box);
    weights.push_back(pieces[i].weight);
    multiplicity_.push_back(pieces[i].multiplicity);
  }
  tree_ = make_box_tree(boxes, context);
  for (const auto& level : tree_.levels) {
    auto& blocks = weights_.emplace_back(level.size());
    std::vector<double> parents(level.size(), 0.0);
    for (std::size_t i = 0; i < weights.size(); ++i) {
      blocks[i / lanes][i % lanes] = weights[i];
      parents[i / lanes] += weights[i];
    }
    weights = std::move(parents);
  }
}

double BoundaryChain::gradient_bound(const Box3& box) const {
  if (tree_.is_empty()) return 0;
  struct Item {
    std::uint32_t block;
    std::int32_t level;
  };
  std::array<Item, 128> stack;
  std::size_t size = 0;
  stack[size++] = {0, tree_.top()};
  double sum = 0;
  double squared[lanes];
  while (size > 0) {
    const Item item = stack[--size];
    const auto level = static_cast<std::size_t>(item.level);
    const BoxBlock& block = tree_.levels[level][item.block];
    const std::array<double, lanes>& weights = weights_[level][item.block];
    squared_box_distances(block, box, squared);
    for (std::size_t lane = 0; lane < lanes; ++lane) {
      if (!(weights[lane] > 0)) continue;
      const std::size_t child = item.block * lanes + lane;
      if (level == 0) {
        if (squared[lane] == 0) return HUGE_VAL;
        sum += std::min(weights[lane] / squared[lane], 2 * multiplicity_[child] / std::sqrt(squared[lane]));
        continue;
      }
      const Vec3d extent{block.upper[0][lane] - block.lower[0][lane], block.upper[1][lane] - block.lower[1][lane],
                         block.upper[2][lane] - block.lower[2][lane]};
      // A box seen from twice its size away overstates its pieces by a factor of 9/4 at most.
      if (squared[lane] > 4 * squared_length(extent)) {
        sum += weights[lane] / squared[lane];
      } else {
        stack[size++] = {static_cast<std::uint32_t>(child), item.level - 1};
      }
    }
  }
  return sum / (4 * std::numbers::pi);
}

}  // namespace blum
