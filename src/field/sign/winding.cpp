#include "field/sign/winding.hpp"

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <vector>

#include "blum/core/parallel.hpp"
#include "field/sign/components.hpp"

namespace blum {
namespace {

using sign::Components;

constexpr std::size_t queries_per_range = 64;
constexpr std::size_t blocks_per_range = 16;

constexpr std::int64_t few_nodes = 8;

enum class Side : std::uint8_t { outside, inside, varies };

using Corner = std::array<std::int64_t, 3>;

/// Signs of the nodes of one grid.
class SignWriter {
 public:
  SignWriter(Field& field, const WindingNumber& winding, double slack)
      : field_(field), winding_(winding), slack_(slack) {}

  void negate(std::size_t node) {
    if (field_.distance[node] > 0) field_.distance[node] = -field_.distance[node];
  }

  void negate_box(const Corner& first, const Corner& last) {
    for_each_node(first, last, [&](std::size_t node, const Corner&) { negate(node); });
  }

  void ask_node(std::size_t node, const Corner& at) {
    ++queries_;
    if (winding_.is_inside(field_.grid.position(at[0], at[1], at[2]))) negate(node);
  }

  /// A box of nodes over which the winding number may cross 1/2: shares one answer where the change over it, from the
  /// middle, is too small for that; else it is cut in eight.
  void ask_box(const Corner& first, const Corner& last) {
    const Corner size{last[0] - first[0], last[1] - first[1], last[2] - first[2]};
    const Corner middle{first[0] + size[0] / 2, first[1] + size[1] / 2, first[2] + size[2] / 2};
    const std::size_t node = field_.grid.index(middle[0], middle[1], middle[2]);
    // A bound on the change costs more than a few answers.
    if (size[0] * size[1] * size[2] <= few_nodes) {
      for_each_node(first, last, [&](std::size_t each, const Corner& at) { ask_node(each, at); });
      return;
    }
    if (const std::optional<bool> side = common_side(first, last, middle, node)) {
      if (*side) negate_box(first, last);
      return;
    }
    for (int octant = 0; octant < 8; ++octant) {
      Corner from = first;
      Corner to = last;
      for (std::size_t axis = 0; axis < 3; ++axis) {
        ((octant >> axis & 1) != 0 ? from : to)[axis] = middle[axis];
      }
      if (from[0] < to[0] && from[1] < to[1] && from[2] < to[2]) ask_box(from, to);
    }
  }

  template <class Visit>
  void for_each_node(const Corner& first, const Corner& last, const Visit& visit) {
    for (std::int64_t z = first[2]; z < last[2]; ++z) {
      for (std::int64_t y = first[1]; y < last[1]; ++y) {
        const std::size_t row = field_.grid.index(0, y, z);
        for (std::int64_t x = first[0]; x < last[0]; ++x) visit(row + static_cast<std::size_t>(x), {x, y, z});
      }
    }
  }

  [[nodiscard]] std::size_t queries() const { return queries_; }

 private:
  [[nodiscard]] std::optional<bool> common_side(const Corner& first, const Corner& last, const Corner& middle,
                                                std::size_t node) {
    Vec3d reach;
    Box3 box;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      reach[axis] = static_cast<double>(std::max(middle[axis] - first[axis], last[axis] - 1 - middle[axis])) *
                    field_.grid.spacing[axis];
    }
    const double radius = length(reach);
    if (!(std::abs(static_cast<double>(field_.distance[node])) > radius + slack_)) return std::nullopt;
    for (int corner = 0; corner < 8; ++corner) {
      box.extend(field_.grid.position((corner & 1) != 0 ? last[0] - 1 : first[0],
                                      (corner & 2) != 0 ? last[1] - 1 : first[1],
                                      (corner & 4) != 0 ? last[2] - 1 : first[2]));
    }
    constexpr double most = 0.6;
    const double change = winding_.gradient_bound(box, most / radius) * radius;
    if (!(change < most)) return std::nullopt;
    ++queries_;
    return winding_.side(field_.grid.position(middle[0], middle[1], middle[2]), change);
  }

  Field& field_;
  const WindingNumber& winding_;
  double slack_;
  std::size_t queries_ = 0;
};

double common_diagonal(const MeshView& mesh, const GridSpec& grid) {
  Box3 box = bounds(mesh);
  box.extend(bounds(grid));
  return box.diagonal();
}

/// The side of every component, by root.
std::vector<Side> ask_components(const Components& components, const WindingNumber& winding, const GridSpec& grid,
                                 const Context& context) {
  const std::vector<std::uint32_t>& roots = components.roots();
  std::vector<Side> sides(roots.empty() ? 0 : roots.back() + 1, Side::outside);
  parallel_for(context, roots.size(), queries_per_range, "sign", [&](const WorkRange& range) {
    for (std::size_t i = range.begin; i < range.end; ++i) {
      const sign::Component& component = components.component(roots[i]);
      const auto node = static_cast<std::int64_t>(component.node);
      const Vec3d query =
          grid.position(node % grid.size[0], node / grid.size[0] % grid.size[1], node / (grid.size[0] * grid.size[1]));
      std::optional<bool> side;
      if (component.spread > 0) {
        side = winding.side(query, static_cast<double>(component.spread));
      } else {
        side = winding.is_inside(query);
      }
      sides[roots[i]] = !side ? Side::varies : *side ? Side::inside : Side::outside;
    }
  });
  return sides;
}

void write_block(const Components& components, const std::vector<Side>& sides, std::size_t block, SignWriter& writer) {
  const Corner first = components.blocks().first(block);
  const Corner last = components.blocks().last(block);
  if (components.is_whole(block)) {
    const Side side = sides[components.root(block, 0)];
    if (side == Side::inside) writer.negate_box(first, last);
    if (side == Side::varies) writer.ask_box(first, last);
    return;
  }
  writer.for_each_node(first, last, [&](std::size_t node, const Corner& at) {
    const auto place = static_cast<std::size_t>(at[0] - first[0] + 8 * (at[1] - first[1]) + 64 * (at[2] - first[2]));
    const Side side = sides[components.root(block, place)];
    if (side == Side::inside) writer.negate(node);
    if (side == Side::varies) writer.ask_node(node, at);
  });
}

}  // namespace

WindingSignCounts apply_winding_sign(Field& field, const MeshView& mesh, const WindingNumber& winding,
                                     const Context& context) {
  // Two distances, each off by at most 1e-6 of the diagonal, and rounding of their sum.
  const double slack = 4e-6 * common_diagonal(mesh, field.grid);
  const Components components(field, winding, slack, context);
  const std::vector<Side> sides = ask_components(components, winding, field.grid, context);
  std::atomic<std::size_t> queries{components.roots().size()};
  parallel_for(context, components.blocks().count(), blocks_per_range, "", [&](const WorkRange& range) {
    SignWriter writer(field, winding, slack);
    for (std::size_t block = range.begin; block < range.end; ++block) write_block(components, sides, block, writer);
    queries += writer.queries();
  });
  return {queries, components.roots().size()};
}

WindingSignCounts apply_winding_sign(Field& field, const MeshView& mesh, const SiteTable& sites,
                                     const Context& context) {
  const WindingNumber winding(mesh, sites, context);
  return apply_winding_sign(field, mesh, winding, context);
}

}  // namespace blum
