#include "blum/geometry/bvh.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "blum/core/parallel.hpp"
#include "geometry/box_tree.hpp"
#include "geometry/primitive_block.hpp"
#include "geometry/space_order.hpp"
#include "geometry/triangle_frame.hpp"

namespace blum {
namespace {

constexpr std::size_t leaf_grain = 512;
/// Candidates within this much of the best distance, relative to the lengths involved, are looked at exactly.
constexpr double candidate_slack = 2e-12;

/// A primitive in the form that PrimitiveBlock holds.
struct Primitive {
  std::array<std::uint32_t, 3> vertices{};
  std::array<SiteId, 3> edges{SiteId::none(), SiteId::none(), SiteId::none()};
  SiteId face = SiteId::none();
};

class PrimitiveReader {
 public:
  PrimitiveReader(const MeshView& mesh, const SiteTable& sites) : mesh_(mesh), sites_(sites) {}

  [[nodiscard]] std::size_t count() const {
    return mesh_.triangles.size() + mesh_.segments.size() + mesh_.points.size();
  }

  [[nodiscard]] std::array<std::uint32_t, 3> vertices(std::size_t index) const {
    const std::size_t triangles = mesh_.triangles.size();
    if (index < triangles) return mesh_.triangles[index];
    index -= triangles;
    if (index < mesh_.segments.size()) {
      const Segment& s = mesh_.segments[index];
      return {std::min(s[0], s[1]), std::max(s[0], s[1]), std::max(s[0], s[1])};
    }
    const std::uint32_t v = mesh_.points[index - mesh_.segments.size()];
    return {v, v, v};
  }

  [[nodiscard]] Primitive read(std::size_t index) const {
    Primitive out;
    out.vertices = vertices(index);
    if (index < mesh_.triangles.size()) {
      read_triangle(static_cast<std::uint32_t>(index), out);
    } else if (out.vertices[0] != out.vertices[1]) {
      const Segment edge{out.vertices[0], out.vertices[1]};
      const auto found = std::lower_bound(sites_.edges().begin(), sites_.edges().end(), edge);
      out.edges[0] = edge_site(static_cast<std::uint32_t>(found - sites_.edges().begin()));
    }
    return out;
  }

 private:
  [[nodiscard]] SiteId edge_site(std::uint32_t edge) const { return sites_.id({SiteKind::edge, edge}); }

  void read_triangle(std::uint32_t triangle, Primitive& out) const {
    const std::array<EdgeId, 3>& edges = sites_.triangle_edges()[triangle];
    std::array<std::size_t, 3> corner{0, 1, 2};
    const std::array<std::uint32_t, 3> v = out.vertices;
    std::sort(corner.begin(), corner.end(), [&](std::size_t a, std::size_t b) { return v[a] < v[b]; });
    const auto between = [&](std::size_t a, std::size_t b) {
      const EdgeId edge = edges[(a + 1) % 3 == b ? a : b];
      return edge.has_value() ? edge_site(edge.value) : SiteId::none();
    };
    out.vertices = {v[corner[0]], v[corner[1]], v[corner[2]]};
    out.edges = {between(corner[0], corner[1]), between(corner[1], corner[2]), between(corner[0], corner[2])};
    const bool has_area = out.vertices[0] != out.vertices[1] && out.vertices[1] != out.vertices[2];
    if (has_area) out.face = sites_.id({SiteKind::face, triangle});
  }

  const MeshView& mesh_;
  const SiteTable& sites_;
};

struct Pending {
  double squared = 0;
  std::uint32_t block = 0;
  std::int32_t level = 0;  ///< -1 for a leaf
};

/// Depth-first work list: at most seven siblings wait on each of at most eleven levels.
struct PendingStack {
  std::array<Pending, 128> items;
  std::size_t size = 0;

  void push(const Pending& item) { items[size++] = item; }
  Pending pop() { return items[--size]; }
};

}  // namespace

struct Bvh::Data {
  Box3 bounds;
  double scale = 1;  ///< coordinates in blocks are those of the mesh times this
  std::vector<PrimitiveBlock> leaves;
  BoxTree tree;
};

Bvh::Bvh(const MeshView& mesh, const SiteTable& sites, const Context& context) {
  auto data = std::make_unique<Data>();
  data->bounds = blum::bounds(mesh);
  data->scale = unit_scale(data->bounds);
  const double scale = data->scale;
  const PrimitiveReader reader(mesh, sites);
  const auto box_of = [&](std::size_t index) {
    Box3 box;
    for (const std::uint32_t v : reader.vertices(index)) box.extend(mesh.vertices[v] * scale);
    return box;
  };
  const std::size_t count = reader.count();
  const std::vector<std::uint32_t> order =
      space_order(count, [&](std::size_t index) { return box_of(index).center(); }, context);

  data->leaves.resize((count + lanes - 1) / lanes);
  std::vector<Box3> boxes(data->leaves.size());
  parallel_for(context, data->leaves.size(), leaf_grain, "", [&](const WorkRange& range) {
    for (std::size_t leaf = range.begin; leaf < range.end; ++leaf) {
      for (std::size_t lane = 0; lane < lanes; ++lane) {
        // The last leaf repeats its last primitive.
        const std::size_t index = order[std::min(leaf * lanes + lane, count - 1)];
        const Primitive p = reader.read(index);
        const auto corner = [&](std::size_t k) { return mesh.vertices[p.vertices[k]] * scale; };
        data->leaves[leaf].set(lane, {corner(0), corner(1), corner(2)}, p.vertices, p.edges, p.face);
        boxes[leaf].extend(box_of(index));
      }
    }
  });
  data->tree = make_box_tree(boxes, context);
  data_ = std::move(data);
}

Bvh::Bvh(Bvh&&) noexcept = default;
Bvh& Bvh::operator=(Bvh&&) noexcept = default;
Bvh::~Bvh() = default;

const Box3& Bvh::bounds() const {
  return data_->bounds;
}

std::optional<NearestSite> Bvh::nearest(const Vec3d& query, double max_distance) const {
  const Data& data = *data_;
  const Vec3d q = query * data.scale;
  if (data.tree.is_empty() || !(std::max({std::abs(q.x), std::abs(q.y), std::abs(q.z)}) <= 1e150)) return std::nullopt;

  const Vec3d outside = max(max(data.bounds.lower * data.scale - q, q - data.bounds.upper * data.scale), Vec3d{});
  const double slack = candidate_slack * (1 + length(outside));
  const double furthest = max_distance * data.scale;
  SiteCandidate best;
  double limit = furthest + slack;

  PendingStack stack;
  stack.push({0.0, 0, data.tree.top()});
  double distances[lanes];
  while (stack.size > 0) {
    const Pending item = stack.pop();
    if (!(item.squared <= limit * limit)) continue;
    if (item.level < 0) {
      const PrimitiveBlock& leaf = data.leaves[item.block];
      approximate_distances(leaf, q, distances);
      // The most promising one first: it mostly rules the others out.
      const std::size_t first = static_cast<std::size_t>(std::min_element(distances, distances + lanes) - distances);
      for (std::size_t i = 0; i < lanes; ++i) {
        const std::size_t lane = first ^ i;
        if (!(distances[lane] <= limit)) continue;
        offer_closest(leaf, lane, q, best);
        limit = std::min(limit, best.distance + slack);
      }
      continue;
    }
    squared_distances(data.tree.levels[static_cast<std::size_t>(item.level)][item.block], q, distances);
    // Insert the children below the top of the stack so that the nearest one is popped first.
    const std::size_t bottom = stack.size;
    for (std::size_t lane = 0; lane < lanes; ++lane) {
      if (!(distances[lane] <= limit * limit)) continue;
      std::size_t place = stack.size++;
      for (; place > bottom && stack.items[place - 1].squared < distances[lane]; --place) {
        stack.items[place] = stack.items[place - 1];
      }
      stack.items[place] = {distances[lane], static_cast<std::uint32_t>(item.block * lanes + lane), item.level - 1};
    }
  }
  if (!best.site.has_value() || best.distance > furthest) return std::nullopt;
  return NearestSite{best.point / data.scale, best.distance / data.scale, best.site};
}

bool Bvh::may_touch(const Box3& box) const {
  const Data& data = *data_;
  if (box.is_empty()) return false;
  return blum::may_touch(data.tree, {box.lower * data.scale, box.upper * data.scale});
}

}  // namespace blum
