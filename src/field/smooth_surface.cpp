#include "blum/field/smooth_surface.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <numeric>
#include <string>
#include <utility>
#include <vector>

#include "blum/core/parallel.hpp"
#include "blum/geometry/self_intersections.hpp"
#include "blum/grid/image_values.hpp"
#include "blum/grid/selected_voxels.hpp"
#include "field/surface_net.hpp"

namespace blum {
namespace {

constexpr int most_iterations = 1000;
constexpr std::size_t vertices_per_range = 4096;
/// Taubin's steps, in and out. A tube of radius 1.5 voxels keeps its radius over 60 rounds; ripples of 5 voxels go.
constexpr double step_in = 0.5;
constexpr double step_out = -0.51;
/// A vertex that crosses is put back in so many steps.
constexpr std::uint8_t hold_steps = 4;

/// The neighbours of the vertices of a net.
struct Neighbours {
  std::vector<std::uint32_t> begin;
  std::vector<std::uint32_t> vertices;

  /// A side runs one way in one polygon and the other way in another, so each neighbour follows its vertex once.
  explicit Neighbours(const SurfaceNet& net) : begin(net.positions.size() + 1, 0) {
    for_each_side(net, [this](std::uint32_t from, std::uint32_t) { ++begin[from + 1]; });
    std::partial_sum(begin.begin(), begin.end(), begin.begin());
    vertices.resize(begin.back());
    std::vector<std::uint32_t> next(begin.begin(), begin.end() - 1);
    for_each_side(net, [&](std::uint32_t from, std::uint32_t to) { vertices[next[from]++] = to; });
  }

 private:
  template <class Visit>
  static void for_each_side(const SurfaceNet& net, const Visit& visit) {
    for (const auto& polygon : net.polygons) {
      const std::size_t size = polygon[3] == SurfaceNet::none ? 3 : 4;
      for (std::size_t k = 0; k < size; ++k) visit(polygon[k], polygon[(k + 1) % size]);
    }
  }
};

Vec3d moved(const std::vector<Vec3d>& positions, const Neighbours& neighbours, std::size_t vertex, double step) {
  Vec3d sum{};
  const std::uint32_t begin = neighbours.begin[vertex];
  const std::uint32_t end = neighbours.begin[vertex + 1];
  for (std::uint32_t n = begin; n < end; ++n) sum += positions[neighbours.vertices[n]];
  return positions[vertex] + step * (1.0 / (end - begin) * sum - positions[vertex]);
}

/// The places of the vertices after smoothing, each in its box.
std::vector<Vec3d> relaxed(const SurfaceNet& net, int iterations, const Context& context) {
  std::vector<Vec3d> positions = net.positions;
  if (iterations == 0) return positions;
  const Neighbours neighbours(net);
  std::vector<Vec3d> other(positions.size());
  for (int i = 0; i < iterations; ++i) {
    for (const double step : {step_in, step_out}) {
      parallel_for(context, positions.size(), vertices_per_range, "", [&](const WorkRange& range) {
        for (std::size_t v = range.begin; v < range.end; ++v) {
          const Vec3d place = moved(positions, neighbours, v, step);
          other[v] = max(net.boxes[v].low, min(net.boxes[v].high, place));
        }
      });
      std::swap(positions, other);
    }
    if (context.progress) context.progress((i + 1.0) / iterations, "smoothing");
  }
  return positions;
}

bool is_mirrored(const Mat3& direction) {
  return dot(cross(direction.columns[0], direction.columns[1]), direction.columns[2]) < 0;
}

/// The surface on its way from where it began to where smoothing puts it.
class Embedding {
 public:
  Embedding(const SurfaceNet& net, const std::vector<Vec3d>& smooth, const GridSpec& grid)
      : net_(net), smooth_(smooth), grid_(grid), steps_(smooth.size(), hold_steps) {
    mesh_.vertices.resize(smooth.size());
    for (std::size_t v = 0; v < smooth.size(); ++v) place(v);
    add_triangles();
  }

  /// Puts vertices back until the surface does not cross itself. Where it began it does not, so this ends.
  void resolve(const Context& context) {
    constexpr std::size_t limit = 1000000;
    for (SelfIntersections found = find_self_intersections(mesh_, limit, context); !found.pairs.empty();
         found = find_self_intersections(mesh_, limit, context)) {
      std::vector<std::uint32_t> back;
      for (const TrianglePair& pair : found.pairs) {
        for (const TriangleId t : {pair.first, pair.second}) {
          for (const std::uint32_t v : mesh_.triangles[t.value]) back.push_back(v);
        }
      }
      std::sort(back.begin(), back.end());
      back.erase(std::unique(back.begin(), back.end()), back.end());
      std::erase_if(back, [this](std::uint32_t v) { return steps_[v] == 0; });
      if (back.empty()) {
        throw InvalidGrid(
            "the spacing is so small beside the origin that rounded coordinates make the surface cross "
            "itself: move the image closer to the origin");
      }
      for (const std::uint32_t v : back) {
        --steps_[v];
        place(v);
      }
    }
  }

  SmoothSurface result() && {
    SmoothSurface out;
    for (std::size_t v = 0; v < steps_.size(); ++v) {
      if (steps_[v] < hold_steps) ++out.held_vertices;
      const Vec3d move = place_of(v) - net_.positions[v];
      for (std::size_t axis = 0; axis < 3; ++axis) out.largest_move = std::max(out.largest_move, std::abs(move[axis]));
    }
    out.mesh = std::move(mesh_);
    return out;
  }

 private:
  [[nodiscard]] Vec3d place_of(std::size_t v) const {
    if (steps_[v] == hold_steps) return smooth_[v];
    const Vec3d& start = net_.positions[v];
    return start + static_cast<double>(steps_[v]) / hold_steps * (smooth_[v] - start);
  }

  void place(std::size_t v) {
    const Vec3d at = place_of(v);
    const Vec3d& s = grid_.spacing;
    mesh_.vertices[v] = grid_.origin + grid_.direction * Vec3d{at.x * s.x, at.y * s.y, at.z * s.z};
  }

  /// Quadrilaterals are cut along the shorter diagonal.
  void add_triangles() {
    const bool turns = is_mirrored(grid_.direction);
    const auto add = [&](std::uint32_t a, std::uint32_t b, std::uint32_t c) {
      mesh_.triangles.push_back({a, turns ? c : b, turns ? b : c});
    };
    for (const auto& [a, b, c, d] : net_.polygons) {
      if (d == SurfaceNet::none) {
        add(a, b, c);
        continue;
      }
      const auto& at = mesh_.vertices;
      if (squared_length(at[b] - at[d]) < squared_length(at[a] - at[c])) {
        add(a, b, d);
        add(b, c, d);
      } else {
        add(a, b, c);
        add(a, c, d);
      }
    }
  }

  const SurfaceNet& net_;
  const std::vector<Vec3d>& smooth_;
  const GridSpec& grid_;
  std::vector<std::uint8_t> steps_;  ///< of hold_steps, that a vertex is on its way
  TriangleMesh mesh_;
};

}  // namespace

SmoothSurface smooth_surface(const VoxelImageView& image, const LabelSelection& selection,
                             const SmoothSurfaceOptions& options, const Context& context) {
  if (options.iterations < 0 || options.iterations > most_iterations) {
    throw InvalidOption("iterations is " + std::to_string(options.iterations) + ", but must be 0 to " +
                        std::to_string(most_iterations));
  }
  validate(image);
  const VoxelSet voxels = selected_voxels(image, selection, context);
  const SurfaceNet net = make_surface_net(voxels, context);
  if (net.polygons.empty()) throw InvalidImage(nothing_selected_text(image, selection));
  const std::vector<Vec3d> smooth = relaxed(net, options.iterations, context);
  Embedding embedding(net, smooth, image.grid);
  embedding.resolve(context);
  return std::move(embedding).result();
}

}  // namespace blum
