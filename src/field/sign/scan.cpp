#include "field/sign/scan.hpp"

#include <algorithm>
#include <array>
#include <atomic>
#include <utility>

#include "blum/core/parallel.hpp"
#include "field/kernels/row_crossings.hpp"

namespace blum {
namespace {

constexpr std::size_t triangles_per_range = 2048;
constexpr std::size_t vertices_per_range = 16384;
constexpr std::size_t rows_per_range = 256;
/// After this many crossings, a thread adds its count to the common total.
constexpr std::size_t counted_at_once = std::size_t{1} << 16;

struct Crossing {
  std::size_t slice;
  std::uint64_t key;  ///< same encoding as in SignScan::crossings_
};

/// Finds the crossings of triangles given in node units.
class Scanner {
 public:
  Scanner(const std::array<std::int64_t, 3>& size, bool is_mirrored, std::vector<Crossing>& out)
      : size_(size), is_mirrored_(is_mirrored), out_(out) {}

  void scan(const kernels::PlacedTriangle& triangle) {
    const auto slices = triangle.slices(size_[2]);
    for (std::int64_t k = slices.begin; k < slices.end; ++k) {
      const kernels::SliceCut cut(triangle, static_cast<double>(k), is_mirrored_);
      const auto rows = cut.rows(size_[1]);
      for (std::int64_t j = rows.begin; j < rows.end; ++j) {
        const double next = cut.node_behind(static_cast<double>(j));
        if (!(next < static_cast<double>(size_[0]))) continue;
        const std::int64_t node = j * size_[0] + static_cast<std::int64_t>(std::max(next, 0.0));
        out_.push_back({static_cast<std::size_t>(k), 2 * static_cast<std::uint64_t>(node) + (cut.goes_in ? 1U : 0U)});
      }
    }
  }

 private:
  std::array<std::int64_t, 3> size_;
  bool is_mirrored_;
  std::vector<Crossing>& out_;
};

/// One list of crossings per range of triangles.
using Found = std::vector<std::vector<Crossing>>;

/// Finds the crossings of a mesh with the rows of a grid.
/// @return  nothing if there are more than `most` crossings.
std::optional<Found> find_crossings(const MeshView& mesh, const GridSpec& grid, std::size_t most,
                                    const Context& context) {
  const kernels::NodeUnits units(grid);
  std::vector<Vec3d> position(mesh.vertices.size());
  parallel_for(context, position.size(), vertices_per_range, "", [&](const WorkRange& range) {
    for (std::size_t v = range.begin; v < range.end; ++v) position[v] = units.position(mesh.vertices[v]);
  });
  const std::size_t count = mesh.triangles.size();
  Found found((count + triangles_per_range - 1) / triangles_per_range);
  std::atomic<std::size_t> total{0};
  parallel_for(context, count, triangles_per_range, "", [&](const WorkRange& range) {
    std::vector<Crossing>& out = found[range.begin / triangles_per_range];
    Scanner scanner(grid.size, units.is_mirrored, out);
    std::size_t counted = 0;
    for (std::size_t t = range.begin; t < range.end && total <= most && !context.cancel.stop_requested(); ++t) {
      const Triangle& triangle = mesh.triangles[t];
      scanner.scan({position[triangle[0]], position[triangle[1]], position[triangle[2]]});
      if (out.size() - counted < counted_at_once && t + 1 < range.end) continue;
      total += out.size() - counted;
      counted = out.size();
    }
  });
  if (total > most) return std::nullopt;
  return found;
}

/// Negates positive distances.
void negate(float* distance, std::size_t count) {
  for (std::size_t i = 0; i < count; ++i) distance[i] = distance[i] > 0 ? -distance[i] : distance[i];
}

}  // namespace

std::optional<SignScan> SignScan::make(const MeshView& mesh, const GridSpec& grid, const Context& context) {
  const std::size_t most = grid.node_count() / 4 + (std::size_t{1} << 20);
  std::optional<Found> found = find_crossings(mesh, grid, most, context);
  if (!found) return std::nullopt;
  SignScan scan(grid);
  for (const auto& part : *found) {
    for (const Crossing& crossing : part) ++scan.slices_[crossing.slice];
  }
  std::size_t total = 0;
  for (std::size_t& slice : scan.slices_) total += std::exchange(slice, total);
  throw_if_cancelled(context);
  scan.crossings_.resize(total);
  std::vector<std::size_t> next = scan.slices_;
  for (auto& part : *found) {
    for (const Crossing& crossing : part) scan.crossings_[next[crossing.slice]++] = crossing.key;
    part = {};
  }
  parallel_for(context, scan.slices_.size() - 1, 1, "", [&](const WorkRange& range) {
    for (std::size_t k = range.begin; k < range.end; ++k) {
      std::sort(scan.crossings_.begin() + static_cast<std::ptrdiff_t>(scan.slices_[k]),
                scan.crossings_.begin() + static_cast<std::ptrdiff_t>(scan.slices_[k + 1]));
    }
  });
  return scan;
}

void SignScan::apply(Field& field, int level, const Context& context) const {
  const auto width = static_cast<std::size_t>(grid_.size[0]);
  const auto rows_per_slice = static_cast<std::size_t>(grid_.size[1]);
  const std::size_t rows = rows_per_slice * static_cast<std::size_t>(grid_.size[2]);
  parallel_for(context, rows, rows_per_range, "", [&](const WorkRange& range) {
    for (std::size_t row = range.begin; row < range.end; ++row) {
      float* distance = field.distance.data() + row * width;
      const std::size_t slice = row / rows_per_slice;
      const std::size_t first = row % rows_per_slice * width;
      const auto end = crossings_.begin() + static_cast<std::ptrdiff_t>(slices_[slice + 1]);
      auto crossing =
          std::lower_bound(crossings_.begin() + static_cast<std::ptrdiff_t>(slices_[slice]), end, 2 * first);
      int winding = 0;
      const auto settle = [&](std::size_t node, std::size_t next) {
        if (node == next) return;
        if (winding > level) negate(distance + node, next - node);
      };
      std::size_t node = 0;
      for (; crossing != end && *crossing / 2 < first + width; ++crossing) {
        const std::size_t next = *crossing / 2 - first;
        settle(node, next);
        winding += *crossing % 2 != 0 ? 1 : -1;
        node = next;
      }
      settle(node, width);
    }
  });
}

}  // namespace blum
