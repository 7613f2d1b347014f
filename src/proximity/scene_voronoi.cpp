#include "proximity/scene_voronoi.hpp"

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <numbers>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "blum/core/context.hpp"
#include "blum/core/parallel.hpp"
#include "blum/geometry/bvh.hpp"
#include "blum/geometry/triangle_mesh.hpp"
#include "proximity/scene_pairs.hpp"

namespace blum::detail {
namespace {

/// A primitive of a scene, given by its object and its number.
struct Member {
  ObjectId object;
  std::uint32_t primitive = 0;
};

/// The primitives of all compared objects, in rows: sorted by object, then by primitive.
class ScenePrimitives {
 public:
  /// @param pairs    the compared pairs of objects; must outlive this.
  /// @param objects  number of objects in the scene.
  ScenePrimitives(std::span<const ObjectPair> pairs, std::size_t objects);

  [[nodiscard]] std::size_t size() const { return members_.size(); }
  [[nodiscard]] const Member& member(std::uint32_t row) const { return members_[row]; }
  /// Returns all primitives at their positions in the scene, as triangles: row r is triangle r. A segment has one
  /// corner twice, and a point has one corner three times.
  [[nodiscard]] const TriangleMesh& mesh() const { return mesh_; }
  [[nodiscard]] std::array<Vec3d, 3> corners(std::uint32_t row) const { return triangle_corners(mesh_, row); }
  [[nodiscard]] Box3 box(std::uint32_t row) const;
  /// Returns the row of a primitive of a compared object.
  [[nodiscard]] std::uint32_t row(ObjectId object, std::uint32_t primitive) const {
    return first_row_[object.value] + primitive;
  }

  /// Returns true if two primitives are compared: their objects are compared, and they are not neighbours in one
  /// object.
  [[nodiscard]] bool are_compared(std::uint32_t a, std::uint32_t b) const;
  /// Returns the closest points of two primitives, with `a` as the first primitive.
  [[nodiscard]] PrimitivePair compare(std::uint32_t a, std::uint32_t b) const;

 private:
  [[nodiscard]] const ObjectPair* pair(ObjectId a, ObjectId b) const { return pairs_[a.value * objects_ + b.value]; }

  std::size_t objects_;
  /// For any two objects, in either order: their pair; null if they are not compared.
  std::vector<const ObjectPair*> pairs_;
  std::vector<Member> members_;
  std::vector<std::uint32_t> first_row_;  ///< first row of each object
  TriangleMesh mesh_;
};

ScenePrimitives::ScenePrimitives(std::span<const ObjectPair> pairs, std::size_t objects)
    : objects_(objects), pairs_(objects * objects, nullptr), first_row_(objects, 0) {
  std::vector<const SceneObject*> scene(objects, nullptr);
  for (const ObjectPair& pair : pairs) {
    const std::size_t a = pair.first().value;
    const std::size_t b = pair.second().value;
    pairs_[a * objects + b] = pairs_[b * objects + a] = &pair;
    scene[a] = &pair.a();
    scene[b] = &pair.b();
  }
  for (std::uint32_t k = 0; k < objects; ++k) {
    if (scene[k] == nullptr) continue;
    first_row_[k] = static_cast<std::uint32_t>(members_.size());
    const auto base = static_cast<std::uint32_t>(mesh_.vertices.size());
    const std::vector<Vec3d> positions = scene[k]->positions();
    mesh_.vertices.insert(mesh_.vertices.end(), positions.begin(), positions.end());
    for (std::uint32_t p = 0; p < scene[k]->primitives(); ++p) {
      const auto [a, b, c] = scene[k]->vertices(p);
      mesh_.triangles.push_back({base + a, base + b, base + c});
      members_.push_back({ObjectId(k), p});
    }
  }
}

Box3 ScenePrimitives::box(std::uint32_t row) const {
  Box3 box;
  for (const Vec3d& corner : corners(row)) box.extend(corner);
  return box;
}

bool ScenePrimitives::are_compared(std::uint32_t a, std::uint32_t b) const {
  const Member& first = members_[a];
  const Member& second = members_[b];
  const ObjectPair* objects = pair(first.object, second.object);
  if (objects == nullptr) return false;
  return !objects->is_self() || (a != b && !objects->are_neighbours(first.primitive, second.primitive));
}

PrimitivePair ScenePrimitives::compare(std::uint32_t a, std::uint32_t b) const {
  const Member& first = members_[a];
  const Member& second = members_[b];
  const ObjectPair& objects = *pair(first.object, second.object);
  if (a < b) return objects.compare(first.primitive, second.primitive);
  return exchanged(objects.compare(second.primitive, first.primitive));
}

/// A primitive, and its distance from the middle of a cell.
struct CellEntry {
  std::uint32_t row = 0;
  double distance = 0;
};

/// A sparse grid of the cells that primitives touch, with the primitives near each cell. Near primitives may be the
/// closest ones to a point of another primitive in the cell (Sud 2006, 4.3; docs/theory/proximity.md).
class VoronoiCells {
 public:
  /// @param cell_size    side of a cell, relative to the mean side of the boxes around primitives.
  /// @param max_distance  mesh units: pairs that are further apart are ignored.
  /// @param is_closest    true if only closest primitives are needed; false if all pairs within max_distance are
  ///                      needed.
  /// @throws Cancelled.
  VoronoiCells(const ScenePrimitives& primitives, double cell_size, double max_distance, bool is_closest,
               const Context& context);

  /// Returns the cells that a primitive touches; an empty list if it touches more than 512. A primitive that touches
  /// more cells is left over: the hierarchy handles it. Primitives that touch a cell with more than 256 primitives near
  /// it are also left over.
  [[nodiscard]] std::span<const std::uint32_t> cells(std::uint32_t row) const;
  [[nodiscard]] bool is_left_over(std::uint32_t row) const { return is_left_over_[row] != 0; }
  /// Returns the number of primitives that are left over.
  [[nodiscard]] std::size_t left_over() const;
  /// Returns the primitives near a cell, sorted by rising distance from the cell's middle.
  [[nodiscard]] std::span<const CellEntry> entries(std::uint32_t cell) const;
  /// Returns the largest distance of points of a cell from its middle. Distances of entries are also measured from the
  /// middle.
  [[nodiscard]] double radius() const { return radius_; }
  /// Returns a bound on the rounding error of sums of distances.
  [[nodiscard]] double rounding() const { return rounding_; }
  /// Returns the number of cells.
  [[nodiscard]] std::size_t size() const { return cell_first_.size(); }

 private:
  struct Place;
  void make_cells(double cell_size, const Context& context);
  void fill_cells(double max_distance, bool is_closest, const Context& context);
  [[nodiscard]] Vec3d middle(std::uint64_t key) const;
  bool fill_closest(const Bvh& bvh, std::uint32_t cell, double max_distance, std::vector<CellEntry>& out) const;
  bool fill_within(const Bvh& bvh, std::uint32_t cell, double distance, std::vector<CellEntry>& out) const;
  [[nodiscard]] std::span<const std::uint32_t> touching(std::uint32_t cell) const;

  const ScenePrimitives& primitives_;
  Vec3d origin_;
  double side_ = 1;
  double radius_ = 0;
  double rounding_ = 0;
  std::vector<std::uint64_t> keys_;         ///< key of each cell
  std::vector<std::uint32_t> rows_;         ///< primitives that touch cells, cell by cell
  std::vector<std::uint32_t> cell_first_;   ///< for each cell, its first index in rows_
  std::vector<std::uint32_t> cells_;        ///< cells that primitives touch, primitive by primitive
  std::vector<std::uint32_t> row_first_;    ///< for each primitive, its first index in cells_; one more item at the end
  std::vector<std::uint8_t> is_left_over_;  ///< for each primitive
  std::vector<std::vector<CellEntry>> entries_;
};

/// Greatest number of cells that a primitive may touch, and of primitives near a cell. Primitives beyond these limits
/// are left over, so that memory and time are at most proportional to the number of primitives.
constexpr std::int64_t most_cells = 512;
constexpr std::size_t most_entries = 256;

constexpr std::int64_t cells_per_axis = std::int64_t{1} << 20;
constexpr std::size_t grain = 256;

/// Returns a unit vector perpendicular to a triangle. Returns 0 if the triangle is so thin that rounding makes the
/// vector unreliable.
Vec3d normal_of(const std::array<Vec3d, 3>& p) {
  const Vec3d u = p[1] - p[0];
  const Vec3d v = p[2] - p[0];
  const Vec3d n = cross(u, v);
  const double longest = std::max({dot(u, u), dot(v, v), dot(v - u, v - u)});
  const double square = dot(n, n);
  return square > std::max(1e-4 * longest * longest, 1e-280) ? n / std::sqrt(square) : Vec3d{};
}

double largest_side(const Box3& box) {
  const Vec3d size = box.size();
  return std::max({size.x, size.y, size.z});
}

/// A cell, given by its key, and a primitive that touches it.
struct VoronoiCells::Place {
  std::uint64_t key;
  std::uint32_t row;
  [[nodiscard]] friend auto operator<=>(const Place&, const Place&) = default;
};

VoronoiCells::VoronoiCells(const ScenePrimitives& primitives, double cell_size, double max_distance, bool is_closest,
                           const Context& context)
    : primitives_(primitives), is_left_over_(primitives.size(), 0) {
  if (primitives.size() == 0) return;
  make_cells(cell_size, context);
  fill_cells(max_distance, is_closest, context);
}

void VoronoiCells::make_cells(double cell_size, const Context& context) {
  const Box3 all = bounds(primitives_.mesh());
  const std::size_t count = primitives_.size();
  double sum = 0;
  for (std::uint32_t row = 0; row < count; ++row) sum += largest_side(primitives_.box(row));
  const double extent = largest_side(all);
  origin_ = all.lower;
  side_ = std::max({cell_size * sum / static_cast<double>(count), 2 * extent / static_cast<double>(cells_per_axis),
                    std::numeric_limits<double>::min()});
  rounding_ = 1e-13 * (length(all.lower) + length(all.upper));
  radius_ = 0.5 * std::numbers::sqrt3 * side_ + rounding_;
  std::vector<std::vector<Place>> parts((count + grain - 1) / grain);
  parallel_for(context, count, grain, "cells", [&](const WorkRange& range) {
    std::vector<Place>& out = parts[range.begin / grain];
    for (auto row = static_cast<std::uint32_t>(range.begin); row < range.end; ++row) {
      const std::array<Vec3d, 3> corners = primitives_.corners(row);
      const Box3 box = primitives_.box(row);
      std::array<std::int64_t, 3> low{};
      std::array<std::int64_t, 3> size{};
      std::int64_t cells = 1;
      for (std::size_t axis = 0; axis < 3; ++axis) {
        const auto at = [&](double x) {
          return std::clamp<std::int64_t>(std::llround(std::floor((x - origin_[axis]) / side_)), 0, cells_per_axis);
        };
        low[axis] = at(box.lower[axis] - rounding_);
        size[axis] = at(box.upper[axis] + rounding_) - low[axis] + 1;
        cells = std::min(cells * size[axis], 2 * most_cells * cells_per_axis);
      }
      if (cells > most_cells) {
        is_left_over_[row] = 1;
        continue;
      }
      const Vec3d normal = normal_of(corners);
      for (std::int64_t n = 0; n < cells; ++n) {
        const std::int64_t x = low[0] + n % size[0];
        const std::int64_t y = low[1] + n / size[0] % size[1];
        const std::int64_t z = low[2] + n / (size[0] * size[1]);
        const auto key = static_cast<std::uint64_t>(x | y << 21 | z << 42);
        if (std::abs(dot(normal, middle(key) - corners[0])) <= radius_) out.push_back({key, row});
      }
    }
  });
  std::vector<Place> places;
  for (const std::vector<Place>& part : parts) places.insert(places.end(), part.begin(), part.end());
  std::sort(places.begin(), places.end());
  row_first_.assign(count + 1, 0);
  for (const Place& place : places) {
    if (keys_.empty() || keys_.back() != place.key) {
      keys_.push_back(place.key);
      cell_first_.push_back(static_cast<std::uint32_t>(rows_.size()));
    }
    rows_.push_back(place.row);
    ++row_first_[place.row + 1];
  }
  for (std::size_t row = 0; row < count; ++row) row_first_[row + 1] += row_first_[row];
  cells_.resize(rows_.size());
  std::vector<std::uint32_t> next(row_first_.begin(), row_first_.end() - 1);
  for (std::uint32_t cell = 0; cell < keys_.size(); ++cell) {
    for (const std::uint32_t row : touching(cell)) cells_[next[row]++] = cell;
  }
}

Vec3d VoronoiCells::middle(std::uint64_t key) const {
  constexpr std::uint64_t mask = (std::uint64_t{1} << 21) - 1;
  return origin_ + Vec3d{static_cast<double>(key & mask) + 0.5, static_cast<double>(key >> 21 & mask) + 0.5,
                         static_cast<double>(key >> 42) + 0.5} *
                       side_;
}

std::span<const std::uint32_t> VoronoiCells::touching(std::uint32_t cell) const {
  const std::size_t end = cell + 1 < cell_first_.size() ? cell_first_[cell + 1] : rows_.size();
  return std::span<const std::uint32_t>(rows_).subspan(cell_first_[cell], end - cell_first_[cell]);
}

std::span<const std::uint32_t> VoronoiCells::cells(std::uint32_t row) const {
  return std::span<const std::uint32_t>(cells_).subspan(row_first_[row], row_first_[row + 1] - row_first_[row]);
}

std::size_t VoronoiCells::left_over() const {
  return static_cast<std::size_t>(std::count(is_left_over_.begin(), is_left_over_.end(), std::uint8_t{1}));
}

std::span<const CellEntry> VoronoiCells::entries(std::uint32_t cell) const {
  return entries_[cell];
}

void VoronoiCells::fill_cells(double max_distance, bool is_closest, const Context& context) {
  const SiteTable sites(primitives_.mesh(), context);
  const Bvh bvh(primitives_.mesh(), sites, context);
  entries_.resize(keys_.size());
  std::vector<std::uint8_t> is_full(keys_.size(), 0);
  parallel_for(context, keys_.size(), grain, "second-order diagram", [&](const WorkRange& range) {
    for (auto cell = static_cast<std::uint32_t>(range.begin); cell < range.end; ++cell) {
      const bool fits = is_closest ? fill_closest(bvh, cell, max_distance, entries_[cell])
                                   : fill_within(bvh, cell, max_distance + radius_, entries_[cell]);
      is_full[cell] = fits ? 0 : 1;
    }
  });
  for (std::uint32_t cell = 0; cell < keys_.size(); ++cell) {
    if (is_full[cell] == 0) continue;
    for (const std::uint32_t row : touching(cell)) is_left_over_[row] = 1;
  }
}

/// Fills the list of a cell for closest primitives. For each primitive that touches the cell, it finds the closest
/// primitive to the cell's middle that it is compared with. The distance found bounds the distances of all primitives
/// in the list.
/// @return false if the list would be too long.
bool VoronoiCells::fill_closest(const Bvh& bvh, std::uint32_t cell, double max_distance,
                                std::vector<CellEntry>& out) const {
  const Vec3d q = middle(keys_[cell]);
  for (std::size_t k = 16; k <= most_entries; k *= 4) {
    const std::vector<NearestPrimitive> near = bvh.nearest_primitives(q, k);
    const bool is_all = near.size() < k;
    if (near.empty()) return true;
    double furthest = 0;  // largest distance of such a closest primitive
    bool is_known = true;
    for (const std::uint32_t row : touching(cell)) {
      const auto found = std::find_if(near.begin(), near.end(), [&](const NearestPrimitive& one) {
        return primitives_.are_compared(row, one.primitive);
      });
      if (found != near.end()) furthest = std::max(furthest, found->distance);
      is_known = is_known && (is_all || found != near.end());
    }
    const double most = max_distance + radius_;
    const double limit = is_known ? std::min(furthest + 2 * radius_, most) : most;
    if (!is_all && near.back().distance <= limit) {
      if (is_known) return fill_within(bvh, cell, limit, out);
      continue;
    }
    for (const NearestPrimitive& one : near) {
      if (one.distance <= limit) out.push_back({one.primitive, one.distance});
    }
    return true;
  }
  return false;
}

bool VoronoiCells::fill_within(const Bvh& bvh, std::uint32_t cell, double distance, std::vector<CellEntry>& out) const {
  bool fits = true;
  bvh.for_each_within(middle(keys_[cell]), distance, [&](const NearestPrimitive& one) {
    out.push_back({one.primitive, one.distance});
    fits = out.size() <= most_entries;
    return fits;
  });
  std::sort(out.begin(), out.end(), [](const CellEntry& a, const CellEntry& b) {
    return std::pair(a.distance, a.row) < std::pair(b.distance, b.row);
  });
  return fits;
}

/// Calls test(other) once for each primitive that may be the closest one to a primitive (if `is_closest`), or within a
/// distance of it.
template <class Test>
void for_each_candidate(const ScenePrimitives& primitives, const VoronoiCells& cells, std::uint32_t row,
                        double max_distance, bool is_closest, std::vector<std::uint32_t>& seen, const Test& test) {
  seen.clear();
  for (const std::uint32_t cell : cells.cells(row)) {
    double limit = max_distance + cells.radius();
    bool is_first = is_closest;
    for (const CellEntry& entry : cells.entries(cell)) {
      if (entry.distance > limit) break;
      if (!primitives.are_compared(row, entry.row)) continue;
      // The first compared entry is the closest primitive to the middle of the cell, except for the primitive itself.
      if (is_first) limit = std::min(limit, entry.distance + 2 * cells.radius());
      is_first = false;
      seen.push_back(entry.row);
    }
  }
  std::sort(seen.begin(), seen.end());
  seen.erase(std::unique(seen.begin(), seen.end()), seen.end());
  for (const std::uint32_t other : seen) test(other);
}

/// Adds up the counts of parts of the work.
void add_all(const std::vector<ProximityReport>& parts, const VoronoiCells& cells, ProximityReport& report) {
  report.culling = Culling::voronoi;
  report.cells += cells.size();
  report.left_over += cells.left_over();
  for (const ProximityReport& part : parts) add(part, report);
}

/// Returns an upper bound on the distance of the closest pair. For each cell, the sum of the distances of two compared
/// primitives from the cell's middle is an upper bound.
double bound_of_cells(const ScenePrimitives& primitives, const VoronoiCells& cells, std::uint32_t rows,
                      double max_distance) {
  double bound = max_distance;
  for (std::uint32_t row = 0; row < rows; ++row) {
    for (const std::uint32_t cell : cells.cells(row)) {
      const auto entries = cells.entries(cell);
      const auto own = std::find_if(entries.begin(), entries.end(), [&](const CellEntry& e) { return e.row == row; });
      if (own == entries.end()) continue;
      for (const CellEntry& other : entries) {
        const double sum = own->distance + other.distance + cells.rounding();
        if (sum >= bound) break;
        if (primitives.are_compared(row, other.row)) bound = sum;
      }
    }
  }
  return bound;
}

}  // namespace

std::optional<PrimitivePair> closest_pair_by_cells(const ObjectPair& pair, std::size_t objects, double cell_size,
                                                   double max_distance, const Context& context,
                                                   ProximityReport& report) {
  if (pair.is_self()) check_neighbours(pair);
  const ScenePrimitives primitives(std::span(&pair, 1), objects);
  const VoronoiCells cells(primitives, cell_size, max_distance, true, context);
  if (cells.left_over() > 0) {
    report.cells += cells.size();
    report.left_over += primitives.size();
    return closest_pair(pair, max_distance, context, report);
  }
  // Rows of the first object precede those of the second.
  const auto rows = static_cast<std::uint32_t>(pair.a().primitives());
  const double bound = bound_of_cells(primitives, cells, rows, max_distance);
  struct Part {
    Closest best;
    ProximityReport report;
  };
  std::vector<Part> parts((rows + grain - 1) / grain);
  parallel_for(context, rows, grain, "separation", [&](const WorkRange& range) {
    Part& part = parts[range.begin / grain];
    part.best.limit = bound;
    std::vector<std::uint32_t> seen;
    for (auto row = static_cast<std::uint32_t>(range.begin); row < range.end; ++row) {
      const Box3 box = primitives.box(row);
      for_each_candidate(primitives, cells, row, part.best.limit, true, seen, [&](std::uint32_t other) {
        if (other < row) return;  // each pair once
        ++part.report.candidates;
        if (box_gap(box, primitives.box(other)) > part.best.limit) return;
        ++part.report.exact_tests;
        part.best.offer(primitives.compare(row, other));
      });
    }
  });
  Closest best{std::nullopt, bound};
  std::vector<ProximityReport> reports;
  for (const Part& part : parts) {
    if (part.best.pair) best.offer(*part.best.pair);
    reports.push_back(part.report);
  }
  add_all(reports, cells, report);
  return best.pair;
}

void closest_of_each_by_cells(std::span<const ObjectPair> pairs, std::size_t objects, double cell_size,
                              double max_distance, const Context& context, ProximityPairs& out) {
  const ScenePrimitives primitives(pairs, objects);
  PhaseTimer timer(out.report.phases);
  const VoronoiCells cells(primitives, cell_size, max_distance, true, context);
  timer.lap("diagram");
  std::vector<std::optional<PrimitivePair>> found(primitives.size());
  std::vector<ProximityReport> parts((found.size() + grain - 1) / grain);
  parallel_for(context, found.size(), grain, "closest primitives", [&](const WorkRange& range) {
    ProximityReport& report = parts[range.begin / grain];
    std::vector<std::uint32_t> seen;
    for (auto row = static_cast<std::uint32_t>(range.begin); row < range.end; ++row) {
      if (cells.is_left_over(row)) continue;
      Closest best{std::nullopt, max_distance};
      const Box3 box = primitives.box(row);
      for_each_candidate(primitives, cells, row, max_distance, true, seen, [&](std::uint32_t other) {
        ++report.candidates;
        if (box_gap(box, primitives.box(other)) > best.limit) return;
        ++report.exact_tests;
        best.offer(primitives.compare(row, other));
      });
      found[row] = best.pair;
    }
  });
  add_all(parts, cells, out.report);
  if (out.report.left_over > 0) {
    const auto is_wanted = [&](ObjectId object, std::uint32_t primitive) {
      return cells.is_left_over(primitives.row(object, primitive));
    };
    const ClosestRows rest = closest_rows(pairs, objects, max_distance, is_wanted, context, out.report);
    for (std::uint32_t row = 0; row < found.size(); ++row) {
      const Member& member = primitives.member(row);
      if (cells.is_left_over(row)) found[row] = rest[member.object.value][member.primitive];
    }
  }
  for (const auto& one : found) {
    if (one) out.pairs.push_back(*one);
  }
  timer.lap("exact tests");
}

void near_pairs_by_cells(std::span<const ObjectPair> pairs, std::size_t objects, double cell_size, double distance,
                         const Context& context, ProximityPairs& out) {
  const ScenePrimitives primitives(pairs, objects);
  PhaseTimer timer(out.report.phases);
  const VoronoiCells cells(primitives, cell_size, distance, false, context);
  timer.lap("diagram");
  if (cells.left_over() > 0) {
    // All pairs of a left-over primitive are needed. The hierarchy can only find them together with all other pairs.
    near_pairs(pairs, distance, Neighbours::left_out, context, out);
    out.report.left_over = primitives.size();
    timer.lap("exact tests");
    return;
  }
  struct Part {
    std::vector<PrimitivePair> pairs;
    ProximityReport report;
  };
  std::vector<Part> parts((primitives.size() + grain - 1) / grain);
  std::atomic<std::size_t> count = out.pairs.size();
  parallel_for(context, primitives.size(), grain, "close pairs", [&](const WorkRange& range) {
    Part& part = parts[range.begin / grain];
    std::vector<std::uint32_t> seen;
    for (auto row = static_cast<std::uint32_t>(range.begin); row < range.end; ++row) {
      const Box3 box = primitives.box(row);
      for_each_candidate(primitives, cells, row, distance, false, seen, [&](std::uint32_t other) {
        if (other < row || count > most_close_pairs) return;  // each pair once
        ++part.report.candidates;
        if (box_gap(box, primitives.box(other)) > distance) return;
        ++part.report.exact_tests;
        const PrimitivePair pair = primitives.compare(row, other);
        if (pair.between.distance > distance) return;
        part.pairs.push_back(pair);
        ++count;
      });
    }
  });
  check_count(count);
  std::vector<std::vector<PrimitivePair>> found;
  std::vector<ProximityReport> reports;
  for (Part& part : parts) {
    found.push_back(std::move(part.pairs));
    reports.push_back(std::move(part.report));
  }
  add_all(reports, cells, out.report);
  add_sorted(std::move(found), context, out.pairs);
  timer.lap("exact tests");
}

}  // namespace blum::detail
