#include "certificate/voxel_faces.hpp"

#include <algorithm>
#include <cmath>

#include "blum/core/parallel.hpp"

namespace blum::verifier {

VoxelFaces::VoxelFaces(const VoxelSet& voxels, const GridSpec& grid, const Context& context)
    : voxels_(voxels), grid_(grid) {
  const auto layers = static_cast<std::size_t>(voxels.size()[2] / 4 + 1);
  std::vector<std::vector<Brick>> found(layers);
  parallel_for(context, layers, 1, "faces of voxels", [&](const WorkRange& range) {
    for (std::size_t k = range.begin; k < range.end; ++k) find_bricks(static_cast<std::int32_t>(k), found[k]);
  });
  for (const auto& layer : found) bricks_.insert(bricks_.end(), layer.begin(), layer.end());
  std::vector<Box3> boxes(bricks_.size());
  windows_.resize(bricks_.size());
  parallel_for(context, bricks_.size(), 1024, "", [&](const WorkRange& range) {
    for (std::size_t b = range.begin; b < range.end; ++b) {
      windows_[b] = window(bricks_[b]);
      for_each_face(b, [&](const Face& face) { boxes[b].extend(rectangle(face)); });
    }
  });
  std::size_t kept = 0;
  for (std::size_t b = 0; b < bricks_.size(); ++b) {
    if (boxes[b].is_empty()) continue;
    boxes[kept] = boxes[b];
    windows_[kept] = windows_[b];
    bricks_[kept++] = bricks_[b];
  }
  boxes.resize(kept);
  tree_ = BoxHierarchy(boxes, context);
  std::vector<Brick> ordered;
  std::vector<Window> windows;
  ordered.reserve(kept);
  windows.reserve(kept);
  boxes_.reserve(kept);
  for (const std::uint32_t place : tree_.order()) {
    ordered.push_back(bricks_[place]);
    windows.push_back(windows_[place]);
    boxes_.push_back(boxes[place]);
  }
  bricks_.swap(ordered);
  windows_.swap(windows);
  if (!bricks_.empty()) box_ = tree_.node(0).box;
}

std::uint8_t VoxelFaces::five_bits(std::int64_t i, std::int64_t j, std::int64_t k) const {
  if (j < 0 || k < 0 || j >= voxels_.size()[1] || k >= voxels_.size()[2]) return 0;
  const auto row = voxels_.row(j, k);
  if (i < 0) return static_cast<std::uint8_t>(row[0] << 1U & 31U);
  const auto word = static_cast<std::size_t>(i / 64);
  const auto offset = static_cast<unsigned>(i % 64);
  std::uint64_t bits = row[word] >> offset;
  if (offset > 59 && word + 1 < row.size()) bits |= row[word + 1] << (64 - offset);
  return static_cast<std::uint8_t>(bits & 31U);
}

VoxelFaces::Window VoxelFaces::window(const Brick& brick) const {
  Window bits{};
  for (std::size_t z = 0; z < 5; ++z) {
    for (std::size_t y = 0; y < 5; ++y) {
      bits[y + 5 * z] =
          five_bits(4 * std::int64_t{brick[0]} - 1, 4 * std::int64_t{brick[1]} + static_cast<std::int64_t>(y) - 1,
                    4 * std::int64_t{brick[2]} + static_cast<std::int64_t>(z) - 1);
    }
  }
  return bits;
}

void VoxelFaces::find_bricks(std::int32_t layer, std::vector<Brick>& found) const {
  for (std::int32_t j = 0; j <= voxels_.size()[1] / 4; ++j) {
    for (std::int32_t i = 0; i <= voxels_.size()[0] / 4; ++i) {
      const Window bits = window({i, j, layer});
      // Windows with all voxels or none have no faces. Other windows may have no faces either, if they differ only in
      // voxels before the brick.
      const bool is_even = bits[0] == (bits[0] & 1U ? 31U : 0U) &&
                           std::all_of(bits.begin(), bits.end(), [&](std::uint8_t b) { return b == bits[0]; });
      if (!is_even) found.push_back({i, j, layer});
    }
  }
}

Box3 VoxelFaces::rectangle(const Face& face) const {
  Box3 box;
  for (std::size_t a = 0; a < 3; ++a) {
    box.lower[a] = (static_cast<double>(face.voxel[a]) - 0.5) * grid_.spacing[a];
    box.upper[a] = a == face.axis ? box.lower[a] : (static_cast<double>(face.voxel[a]) + 0.5) * grid_.spacing[a];
  }
  return box;
}

struct VoxelFaces::Apart {
  std::array<std::array<double, 4>, 3> planes;  ///< to the lower plane of each of four voxels
  std::array<std::array<double, 4>, 3> slabs;   ///< to the slab between the lower and upper plane of each
};

VoxelFaces::Apart VoxelFaces::apart(const Vec3d& q, const Brick& brick) const {
  Apart all;
  for (std::size_t a = 0; a < 3; ++a) {
    for (std::size_t k = 0; k < 4; ++k) {
      // Computed exactly as in rectangle(), so that distances agree.
      const auto voxel = static_cast<double>(4 * std::int64_t{brick[a]} + static_cast<std::int64_t>(k));
      const double lower = (voxel - 0.5) * grid_.spacing[a];
      const double upper = (voxel + 0.5) * grid_.spacing[a];
      const double plane = std::max(std::max(lower - q[a], q[a] - lower), 0.0);
      const double slab = std::max(std::max(lower - q[a], q[a] - upper), 0.0);
      all.planes[a][k] = plane * plane;
      all.slabs[a][k] = slab * slab;
    }
  }
  return all;
}

VoxelFaces::Nearest VoxelFaces::nearest(const Vec3d& p) const {
  const Vec3d q = local(p);
  Nearest found;
  double best = HUGE_VAL;
  tree_.search(
      best, [&](std::uint32_t first_child) { return squared_distances(q, tree_.two_boxes(first_child)); },
      [&](std::uint32_t brick) {
        if (!(squared_distance(q, boxes_[brick]) < best)) return best;
        const Brick& at = bricks_[brick];
        const Apart apart_from = apart(q, at);
        for_each_face(windows_[brick], [&](std::size_t x, std::size_t y, std::size_t z, std::size_t axis) {
          const double squared = (axis == 0 ? apart_from.planes : apart_from.slabs)[0][x] +
                                 (axis == 1 ? apart_from.planes : apart_from.slabs)[1][y] +
                                 (axis == 2 ? apart_from.planes : apart_from.slabs)[2][z];
          if (!(squared < best)) return;
          best = squared;
          found.face = {{4 * std::int64_t{at[0]} + static_cast<std::int64_t>(x),
                         4 * std::int64_t{at[1]} + static_cast<std::int64_t>(y),
                         4 * std::int64_t{at[2]} + static_cast<std::int64_t>(z)},
                        axis};
        });
        return best;
      });
  found.distance = std::sqrt(best);
  return found;
}

std::optional<VoxelFaces::Voxel> VoxelFaces::voxel_around(const Vec3d& a, const Vec3d& b) const {
  // A voxel contains all points between two of its points.
  std::array<std::array<std::int64_t, 2>, 3> between{};
  for (std::size_t k = 0; k < 3; ++k) {
    const double low = std::min(a[k], b[k]);
    const double high = std::max(a[k], b[k]);
    const double first = std::ceil(high) - 1;
    const double last = std::floor(low);
    if (!(first <= last) || !(std::abs(low) < 1e9)) return std::nullopt;
    between[k] = {static_cast<std::int64_t>(first), static_cast<std::int64_t>(last)};
  }
  for (std::int64_t z = between[2][0]; z <= between[2][1]; ++z) {
    for (std::int64_t y = between[1][0]; y <= between[1][1]; ++y) {
      for (std::int64_t x = between[0][0]; x <= between[0][1]; ++x) {
        if (voxels_.contains(x, y, z)) return Voxel{x, y, z};
      }
    }
  }
  return std::nullopt;
}

std::optional<VoxelFaces::Voxel> VoxelFaces::held(const Vec3d& from, const Vec3d& to) const {
  const Vec3d half{0.5, 0.5, 0.5};
  const Vec3d begin = in_voxels(from) + half;
  const Vec3d end = in_voxels(to) + half;
  if (const auto around = voxel_around(begin, end)) return around;
  Voxel voxel{};
  Voxel step{};
  Vec3d next;   // fraction of the segment at which the next plane is met
  Vec3d every;  // fraction between two planes
  for (std::size_t k = 0; k < 3; ++k) {
    const double way = end[k] - begin[k];
    step[k] = way > 0 ? 1 : way < 0 ? -1 : 0;
    // On a plane between two voxels, the voxel ahead counts.
    const double at = way < 0 ? std::ceil(begin[k]) - 1 : std::floor(begin[k]);
    if (!(std::abs(at) < 1e9)) return std::nullopt;
    voxel[k] = static_cast<std::int64_t>(at);
    every[k] = step[k] == 0 ? HUGE_VAL : 1 / std::abs(way);
    next[k] = step[k] == 0 ? HUGE_VAL : (way > 0 ? at + 1 - begin[k] : begin[k] - at) * every[k];
  }
  while (voxels_.contains(voxel[0], voxel[1], voxel[2])) {
    const double least = std::min({next.x, next.y, next.z});
    if (!(least < 1)) return voxel;
    for (std::size_t k = 0; k < 3; ++k) {  // passes an edge or a corner in one step
      if (next[k] > least) continue;
      voxel[k] += step[k];
      next[k] += every[k];
    }
  }
  return std::nullopt;
}

std::optional<VoxelFaces::Voxel> VoxelFaces::voxel_at(const Vec3d& p) const {
  const Vec3d q = local(p);
  std::array<std::int64_t, 3> voxel{};
  for (std::size_t a = 0; a < 3; ++a) {
    const double at = std::floor(q[a] / grid_.spacing[a] + 0.5);
    if (!(at >= 0) || !(at < static_cast<double>(voxels_.size()[a]))) return std::nullopt;
    voxel[a] = static_cast<std::int64_t>(at);
  }
  return voxels_.contains(voxel[0], voxel[1], voxel[2]) ? std::optional(voxel) : std::nullopt;
}

}  // namespace blum::verifier
