#include "blum/surface_map/hausdorff_distance.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "blum/core/exact_text.hpp"
#include "blum/core/parallel.hpp"
#include "blum/core/scale.hpp"
#include "blum/geometry/primitives.hpp"
#include "blum/geometry/weld.hpp"
#include "surface_map/distance_bound.hpp"
#include "surface_map/facing_surface.hpp"

namespace blum {
namespace {

using surface::distance_bound;
using surface::FacingPoint;
using surface::FacingSurface;

constexpr std::size_t points_per_range = 512;
constexpr std::size_t pieces_per_range = 64;
/// Least number of consecutive primitives that are tested and excluded together.
constexpr std::size_t smallest_run = 8;
/// Greatest number of pieces divided in one round. The number is small enough that results of one round save work in
/// the next round.
constexpr std::size_t most_per_round = std::size_t{1} << 16;

/// A part of a primitive: a triangle whose corners are evaluated points.
struct Piece {
  std::array<std::uint32_t, 3> corners{};
  std::uint32_t primitive = 0;
  double bound = 0;  ///< no point of the piece is further from the other mesh than this
};

void check(const HausdorffOptions& options) {
  if (options.tolerance && !(*options.tolerance > 0 && std::isfinite(*options.tolerance))) {
    throw InvalidOption("tolerance is " + exact_text(*options.tolerance) + ", but must be a number above 0");
  }
  if (options.max_points < 1) throw InvalidOption("max_points is 0, but must be at least 1");
}

/// Throws if the meshes are too far apart for hierarchies. A hierarchy finds nothing beyond 1e150 times the size of its
/// mesh.
void check_sizes(const MeshView& a, const MeshView& b, const Box3& both) {
  constexpr double most = 1e140;
  const Vec3d whole = both.size();
  for (const MeshView* mesh : {&a, &b}) {
    const Vec3d own = bounds(*mesh).size();
    const double size = std::max({own.x, own.y, own.z});
    if (size > 0 && std::max({whole.x, whole.y, whole.z}) / size > most) {
      throw InvalidMesh("the box around both meshes is more than 1e140 times as large as the box around one of them");
    }
  }
}

/// Returns a copy of vertices, multiplied by a factor that makes the largest coordinate of both meshes about 1.
/// Products of coordinates then neither overflow nor underflow.
std::vector<Vec3d> scaled(std::span<const Vec3d> vertices, double scale) {
  std::vector<Vec3d> out(vertices.begin(), vertices.end());
  for (Vec3d& v : out) v *= scale;
  return out;
}

/// Finds the point of a mesh that is furthest from another mesh. Pieces that may contain it are divided until no piece
/// can be further than the furthest known point by more than the tolerance.
class FurthestPoint {
 public:
  FurthestPoint(const FacingSurface& mesh, const FacingSurface& other, double tolerance, double rounding,
                std::size_t max_points, const Context& context)
      : mesh_(mesh),
        other_(other),
        tolerance_(std::max(tolerance - 2 * rounding, 0.0)),
        rounding_(rounding),
        max_points_(max_points),
        context_(context) {}

  /// Returns the result in the units of the meshes given to the constructor.
  DirectedHausdorff find() {
    const std::size_t count = mesh_.mesh().vertices.size();
    points_.resize(count);
    is_known_.assign(count, 0);
    furthest_ = primitive_vertices(mesh_.mesh(), mesh_.hierarchy().order()[0])[0];
    primitive_of_furthest_ = mesh_.hierarchy().order()[0];
    evaluate_vertices({{furthest_, primitive_of_furthest_}});
    const std::vector<std::uint32_t> primitives = far_primitives();
    if (are_mostly_common(primitives)) evaluate_common_vertices();
    evaluate_vertices_of(primitives);
    make_pieces(primitives);
    while (!pieces_.empty() && points_.size() < max_points_) divide_furthest();
    for (const Piece& piece : pieces_) settled_ = std::max(settled_, piece.bound);
    return result();
  }

 private:
  [[nodiscard]] double furthest() const { return points_[furthest_].distance; }

  /// Returns the closest point of the other mesh for a point. The caller must know that the distance is at most
  /// `bound`.
  [[nodiscard]] FacingPoint evaluated(const Vec3d& point, double bound) const {
    std::optional<NearestSite> nearest = other_.hierarchy().nearest(point, bound * (1 + 1e-9) + 1e-12);
    if (!nearest) nearest = other_.hierarchy().nearest(point);
    return {point, nearest->point, nearest->distance, nearest->site};
  }

  /// A vertex, and a primitive that contains it.
  struct VertexOf {
    std::uint32_t vertex = 0;
    std::uint32_t primitive = 0;
  };
  void evaluate_vertices(const std::vector<VertexOf>& vertices) {
    parallel_for(context_, vertices.size(), points_per_range, "", [&](const WorkRange& range) {
      const FacingPoint* last = nullptr;
      for (std::size_t k = range.begin; k < range.end; ++k) {
        const std::uint32_t v = vertices[k].vertex;
        const Vec3d& at = mesh_.mesh().vertices[v];
        points_[v] = evaluated(at, last != nullptr ? length(at - last->closest) : HUGE_VAL);
        last = &points_[v];
      }
    });
    evaluations_ += vertices.size();
    for (const VertexOf& one : vertices) {
      is_known_[one.vertex] = 1;
      offer(one.vertex, one.primitive);
    }
  }

  void evaluate_vertices_of(const std::vector<std::uint32_t>& primitives) {
    std::vector<VertexOf> unknown;
    for (const std::uint32_t p : primitives) {
      for (const std::uint32_t v : primitive_vertices(mesh_.mesh(), p)) {
        if (is_known_[v] != 0) continue;
        is_known_[v] = 1;
        unknown.push_back({v, p});
      }
    }
    evaluate_vertices(unknown);
  }

  /// Returns true if at least half of 32 sampled primitives have a first vertex at distance 0 from the other mesh. This
  /// happens if one mesh was made by changing a part of the other mesh.
  bool are_mostly_common(const std::vector<std::uint32_t>& primitives) {
    constexpr std::size_t samples = 32;
    if (primitives.size() < 32 * samples) return false;
    std::vector<std::uint32_t> some;
    for (std::size_t k = 0; k < samples; ++k) some.push_back(primitives[k * primitives.size() / samples]);
    evaluate_vertices_of(some);
    std::size_t common = 0;
    for (const std::uint32_t p : some) {
      if (points_[primitive_vertices(mesh_.mesh(), p)[0]].distance == 0) ++common;
    }
    return 2 * common >= samples;
  }

  /// Evaluates vertices that have the same position as a vertex of the other mesh. These vertices need no search.
  void evaluate_common_vertices() {
    std::vector<Vec3d> both(other_.mesh().vertices.begin(), other_.mesh().vertices.end());
    const std::size_t of_other = both.size();
    both.insert(both.end(), mesh_.mesh().vertices.begin(), mesh_.mesh().vertices.end());
    const std::vector<std::uint32_t> first_there = weld_clusters(both);
    for (std::size_t v = 0; v < is_known_.size(); ++v) {
      const SiteId site(first_there[of_other + v]);
      if (is_known_[v] != 0 || site.value >= of_other || other_.primitives_at(site).empty()) continue;
      points_[v] = {both[site.value], both[site.value], 0, site};
      is_known_[v] = 1;
    }
  }

  /// A range of consecutive primitives in the hierarchy's order, and a box around them.
  struct Run {
    std::size_t begin = 0;
    std::size_t end = 0;
    Box3 box;
    Vec3d center_closest;  ///< closest point of the other mesh to the middle of the box
    double center_distance = 0;
  };

  /// Returns the primitives that may contain points further away than the furthest known point. Whole runs of other
  /// primitives are excluded: half the diagonal of the box, plus the distance of its middle, bounds the distances in a
  /// run.
  std::vector<std::uint32_t> far_primitives() {
    const std::span<const std::uint32_t> order = mesh_.hierarchy().order();
    std::vector<std::uint32_t> out;
    const auto take = [&](const Run& run) {
      const std::span part = order.subspan(run.begin, run.end - run.begin);
      out.insert(out.end(), part.begin(), part.end());
    };
    std::vector<Run> runs{{0, order.size(), {}, {}, 0}};
    std::size_t size = 1;
    while (size < order.size()) size *= 8;
    while (!runs.empty()) {
      size /= 8;
      runs = children(runs, std::max(size, smallest_run));
      if (size <= smallest_run) break;
      evaluate(runs, order);
      std::vector<Run> further;
      for (const Run& run : runs) {
        const double half = run.box.diagonal() / 2;
        const double bound = run.center_distance + half;
        if (bound <= furthest() + tolerance_) {
          settled_ = std::max(settled_, bound);
        } else if (run.center_distance +
                       half * std::sqrt(static_cast<double>(smallest_run) / static_cast<double>(size)) >
                   furthest() + tolerance_) {
          take(run);  // smaller parts of the run will probably not be excluded either
        } else {
          further.push_back(run);
        }
      }
      runs = std::move(further);
    }
    for (const Run& run : runs) take(run);
    return out;
  }

  static std::vector<Run> children(const std::vector<Run>& runs, std::size_t size) {
    std::vector<Run> out;
    for (const Run& run : runs) {
      for (std::size_t begin = run.begin; begin < run.end; begin += size) {
        out.push_back({begin, std::min(begin + size, run.end), {}, run.center_closest, 0});
      }
    }
    return out;
  }

  /// For each run, finds the closest point of the other mesh to the middle of the run's box, and to one vertex of the
  /// run.
  void evaluate(std::vector<Run>& runs, std::span<const std::uint32_t> order) {
    parallel_for(context_, runs.size(), 1, "", [&](const WorkRange& range) {
      for (std::size_t k = range.begin; k < range.end; ++k) {
        Run& run = runs[k];
        for (std::size_t i = run.begin; i < run.end; ++i) {
          for (const std::uint32_t v : primitive_vertices(mesh_.mesh(), order[i])) {
            run.box.extend(mesh_.mesh().vertices[v]);
          }
        }
        const FacingPoint middle = evaluated(run.box.center(), length(run.box.center() - run.center_closest));
        run.center_closest = middle.closest;
        run.center_distance = middle.distance;
      }
    });
    evaluations_ += runs.size();
    std::vector<VertexOf> samples;
    for (const Run& run : runs) {
      const std::uint32_t primitive = order[(run.begin + run.end) / 2];
      const std::uint32_t v = primitive_vertices(mesh_.mesh(), primitive)[0];
      if (is_known_[v] == 0) samples.push_back({v, primitive});
    }
    evaluate_vertices(samples);
  }

  void offer(std::uint32_t point, std::uint32_t primitive) {
    if (!(points_[point].distance > furthest())) return;
    furthest_ = point;
    primitive_of_furthest_ = primitive;
  }

  [[nodiscard]] double bound(const Piece& piece, double enough) const {
    const auto& [a, b, c] = piece.corners;
    return distance_bound({&points_[a], &points_[b], &points_[c]}, other_, enough);
  }

  void make_pieces(const std::vector<std::uint32_t>& primitives) {
    std::vector<Piece> all(primitives.size());
    const double enough = furthest() + tolerance_;
    parallel_for(context_, primitives.size(), pieces_per_range, "", [&](const WorkRange& range) {
      for (std::size_t k = range.begin; k < range.end; ++k) {
        all[k] = {primitive_vertices(mesh_.mesh(), primitives[k]), primitives[k], 0};
        all[k].bound = bound(all[k], enough);
      }
    });
    for (const Piece& piece : all) keep(piece);
  }

  /// Keeps a piece if its bound exceeds the furthest known distance by more than the tolerance. Otherwise the piece is
  /// settled.
  void keep(const Piece& piece) {
    if (piece.bound > furthest() + tolerance_) return pieces_.push_back(piece);
    settled_ = std::max(settled_, piece.bound);
  }

  /// Removes the pieces with the largest bounds from the list and returns them.
  std::vector<Piece> take_furthest() {
    double largest = 0;
    for (const Piece& piece : pieces_) largest = std::max(largest, piece.bound);
    // Results for pieces with larger bounds may settle the others.
    const double least = furthest() + (largest - furthest()) / 2;
    const auto middle = std::partition(pieces_.begin(), pieces_.end(), [&](const Piece& p) { return p.bound < least; });
    const auto rank = [](const Piece& p) { return std::pair(-p.bound, p.corners); };
    if (pieces_.end() - middle > static_cast<std::ptrdiff_t>(most_per_round)) {
      std::nth_element(middle, middle + most_per_round, pieces_.end(),
                       [&](const Piece& p, const Piece& q) { return rank(p) < rank(q); });
    }
    const std::ptrdiff_t count = std::min(pieces_.end() - middle, static_cast<std::ptrdiff_t>(most_per_round));
    std::vector<Piece> taken(middle, middle + count);
    pieces_.erase(middle, middle + count);
    // Searches for neighbouring pieces use the same parts of the hierarchy.
    std::sort(taken.begin(), taken.end(), [](const Piece& p, const Piece& q) {
      return std::tie(p.primitive, p.corners) < std::tie(q.primitive, q.corners);
    });
    return taken;
  }

  /// Halves the pieces with the largest bounds at the middle of their longest sides.
  void divide_furthest() {
    const std::vector<Piece> taken = take_furthest();
    const std::size_t first = points_.size();
    points_.resize(first + taken.size());
    std::vector<std::array<Piece, 2>> halves(taken.size());
    const double enough = furthest() + tolerance_;
    parallel_for(context_, taken.size(), pieces_per_range, "", [&](const WorkRange& range) {
      for (std::size_t k = range.begin; k < range.end; ++k) {
        halves[k] = divided(taken[k], static_cast<std::uint32_t>(first + k));
        for (Piece& half : halves[k]) half.bound = std::min(bound(half, enough), taken[k].bound);
      }
    });
    evaluations_ += taken.size();
    for (std::size_t k = 0; k < taken.size(); ++k) {
      offer(static_cast<std::uint32_t>(first + k), taken[k].primitive);
    }
    for (const std::array<Piece, 2>& both : halves) {
      for (const Piece& half : both) keep(half);
    }
    settle_pieces();
  }

  [[nodiscard]] std::array<Piece, 2> divided(const Piece& piece, std::uint32_t middle) {
    std::size_t longest = 0;
    double squared = -1;
    for (std::size_t k = 0; k < 3; ++k) {
      const double here = squared_length(points_[piece.corners[k]].point - points_[piece.corners[(k + 1) % 3]].point);
      if (here > squared) {
        squared = here;
        longest = k;
      }
    }
    const std::uint32_t a = piece.corners[longest];
    const std::uint32_t b = piece.corners[(longest + 1) % 3];
    const std::uint32_t c = piece.corners[(longest + 2) % 3];
    const Vec3d at = (points_[a].point + points_[b].point) * 0.5;
    double nearest = HUGE_VAL;
    for (const std::uint32_t corner : piece.corners) {
      nearest = std::min(nearest, squared_length(at - points_[corner].closest));
    }
    points_[middle] = evaluated(at, std::sqrt(nearest));
    return {Piece{{a, middle, c}, piece.primitive, piece.bound}, Piece{{middle, b, c}, piece.primitive, piece.bound}};
  }

  void settle_pieces() {
    std::vector<Piece> before;
    before.swap(pieces_);
    for (const Piece& piece : before) keep(piece);
  }

  [[nodiscard]] DirectedHausdorff result() const {
    const FacingPoint& at = points_[furthest_];
    DirectedHausdorff out;
    out.lower = std::max(at.distance - rounding_, 0.0);
    out.upper = std::max(at.distance, settled_) + rounding_;
    out.points = {at.point, at.closest};
    out.primitive = primitive_of_furthest_;
    out.site = at.site;
    out.evaluations = evaluations_;
    return out;
  }

  const FacingSurface& mesh_;
  const FacingSurface& other_;
  double tolerance_;
  double rounding_;
  std::size_t max_points_;
  const Context& context_;
  std::vector<FacingPoint> points_;     ///< the vertices of the mesh, then other points of its primitives
  std::vector<std::uint8_t> is_known_;  ///< for each vertex
  /// Pieces whose bound exceeds the furthest known distance by more than the tolerance.
  std::vector<Piece> pieces_;
  double settled_ = 0;  ///< the largest bound of all settled pieces and runs
  std::uint32_t furthest_ = 0;
  std::uint32_t primitive_of_furthest_ = 0;
  std::size_t evaluations_ = 0;
};

/// Two meshes, scaled so that their largest coordinate is about 1, and the tolerance of the result at that scale.
class MeshPair {
 public:
  MeshPair(const MeshView& a, const MeshView& b, const HausdorffOptions& options, const Context& context)
      : max_points_(std::min<std::size_t>(options.max_points, max_id_count)), context_(context) {
    check(options);
    validate(a);
    validate(b);
    Box3 box = bounds(a);
    box.extend(bounds(b).lower);
    box.extend(bounds(b).upper);
    check_sizes(a, b, box);
    scale_ = scale_to_one(box.largest_coordinate());
    vertices_ = {scaled(a.vertices, scale_), scaled(b.vertices, scale_)};
    meshes_ = {a, b};
    for (std::size_t k = 0; k < 2; ++k) meshes_[k].vertices = vertices_[k];
    build_surfaces(context);
    const double largest = box.largest_coordinate() * scale_;
    rounding_ = 4e-15 * largest;
    tolerance_ = std::max(options.tolerance.value_or(1e-4 * box.diagonal()) * scale_, 1e-13 * largest);
  }

  /// Returns the directed distance of mesh `which` from the other one.
  [[nodiscard]] DirectedHausdorff directed(std::size_t which) const {
    FurthestPoint search(*surfaces_[which], *surfaces_[1 - which], tolerance_, rounding_, max_points_, context_);
    DirectedHausdorff out = search.find();
    out.lower /= scale_;
    out.upper /= scale_;
    for (Vec3d& point : out.points) point = point / scale_;
    return out;
  }

 private:
  /// Builds both surfaces in parallel if their sizes differ by at most a factor of 2. A single build does half of its
  /// work on one thread.
  void build_surfaces(const Context& context) {
    const auto [fewer, more] = std::minmax({primitive_count(meshes_[0]), primitive_count(meshes_[1])});
    const int threads = thread_count(context);
    if (threads < 2 || fewer < more / 2) {
      for (std::size_t k = 0; k < 2; ++k) surfaces_[k].emplace(meshes_[k], context);
      return;
    }
    const Context half{.threads = threads / 2, .cancel = context.cancel};
    parallel_for(
        context, 2, 1, "", [&](const WorkRange& range) { surfaces_[range.begin].emplace(meshes_[range.begin], half); },
        more > 1000 ? Start::at_once : Start::measured);
  }

  std::size_t max_points_;
  const Context& context_;
  double scale_ = 1;
  std::array<std::vector<Vec3d>, 2> vertices_;
  std::array<MeshView, 2> meshes_;
  std::array<std::optional<FacingSurface>, 2> surfaces_;
  double tolerance_ = 0;
  double rounding_ = 0;
};

}  // namespace

DirectedHausdorff directed_hausdorff_distance(const MeshView& mesh, const MeshView& other,
                                              const HausdorffOptions& options, const Context& context) {
  return MeshPair(mesh, other, options, context).directed(0);
}

HausdorffDistance hausdorff_distance(const MeshView& a, const MeshView& b, const HausdorffOptions& options,
                                     const Context& context) {
  const MeshPair pair(a, b, options, context);
  HausdorffDistance out;
  out.forward = pair.directed(0);
  out.backward = pair.directed(1);
  out.lower = std::max(out.forward.lower, out.backward.lower);
  out.upper = std::max(out.forward.upper, out.backward.upper);
  const bool is_forward = out.forward.lower >= out.backward.lower;
  out.points = is_forward ? out.forward.points : std::array{out.backward.points[1], out.backward.points[0]};
  return out;
}

}  // namespace blum
