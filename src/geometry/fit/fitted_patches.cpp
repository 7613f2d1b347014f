#include "blum/geometry/fitted_patches.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <numeric>
#include <optional>
#include <string>
#include <tuple>
#include <utility>

#include "blum/core/error.hpp"
#include "blum/core/exact_text.hpp"
#include "blum/core/sort_unique.hpp"
#include "blum/core/union_find.hpp"
#include "blum/geometry/surface_patches.hpp"
#include "geometry/fit/shape_fit.hpp"

namespace blum::detail {
namespace {

constexpr std::uint32_t none = UINT32_MAX;

/// Lists of numbers, row after row.
struct Rows {
  std::vector<std::size_t> first;
  std::vector<std::uint32_t> items;

  [[nodiscard]] std::span<const std::uint32_t> operator[](std::size_t row) const {
    return std::span(items).subspan(first[row], first[row + 1] - first[row]);
  }
};

/// Returns rows without repeated items. Pairs are (row, item).
Rows rows_of(std::size_t count, std::vector<std::pair<std::uint32_t, std::uint32_t>> pairs) {
  sort_unique(pairs);
  Rows out;
  out.first.assign(count + 1, 0);
  for (const auto& [row, item] : pairs) {
    ++out.first[row + 1];
    out.items.push_back(item);
  }
  std::partial_sum(out.first.begin(), out.first.end(), out.first.begin());
  return out;
}

/// Flat faces in coordinates of size 1, with their neighbours across smooth edges.
class FaceGraph {
 public:
  FaceGraph(const MeshView& mesh, const SiteTable& sites, const FlatFaces& faces) : mesh_(mesh), given_(faces) {
    const Box3 box = bounds(mesh);
    origin = (box.lower + box.upper) / 2;
    scale = box.diagonal() > 0 ? 1 / box.diagonal() : 1;
    for (const Vec3d& p : mesh.vertices) places.push_back((p - origin) * scale);
    number_faces();
    find_parts();
    find_neighbours(sites);
  }

  [[nodiscard]] std::size_t size() const { return flat.size(); }

  Vec3d origin;
  double scale = 1;
  std::vector<Vec3d> places;           ///< for each vertex
  std::vector<std::uint32_t> face_of;  ///< for each triangle
  std::vector<FacePlace> flat;         ///< for each face
  Rows triangles, corners, neighbours;
  std::vector<double> borders;  ///< for each neighbour, in the order of `neighbours.items`: length of the common edges

 private:
  void number_faces() {
    std::vector<std::uint32_t> number(mesh_.triangles.size(), none);
    face_of.assign(mesh_.triangles.size(), none);
    for (std::size_t t = 0; t < face_of.size(); ++t) {
      const double size = length(given_.normals[t]);
      if (given_.face_of[t] >= number.size() || !(size > 0)) continue;
      std::uint32_t& own = number[given_.face_of[t]];
      if (own == none) {
        own = static_cast<std::uint32_t>(flat.size());
        flat.push_back({{}, given_.normals[t] / size, 0});
      }
      face_of[t] = own;
    }
  }

  void find_parts() {
    std::vector<std::pair<std::uint32_t, std::uint32_t>> of_triangles, of_corners;
    for (std::uint32_t t = 0; t < face_of.size(); ++t) {
      if (face_of[t] == none) continue;
      of_triangles.emplace_back(face_of[t], t);
      for (const std::uint32_t v : mesh_.triangles[t]) of_corners.emplace_back(face_of[t], v);
      const auto& [a, b, c] = mesh_.triangles[t];
      const double area = 0.5 * length(cross(places[b] - places[a], places[c] - places[a]));
      FacePlace& face = flat[face_of[t]];
      face.weight += area;
      face.middle += area / 3 * (places[a] + places[b] + places[c]);
    }
    triangles = rows_of(flat.size(), std::move(of_triangles));
    corners = rows_of(flat.size(), std::move(of_corners));
    for (std::size_t f = 0; f < flat.size(); ++f) {
      Vec3d middle;
      for (const std::uint32_t v : corners[f]) middle += places[v] / static_cast<double>(corners[f].size());
      flat[f].middle = flat[f].weight > 0 ? flat[f].middle / flat[f].weight : middle;
    }
  }

  void find_neighbours(const SiteTable& sites) {
    const std::vector<std::uint8_t> is_smooth = smooth_edges(mesh_, sites, given_.normals, given_.angle);
    std::vector<std::uint32_t> first(is_smooth.size(), none);  // for each smooth edge, one of its two triangles
    std::vector<Border> found;
    for (std::uint32_t t = 0; t < face_of.size(); ++t) {
      for (const EdgeId edge : sites.triangle_edges()[t]) {
        if (edge == EdgeId::none() || is_smooth[edge.value] == 0) continue;
        std::uint32_t& other = first[edge.value];
        if (other == none) {
          other = t;
          continue;
        }
        const std::uint32_t a = face_of[other], b = face_of[t];
        if (a == none || b == none || a == b) continue;
        const auto& [v, w] = sites.edges()[edge.value];
        const double size = length(places[v] - places[w]);
        found.push_back({a, b, size});
        found.push_back({b, a, size});
      }
    }
    add_borders(std::move(found));
  }

  /// An edge between two faces, with its length.
  struct Border {
    std::uint32_t face = 0, neighbour = 0;
    double size = 0;

    [[nodiscard]] auto key() const { return std::tuple(face, neighbour, size); }
  };
  void add_borders(std::vector<Border> found) {
    std::sort(found.begin(), found.end(), [](const Border& a, const Border& b) { return a.key() < b.key(); });
    std::vector<std::pair<std::uint32_t, std::uint32_t>> pairs;
    for (const auto& [face, neighbour, size] : found) {
      const std::pair pair(face, neighbour);
      if (pairs.empty() || pairs.back() != pair) {
        pairs.push_back(pair);
        borders.push_back(0);
      }
      borders.back() += size;
    }
    neighbours = rows_of(flat.size(), std::move(pairs));
  }

  const MeshView mesh_;
  const FlatFaces& given_;
};

/// Connected faces that fit a shape.
struct Part {
  ShapeModel model;
  std::vector<std::uint32_t> faces;
  double area = 0;
  double depth = 0;      ///< median over the faces: largest distance of middles from the shape
  double deviation = 0;  ///< root of the mean squared distance of vertices and middles
  std::size_t vertices = 0;
};

class PatchGrower {
 public:
  PatchGrower(const MeshView& mesh, const FaceGraph& graph, const FlatFaces& given, const Context& context)
      : mesh_(mesh),
        graph_(graph),
        tolerance_(given.tolerance * graph.scale),
        least_cosine_(std::cos(std::min(89.0, agreement * given.angle) * std::numbers::pi / 180)),
        context_(context),
        order_(graph.size()),
        part_of_(graph.size(), none),
        face_mark_(graph.size(), 0),
        vertex_mark_(graph.places.size(), 0) {
    std::iota(order_.begin(), order_.end(), 0U);
    std::sort(order_.begin(), order_.end(), [&](std::uint32_t a, std::uint32_t b) {
      return std::pair(-graph_.flat[a].weight, a) < std::pair(-graph_.flat[b].weight, b);
    });
  }

  void run() {
    grow_curved();
    grow_planes();
    constexpr int most_rounds = 8;
    for (int round = 0; round < most_rounds; ++round) {
      const bool is_merged = merge_parts();
      const bool is_moved = settle_borders();
      if (!is_merged && !is_moved) break;
      fit_again();
    }
  }

  [[nodiscard]] const std::vector<std::uint32_t>& part_of() const { return part_of_; }
  [[nodiscard]] const std::vector<ShapeModel>& models() const { return models_; }

  /// Returns the shape that fits connected faces best, with the search starting from a known shape.
  [[nodiscard]] ShapeModel settled(const ShapeModel& near, std::span<const std::uint32_t> faces) {
    const std::vector<Vec3d> points = points_of(faces);
    const std::optional<ShapeModel> found = points.size() < 3 ? std::nullopt : refit_shape(near, points, tolerance_, 0);
    return found && farthest(*found, points) <= std::max(tolerance_, farthest(near, points)) ? *found : near;
  }
  [[nodiscard]] std::vector<Vec3d> points_of(std::span<const std::uint32_t> faces) {
    ++vertex_stamp_;
    std::vector<Vec3d> out;
    for (const std::uint32_t f : faces) {
      for (const std::uint32_t v : graph_.corners[f]) {
        if (std::exchange(vertex_mark_[v], vertex_stamp_) != vertex_stamp_) out.push_back(graph_.places[v]);
      }
    }
    return out;
  }
  [[nodiscard]] static double farthest(const ShapeModel& model, std::span<const Vec3d> points) {
    double out = 0;
    for (const Vec3d& p : points) out = std::max(out, std::abs(model.distance(p)));
    return out;
  }

 private:
  static constexpr double agreement = 0.6;      // share of the angle by which normals may differ
  static constexpr double coarse = 5;           // ratio of depths
  static constexpr double larger = 1.25;        // ratio of areas
  static constexpr std::size_t most_near = 40;  // faces of a seed
  static constexpr int most_ends = 8;           // fits of a part that has stopped to grow

  /// Returns the largest distance of vertices of a face from a shape.
  [[nodiscard]] double distance(std::uint32_t f, const ShapeModel& model) const {
    double out = 0;
    for (const std::uint32_t v : graph_.corners[f]) out = std::max(out, std::abs(model.distance(graph_.places[v])));
    return out;
  }

  /// Calls visit(point) for the middles of the edges of a face's triangles, and for the middles of these triangles.
  template <class Visit>
  void visit_middles(std::uint32_t f, const Visit& visit) const {
    for (const std::uint32_t t : graph_.triangles[f]) {
      const auto& [a, b, c] = mesh_.triangles[t];
      const Vec3d &p = graph_.places[a], &q = graph_.places[b], &r = graph_.places[c];
      visit((p + q) / 2);
      visit((q + r) / 2);
      visit((r + p) / 2);
      visit((p + q + r) / 3);
    }
  }
  [[nodiscard]] double depth_of(std::uint32_t f, const ShapeModel& model) const {
    double out = 0;
    visit_middles(f, [&](const Vec3d& p) { out = std::max(out, std::abs(model.distance(p))); });
    return out;
  }

  /// Returns true if vertices of a face are close to a shape, and normals agree.
  [[nodiscard]] bool is_near(std::uint32_t f, const ShapeModel& model) const {
    if (model.kind == SurfaceKind::sphere && graph_.triangles[f].size() > 2) return false;
    for (const std::uint32_t v : graph_.corners[f]) {
      const Vec3d& p = graph_.places[v];
      if (!(std::abs(model.distance(p)) <= tolerance_)) return false;
      const Vec3d normal = model.normal(p);
      if (normal != Vec3d{} && !(dot(normal, graph_.flat[f].normal) >= least_cosine_)) return false;
    }
    return true;
  }
  /// Returns true if a part with a shape may take a face.
  [[nodiscard]] bool admits(const ShapeModel& model, double depth, std::uint32_t f) const {
    if (!is_near(f, model)) return false;
    return model.kind == SurfaceKind::plane || depth_of(f, model) <= std::max(2 * tolerance_, coarse * depth);
  }

  void measure(Part& part) {
    std::vector<double> depths;
    part.area = 0;
    double sum = 0, count = 0;
    for (const std::uint32_t f : part.faces) {
      part.area += graph_.flat[f].weight;
      depths.push_back(0);
      const auto add = [&](const Vec3d& p) {
        const double d = std::abs(part.model.distance(p));
        sum += d * d;
        ++count;
        return d;
      };
      for (const std::uint32_t v : graph_.corners[f]) add(graph_.places[v]);
      visit_middles(f, [&](const Vec3d& p) { depths.back() = std::max(depths.back(), add(p)); });
    }
    const auto middle = depths.begin() + static_cast<std::ptrdiff_t>(depths.size() / 2);
    std::nth_element(depths.begin(), middle, depths.end());
    part.depth = *middle;
    part.deviation = std::sqrt(sum / count);
  }

  /// Fits a shape to faces. Returns nullopt if a face is not near the shape.
  std::optional<Part> fitted(SurfaceKind kind, const std::vector<std::uint32_t>& faces) {
    const std::vector<Vec3d> points = points_of(faces);
    const std::size_t least = static_cast<std::size_t>(parameters_of(kind)) + (kind == SurfaceKind::plane ? 0 : 2);
    if (points.size() < least) return std::nullopt;
    std::vector<FacePlace> places;
    for (const std::uint32_t f : faces) places.push_back(graph_.flat[f]);
    const std::optional<ShapeModel> model = fit_shape(kind, points, places, tolerance_);
    if (!model || !all_near(faces, *model)) return std::nullopt;
    Part part;
    part.model = *model;
    part.faces = faces;
    part.vertices = points.size();
    measure(part);
    for (const std::uint32_t f : faces) {
      if (!admits(part.model, part.depth, f)) return std::nullopt;
    }
    return part;
  }
  [[nodiscard]] bool all_near(std::span<const std::uint32_t> faces, const ShapeModel& model) const {
    return std::all_of(faces.begin(), faces.end(), [&](std::uint32_t f) { return is_near(f, model); });
  }

  /// Adds faces at the border of a part until none fits. Each time that the number of faces has doubled, or nothing
  /// else can be added, the shape is fitted again. Only faces without a part are added.
  void grow(Part& part) {
    ++face_stamp_;
    for (const std::uint32_t f : part.faces) face_mark_[f] = face_stamp_;
    std::size_t begin = 0, fitted_at = part.faces.size();
    int ends = 0;
    while (true) {
      const std::size_t end = part.faces.size();
      for (std::size_t k = begin; k < end; ++k) add_neighbours(part, part.faces[k]);
      begin = end;
      const std::size_t count = part.faces.size();
      const bool is_done = count == end;
      if (is_done && (count == fitted_at || ++ends > most_ends)) break;
      if (!is_done && count < 2 * fitted_at && count > 64) continue;
      fitted_at = count;
      if (refit(part)) begin = 0;  // the new shape may fit neighbours that the old shape did not fit
    }
    part.vertices = points_of(part.faces).size();
    measure(part);
  }
  void add_neighbours(Part& part, std::uint32_t of) {
    for (const std::uint32_t f : graph_.neighbours[of]) {
      if (part_of_[f] != none || face_mark_[f] == face_stamp_ || !admits(part.model, part.depth, f)) continue;
      face_mark_[f] = face_stamp_;
      part.faces.push_back(f);
    }
  }
  bool refit(Part& part) {
    const std::optional<ShapeModel> model =
        refit_shape(part.model, points_of(part.faces), tolerance_, 1e-3 * tolerance_);
    if (!model || !all_near(part.faces, *model)) return false;
    part.model = *model;
    measure(part);
    return true;
  }

  /// Returns the faces around a face, up to a number of steps. Returns the faces of fewer steps if there are too many.
  [[nodiscard]] std::vector<std::uint32_t> around(std::uint32_t seed, int steps) {
    ++face_stamp_;
    face_mark_[seed] = face_stamp_;
    std::vector<std::uint32_t> out{seed};
    std::size_t begin = 0;
    for (int step = 0; step < steps; ++step) {
      const std::size_t end = out.size();
      for (; begin < end; ++begin) {
        for (const std::uint32_t f : graph_.neighbours[out[begin]]) {
          if (out.size() >= most_near) return out;
          if (part_of_[f] != none || face_mark_[f] == face_stamp_) continue;
          face_mark_[f] = face_stamp_;
          out.push_back(f);
        }
      }
    }
    return out;
  }

  /// Calls visit(face) for the neighbours of a face across its long edges, or across its short ones.
  template <class Visit>
  void visit_beside(std::uint32_t of, bool is_long, const Visit& visit) const {
    const std::span<const std::uint32_t> all = graph_.neighbours[of];
    const double* const borders = graph_.borders.data() + graph_.neighbours.first[of];
    const double longest = *std::max_element(borders, borders + all.size());
    for (std::size_t k = 0; k < all.size(); ++k) {
      if (part_of_[all[k]] == none && (borders[k] >= 0.5 * longest) == is_long) visit(all[k]);
    }
  }
  /// Returns a face and its neighbours across its long edges, or across its short edges. So the strips of a cylinder
  /// are found without the faces at the strips' ends.
  [[nodiscard]] std::vector<std::uint32_t> beside(std::uint32_t seed, bool is_long) const {
    std::vector<std::uint32_t> out{seed};
    visit_beside(seed, is_long, [&](std::uint32_t f) { out.push_back(f); });
    return out;
  }
  /// Returns a chain of needles with common long edges, three on either side of a face. Such needles form strips of a
  /// cylinder or cone. Returns an empty list if the other faces are not needles.
  [[nodiscard]] std::vector<std::uint32_t> chain(std::uint32_t seed) {
    ++face_stamp_;
    face_mark_[seed] = face_stamp_;
    std::vector<std::uint32_t> out{seed};
    std::size_t begin = 0;
    for (int step = 0; step < 3; ++step) {
      const std::size_t end = out.size();
      for (; begin < end; ++begin) {
        visit_beside(out[begin], true, [&](std::uint32_t f) {
          if (std::exchange(face_mark_[f], face_stamp_) != face_stamp_) out.push_back(f);
        });
      }
      if (out.size() > end + 2) return {};
    }
    return out;
  }
  /// Returns a face and those neighbours whose area is similar.
  [[nodiscard]] std::vector<std::uint32_t> alike(std::uint32_t seed) const {
    const double area = graph_.flat[seed].weight;
    std::vector<std::uint32_t> out{seed};
    for (const std::uint32_t f : graph_.neighbours[seed]) {
      const double other = graph_.flat[f].weight;
      if (part_of_[f] == none && other < 3 * area && area < 3 * other) out.push_back(f);
    }
    return out;
  }

  /// Returns the best part of a sphere, cylinder or cone that grows from a face. Several sets of faces are tried as a
  /// start, because neighbours of a face may belong to other shapes.
  std::optional<Part> curved_from(std::uint32_t seed) {
    std::vector<std::vector<std::uint32_t>> tried;
    for (int k = 0; k < 6; ++k) {
      std::vector<std::uint32_t> start = k < 2    ? around(seed, 2 - k)
                                         : k < 4  ? beside(seed, k == 2)
                                         : k == 4 ? chain(seed)
                                                  : alike(seed);
      if (start.size() < 3 || start.size() >= most_near) continue;
      if (std::find(tried.begin(), tried.end(), start) != tried.end()) continue;
      if (std::optional<Part> found = curved_from(start)) return found;
      tried.push_back(std::move(start));
    }
    return std::nullopt;
  }

  [[nodiscard]] bool is_evident(const Part& part) const {
    const auto is_single = [&](std::uint32_t f) { return graph_.triangles[f].size() == 1; };
    const auto single = static_cast<std::size_t>(std::count_if(part.faces.begin(), part.faces.end(), is_single));
    const std::size_t more = 2 * single > part.faces.size() ? 6 : 3;
    return part.faces.size() >= 3 && part.vertices >= static_cast<std::size_t>(parameters_of(part.model.kind)) + more;
  }

  /// Returns true if a part is chosen instead of another part from the same seed.
  [[nodiscard]] static bool is_better(const Part& part, const Part& than) {
    if (part.area > larger * than.area) return true;
    if (than.model.kind == SurfaceKind::plane || part.area * larger < than.area) return false;
    return part.deviation < 0.9 * than.deviation && than.deviation > 1e-12;
  }

  std::optional<Part> plane_from(std::uint32_t seed) {
    std::optional<Part> out = fitted(SurfaceKind::plane, {seed});
    if (out) grow(*out);
    return out;
  }

  /// Finds parts of spheres, cylinders and cones.
  void grow_curved() {
    std::vector<std::uint8_t> is_plane(graph_.size(), 0);
    for (std::size_t k = 0; k < order_.size(); ++k) {
      if (k % 1024 == 0) throw_if_cancelled(context_);
      const std::uint32_t seed = order_[k];
      if (part_of_[seed] != none || is_plane[seed] != 0 || graph_.neighbours[seed].empty()) continue;
      const std::optional<Part> best = curved_from(seed);
      if (!best) continue;
      const std::optional<Part> plane = plane_from(seed);
      if (!plane || is_better(*best, *plane)) {
        accept(*best);
      } else {
        for (const std::uint32_t f : plane->faces) is_plane[f] = 1;
      }
    }
  }
  std::optional<Part> curved_from(const std::vector<std::uint32_t>& faces) {
    std::optional<Part> best;
    for (const SurfaceKind kind : {SurfaceKind::sphere, SurfaceKind::cylinder, SurfaceKind::cone}) {
      std::optional<Part> part = fitted(kind, faces);
      if (!part) continue;
      grow(*part);
      if (!is_evident(*part)) continue;
      if (!best || is_better(*part, *best)) best = std::move(part);
    }
    return best;
  }

  void accept(const Part& part) {
    const auto number = static_cast<std::uint32_t>(models_.size());
    models_.push_back(part.model);
    depths_.push_back(part.depth);
    for (const std::uint32_t f : part.faces) part_of_[f] = number;
  }

  void grow_planes() {
    for (std::size_t k = 0; k < order_.size(); ++k) {
      if (k % 1024 == 0) throw_if_cancelled(context_);
      const std::uint32_t f = order_[k];
      if (part_of_[f] != none) continue;
      if (const std::optional<Part> plane = plane_from(f)) {
        accept(*plane);
      } else {  // a face that is less flat than the tolerance
        Part part;
        part.model.point = graph_.flat[f].middle;
        part.model.axis = graph_.flat[f].normal;
        part.faces = {f};
        accept(part);
      }
    }
  }

  [[nodiscard]] std::vector<std::vector<std::uint32_t>> faces_of_parts() const {
    std::vector<std::vector<std::uint32_t>> faces(models_.size());
    for (std::uint32_t f = 0; f < graph_.size(); ++f) faces[part_of_[f]].push_back(f);
    return faces;
  }

  /// Fits the shapes of all parts to their faces.
  void fit_again() {
    const std::vector<std::vector<std::uint32_t>> faces = faces_of_parts();
    for (std::uint32_t p = 0; p < faces.size(); ++p) {
      if (faces[p].empty()) continue;
      Part part;
      part.model = settled(models_[p], faces[p]);
      part.faces = faces[p];
      measure(part);
      models_[p] = part.model;
      depths_[p] = part.depth;
    }
  }

  /// Joins two neighbouring parts if the shape of the larger part fits all faces of the smaller part. Returns true if
  /// parts were joined.
  bool merge_parts() {
    std::vector<std::vector<std::uint32_t>> faces = faces_of_parts();
    std::vector<std::pair<std::uint32_t, std::uint32_t>> pairs;
    for (std::uint32_t f = 0; f < graph_.size(); ++f) {
      for (const std::uint32_t g : graph_.neighbours[f]) {
        const std::uint32_t a = part_of_[f], b = part_of_[g];
        if (a < b && models_[a].kind == models_[b].kind) pairs.emplace_back(a, b);
      }
    }
    sort_unique(pairs);
    bool is_any = false;
    UnionFind joined(models_.size());
    for (const auto& [a, b] : pairs) {
      std::uint32_t to = joined.find(a), from = joined.find(b);
      if (to == from) continue;
      if (faces[to].size() < faces[from].size()) std::swap(to, from);
      const auto fits = [&](std::uint32_t f) { return admits(models_[to], depths_[to], f); };
      if (!std::all_of(faces[from].begin(), faces[from].end(), fits)) continue;
      is_any = joined.join(to, from);
      const std::uint32_t kept = joined.find(to);
      models_[kept] = models_[to];
      depths_[kept] = depths_[to];
      std::vector<std::uint32_t> all = std::move(faces[to]);
      all.insert(all.end(), faces[from].begin(), faces[from].end());
      faces[from].clear();
      faces[kept] = std::move(all);
    }
    for (std::uint32_t& part : part_of_) part = joined.find(part);
    return is_any;
  }

  /// Moves faces at borders to the neighbouring part whose shape is closest to their vertices. Returns true if faces
  /// moved.
  bool settle_borders() {
    bool is_any = false;
    const double least = 0.01 * tolerance_;  // smaller differences change nothing
    std::vector<std::uint32_t> active(graph_.size());
    std::iota(active.begin(), active.end(), 0U);
    for (int sweep = 0; sweep < 50 && !active.empty(); ++sweep) {
      throw_if_cancelled(context_);
      std::vector<std::uint32_t> next;
      for (const std::uint32_t f : active) {
        double own = none;
        const std::uint32_t from = part_of_[f];
        for (const std::uint32_t g : graph_.neighbours[f]) {
          const std::uint32_t other = part_of_[g];
          if (other == from || other == part_of_[f]) continue;
          if (own == none) own = distance(f, models_[from]);
          if (own <= least || !admits(models_[other], depths_[other], f)) continue;
          const double offered = distance(f, models_[other]);
          if (!(offered < own - least)) continue;
          own = offered;
          part_of_[f] = other;
        }
        if (part_of_[f] == from) continue;
        is_any = true;
        next.insert(next.end(), graph_.neighbours[f].begin(), graph_.neighbours[f].end());
      }
      sort_unique(next);
      active = std::move(next);
    }
    return is_any;
  }

  const MeshView& mesh_;
  const FaceGraph& graph_;
  const double tolerance_;     ///< in coordinates of size 1, as all lengths here
  const double least_cosine_;  ///< between normals of faces and shapes
  const Context& context_;
  std::vector<std::uint32_t> order_;    ///< faces by descending area
  std::vector<std::uint32_t> part_of_;  ///< for each face
  std::vector<ShapeModel> models_;      ///< for each part
  std::vector<double> depths_;          ///< for each part
  std::vector<std::uint32_t> face_mark_, vertex_mark_;
  std::uint32_t face_stamp_ = 0, vertex_stamp_ = 0;
};

/// Returns a shape in mesh units.
SurfaceShape described(const ShapeModel& model, std::span<const Vec3d> points, const FaceGraph& graph) {
  SurfaceShape out;
  Vec3d middle;
  for (const Vec3d& p : points) middle += p / static_cast<double>(points.size());
  Vec3d at = model.point;
  out.kind = model.kind;
  out.axis = model.axis;
  switch (model.kind) {
    case SurfaceKind::plane:
      at = middle - dot(middle - model.point, model.axis) * model.axis;
      break;
    case SurfaceKind::sphere:
      out.axis = {};
      break;
    case SurfaceKind::cylinder:
      at += dot(middle - at, model.axis) * model.axis;
      break;
    case SurfaceKind::cone:
      at -= model.radius / std::tan(model.slope) * model.axis;
      if (model.slope < 0) out.axis = -model.axis;
      out.half_angle = std::abs(model.slope) * 180 / std::numbers::pi;
      break;
  }
  if (model.kind == SurfaceKind::sphere || model.kind == SurfaceKind::cylinder) out.radius = model.radius / graph.scale;
  out.point = graph.origin + at / graph.scale;
  out.concave = model.kind != SurfaceKind::plane && model.side < 0;
  out.deviation = PatchGrower::farthest(model, points) / graph.scale;
  return out;
}

}  // namespace

void check_patch_fit(const std::optional<double>& tolerance) {
  if (!tolerance || (*tolerance > 0 && std::isfinite(*tolerance))) return;
  throw InvalidOption("patch_fit is " + exact_text(*tolerance) + " mesh units, but must be above 0");
}

FittedPatches fit_patches(const MeshView& mesh, const SiteTable& sites, const FlatFaces& faces,
                          const Context& context) {
  const FaceGraph graph(mesh, sites, faces);
  PatchGrower grower(mesh, graph, faces, context);
  grower.run();
  const std::vector<std::uint32_t>& part_of = grower.part_of();
  // Faces that changed to other parts may have divided a part.
  UnionFind connected(graph.size());
  for (std::uint32_t f = 0; f < graph.size(); ++f) {
    for (const std::uint32_t g : graph.neighbours[f]) {
      if (part_of[f] == part_of[g]) connected.join(f, g);
    }
  }
  FittedPatches out;
  std::vector<std::uint32_t> number(graph.size(), none);
  std::vector<std::vector<std::uint32_t>> members;
  for (const std::uint32_t f : graph.face_of) {
    out.patch_of.push_back(none);
    if (f == none) continue;
    std::uint32_t& own = number[connected.find(f)];
    if (own == none) {
      own = static_cast<std::uint32_t>(members.size());
      members.emplace_back();
    }
    out.patch_of.back() = own;
  }
  for (std::uint32_t f = 0; f < graph.size(); ++f) members[number[connected.find(f)]].push_back(f);
  for (const std::vector<std::uint32_t>& own : members) {
    const ShapeModel model = grower.settled(grower.models()[part_of[own.front()]], own);
    out.shapes.push_back(described(model, grower.points_of(own), graph));
  }
  return out;
}

}  // namespace blum::detail
