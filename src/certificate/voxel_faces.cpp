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
  parallel_for(context, bricks_.size(), 1024, "", [&](const WorkRange& range) {
    for (std::size_t b = range.begin; b < range.end; ++b) {
      for_each_face(b, [&](const Face& face) { boxes[b].extend(rectangle(face)); });
    }
  });
  std::size_t kept = 0;
  for (std::size_t b = 0; b < bricks_.size(); ++b) {
    if (boxes[b].is_empty()) continue;
    boxes[kept] = boxes[b];
    bricks_[kept++] = bricks_[b];
  }
  boxes.resize(kept);
  tree_ = BoxHierarchy(boxes, context);
  std::vector<Brick> ordered;
  ordered.reserve(kept);
  boxes_.reserve(kept);
  for (const std::uint32_t place : tree_.order()) {
    ordered.push_back(bricks_[place]);
    boxes_.push_back(boxes[place]);
  }
  bricks_.swap(ordered);
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
      // All in, or none: no faces. Others may have none either, where only voxels before them differ.
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

VoxelFaces::Nearest VoxelFaces::nearest(const Vec3d& p) const {
  const Vec3d q = local(p);
  Nearest found;
  double best = HUGE_VAL;
  tree_.search(
      best, [&](std::uint32_t first_child) { return squared_distances(q, tree_.two_boxes(first_child)); },
      [&](std::uint32_t brick) {
        if (!(squared_distance(q, boxes_[brick]) < best)) return best;
        for_each_face(brick, [&](const Face& face) {
          const double squared = squared_distance(q, rectangle(face));
          if (!(squared < best)) return;
          best = squared;
          found.face = face;
        });
        return best;
      });
  found.distance = std::sqrt(best);
  return found;
}

std::optional<std::array<std::int64_t, 3>> VoxelFaces::voxel_at(const Vec3d& p) const {
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
