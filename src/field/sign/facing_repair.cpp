#include "field/sign/facing_repair.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <utility>

#include "blum/core/plural.hpp"
#include "blum/geometry/facing.hpp"
#include "blum/geometry/triangle_components.hpp"
#include "blum/geometry/weld.hpp"
#include "blum/geometry/winding_number.hpp"

namespace blum::sign {
namespace {

/// Share of the largest coordinate: positions that differ by rounding to single precision are at most this far apart.
/// Along each axis, this allows for two units in the last place.
constexpr double single_rounding = 4.2e-7;

/// Triangles that are connected through edges.
struct Part {
  std::vector<std::uint32_t> triangles;
  bool is_closed = true;      ///< every edge has exactly two triangles
  bool is_consistent = true;  ///< no edge with two triangles is traversed in the same direction by both
  Box3 box;
  double area = 0;
  Vec3d net_area{};   ///< sum of the triangles' area vectors: 0 if closed, as long as the area if flat
  double volume = 0;  ///< of the cones from the middle of the box over the triangles
};

/// Winding numbers at sample points of a part. Each number is the mean of the winding numbers on both sides.
struct Surroundings {
  double mean = 0;
  double outward_share = 0;  ///< share of sample points with a positive winding number
  bool has_inside = false;   ///< true if some sample point has a winding number above 1/2 on one side
};

Vec3d area_vector(const MeshView& mesh, const Triangle& t) {
  const Vec3d& a = mesh.vertices[t[0]];
  return cross(mesh.vertices[t[1]] - a, mesh.vertices[t[2]] - a) * 0.5;
}

void measure(const MeshView& mesh, Part& part) {
  part.area = 0;
  part.net_area = {};
  part.volume = 0;
  for (const std::uint32_t t : part.triangles) {
    for (const std::uint32_t v : mesh.triangles[t]) part.box.extend(mesh.vertices[v]);
  }
  const Vec3d middle = part.box.center();
  for (const std::uint32_t t : part.triangles) {
    const Vec3d area = area_vector(mesh, mesh.triangles[t]);
    part.area += length(area);
    part.net_area += area;
    part.volume += dot(mesh.vertices[mesh.triangles[t][0]] - middle, area) / 3;
  }
}

std::vector<Part> parts_of(const MeshView& mesh, const SiteTable& sites) {
  const std::vector<detail::EdgeTally> edges = detail::tally_edges(mesh, sites);
  const detail::SurfaceComponents found = detail::find_components(mesh, sites, edges);
  std::vector<Part> parts(found.count);
  for (std::uint32_t t = 0; t < found.of_triangle.size(); ++t) {
    if (found.of_triangle[t] != detail::no_component) parts[found.of_triangle[t]].triangles.push_back(t);
  }
  for (std::size_t p = 0; p < parts.size(); ++p) parts[p].is_closed = found.is_closed[p] != 0;
  for (const detail::EdgeTally& edge : edges) {
    if (edge.count == 2 && edge.balance != 0) parts[found.of_triangle[edge.triangle]].is_consistent = false;
  }
  for (Part& part : parts) measure(mesh, part);
  return parts;
}

/// Returns true if the part surrounds a volume, at least as well as a half sphere does. Flat sheets and single
/// triangles surround none, so neither of their sides is the inside.
bool surrounds_a_volume(const Part& part) {
  return part.is_closed || length(part.net_area) < 0.6 * part.area;
}

/// Returns true if the part's volume is negative by more than rounding, as that of a part that faces inwards.
bool has_negative_volume(const Part& part) {
  return surrounds_a_volume(part) && part.volume < -1e-9 * part.area * part.box.diagonal();
}

/// Returns point k of a sequence that fills a triangle evenly.
Vec3d place_in(const MeshView& mesh, const Triangle& t, std::size_t k) {
  // The steps of the two-dimensional golden sequence, see Roberts, "The unreasonable effectiveness of quasirandom
  // sequences", 2018.
  const double n = static_cast<double>(k) + 0.5;
  double u = n * 0.7548776662466927;
  double v = n * 0.5698402909980532;
  u -= std::floor(u);
  v -= std::floor(v);
  if (u + v > 1) {
    u = 1 - u;
    v = 1 - v;
  }
  const Vec3d& a = mesh.vertices[t[0]];
  return a + (mesh.vertices[t[1]] - a) * u + (mesh.vertices[t[2]] - a) * v;
}

/// Examines sample points that are spread evenly over the area of a part.
Surroundings surroundings(const MeshView& mesh, const Part& part, const WindingNumber& winding, double offset,
                          std::size_t places) {
  Surroundings out;
  if (!(part.area > 0)) return out;
  double passed = 0;
  std::size_t place = 0;
  std::size_t outward = 0;
  for (const std::uint32_t t : part.triangles) {
    const Vec3d area = area_vector(mesh, mesh.triangles[t]);
    passed += length(area);
    while (place < places && (static_cast<double>(place) + 0.5) * part.area <= passed * static_cast<double>(places)) {
      const Vec3d at = place_in(mesh, mesh.triangles[t], place++);
      const Vec3d step = area * (offset / length(area));
      const double front = winding.approximate(at + step);
      const double back = winding.approximate(at - step);
      out.mean += 0.5 * (front + back);
      outward += front + back > 0 ? 1 : 0;
      out.has_inside = out.has_inside || std::max(front, back) > 0.5;
    }
  }
  if (place == 0) return out;
  out.mean /= static_cast<double>(place);
  out.outward_share = static_cast<double>(outward) / static_cast<double>(place);
  return out;
}

/// Returns true if a part certainly faces into the solid. The winding numbers of parts that face outwards are positive.
/// The winding numbers of flat sheets are close to 0.
bool faces_inwards(const Part& part, const Surroundings& around) {
  if (!part.is_consistent || !surrounds_a_volume(part)) return false;
  if (part.is_closed && has_negative_volume(part)) return around.mean < -0.1;
  if (part.is_closed) return around.mean < -0.4;
  return around.mean < -0.25 && around.outward_share < 0.1;
}

/// Returns true if a part may face into the solid, so that its inside is unclear.
bool is_unclear(const Part& part, const Surroundings& around) {
  return part.is_consistent && !part.is_closed && has_negative_volume(part) && around.mean < -0.12 &&
         !around.has_inside;
}

class Repairer {
 public:
  Repairer(const MeshView& mesh, const SiteTable& sites, const Orientation& facts, const Context& context)
      : given_(mesh), context_(context), view_(mesh), sites_(&sites), facts_(facts) {
    if (facts.boundary_edges > 0) join_positions();
  }

  FacingRepair run(FunctionRef<bool(const MeshView&)> crosses) {
    if (facts_.closed) {
      repair_closed();
      if (facts_.oriented || turned_.has_value()) examine_crossing(crosses);
    } else {
      examine();
      warn_of_welded_edges();
    }
    return finished();
  }

 private:
  /// Gives vertices at the same position the same index. If the mesh still has a boundary, positions that differ only
  /// by rounding to single precision count as the same, too.
  void join_positions() {
    join(0);
    if (facts_.boundary_edges > 0) join(single_rounding * bounds(given_).largest_coordinate());
  }

  /// Joins vertices that are at most `tolerance` apart, if the mesh then has fewer boundary edges.
  void join(double tolerance) {
    const std::vector<std::uint32_t> cluster = weld_clusters(given_.vertices, tolerance);
    bool is_same = true;
    for (std::uint32_t v = 0; v < cluster.size(); ++v) is_same = is_same && cluster[v] == v;
    if (is_same) return;
    const std::vector<Triangle> before = joined_;
    const Orientation facts = facts_;
    joined_.assign(given_.triangles.begin(), given_.triangles.end());
    for (Triangle& t : joined_) t = {cluster[t[0]], cluster[t[1]], cluster[t[2]]};
    use(joined_);
    facts_ = orientation(view_, *sites_);
    is_joined_ = true;
    if (tolerance == 0 || facts_.boundary_edges < facts.boundary_edges) return;
    joined_ = before;
    is_joined_ = !before.empty();
    use(is_joined_ ? std::span<const Triangle>(joined_) : given_.triangles);
    facts_ = facts;
  }

  void use(std::span<const Triangle> triangles) {
    view_ = {given_.vertices, triangles, {}, {}};
    sites_ = &own_sites_.emplace(view_, context_);
  }

  void repair_closed() {
    std::optional<detail::RepairedFacing> repaired = detail::repaired_facing(view_, *sites_, facts_, context_);
    if (!repaired) return;
    triangles_ = repaired->reversed_triangles;
    shells_ = repaired->reversed_shells;
    turned_ = std::move(repaired->triangles);
  }

  /// Shells that cross have no depth. So winding numbers decide if crossing shells with a negative volume are reversed.
  void examine_crossing(FunctionRef<bool(const MeshView&)> crosses) {
    if (facts_.components < 2) return;
    const std::vector<Triangle> before(view_.triangles.begin(), view_.triangles.end());
    if (turned_) use(*turned_);
    const std::vector<Part> parts = parts_of(view_, *sites_);
    if (std::none_of(parts.begin(), parts.end(), has_negative_volume) || !crosses(view_)) return;
    if (reverse_inward_parts(parts)) count_shells(before, parts);
  }

  void examine() {
    std::vector<Part> parts = parts_of(view_, *sites_);
    const std::vector<Triangle> before(view_.triangles.begin(), view_.triangles.end());
    const bool is_oriented = orient_parts(parts);
    const bool is_any = std::any_of(parts.begin(), parts.end(), has_negative_volume) && reverse_inward_parts(parts);
    if (is_oriented && is_any) count_shells(before, parts);
  }

  /// Gives the triangles of each part consistent orientations, if the part then surrounds a volume. Returns true if any
  /// triangle was reversed.
  bool orient_parts(std::vector<Part>& parts) {
    const auto is_consistent = [](const Part& part) { return part.is_consistent; };
    if (std::all_of(parts.begin(), parts.end(), is_consistent)) return false;
    const std::vector<Triangle> agreeing = detail::agreeing_patches(view_, *sites_);
    std::vector<Triangle> triangles(view_.triangles.begin(), view_.triangles.end());
    for (Part& part : parts) {
      if (part.is_consistent) continue;
      measure({given_.vertices, agreeing, {}, {}}, part);
      if (!surrounds_a_volume(part)) continue;
      for (const std::uint32_t t : part.triangles) {
        triangles_ += triangles[t] != agreeing[t] ? 1 : 0;
        triangles[t] = agreeing[t];
      }
    }
    if (triangles_ == 0) return false;
    oriented_ = std::move(triangles);
    turned_ = oriented_;
    use(oriented_);
    parts = parts_of(view_, *sites_);
    facts_ = orientation(view_, *sites_);
    return true;
  }

  /// Reverses the parts that face into the solid. Returns true if there are any.
  bool reverse_inward_parts(const std::vector<Part>& parts) {
    const WindingNumber winding(view_, *sites_, context_);
    Box3 box;
    for (const Part& part : parts) box.extend(part.box);
    // Many parts share a fixed number of sample points, so that the total cost stays about that of a WindingNumber.
    const std::size_t places = std::clamp<std::size_t>(16384 / parts.size(), 16, 128);
    std::vector<Triangle> triangles(view_.triangles.begin(), view_.triangles.end());
    bool is_any = false;
    for (const Part& part : parts) {
      throw_if_cancelled(context_);
      const Surroundings around = surroundings(view_, part, winding, 1e-6 * box.diagonal(), places);
      if (!faces_inwards(part, around)) {
        has_unclear_ = has_unclear_ || is_unclear(part, around);
        continue;
      }
      is_any = true;
      ++(part.is_closed ? shells_ : open_parts_);
      for (const std::uint32_t t : part.triangles) std::swap(triangles[t][1], triangles[t][2]);
    }
    if (is_any) turned_ = std::move(triangles);
    return is_any;
  }

  /// Counts reversed shells and triangles again, after shells were reversed for a second time.
  void count_shells(const std::vector<Triangle>& before, const std::vector<Part>& parts) {
    triangles_ = 0;
    shells_ = 0;
    open_parts_ = 0;
    for (const Part& part : parts) {
      const auto reversed = static_cast<std::size_t>(std::count_if(
          part.triangles.begin(), part.triangles.end(), [&](std::uint32_t t) { return before[t] != (*turned_)[t]; }));
      const bool is_most = 2 * reversed > part.triangles.size();
      (part.is_closed ? shells_ : open_parts_) += is_most ? 1 : 0;
      triangles_ += is_most ? part.triangles.size() - reversed : reversed;
    }
  }

  /// The edges of the given mesh, without common vertices, do not show that its triangles face different ways.
  void warn_of_welded_edges() {
    if (!is_joined_ || facts_.inconsistent_edges == 0 || facts_.nonmanifold_edges > 0) return;
    warnings_.push_back(
        {WarningCode::facing,
         "the mesh has no clear inside: triangles at the same " + plural(facts_.inconsistent_edges, "edge", "edges") +
             " face different ways; weld and orient the mesh, for example with `blum clean`, or ask for no signs"});
  }

  FacingRepair finished() {
    FacingRepair out;
    out.warnings = std::move(warnings_);
    if (has_unclear_) {
      out.warnings.push_back({WarningCode::facing,
                              "the mesh has no clear inside: it is open, and a part of it faces inwards; reverse its "
                              "triangles, or ask for "
                              "no signs"});
    }
    if (!turned_ || triangles_ + shells_ + open_parts_ == 0) return out;
    out.triangles.assign(given_.triangles.begin(), given_.triangles.end());
    for (std::size_t t = 0; t < out.triangles.size(); ++t) {
      const Triangle& start = is_joined_ ? joined_[t] : given_.triangles[t];
      if ((*turned_)[t] != start) std::swap(out.triangles[t][1], out.triangles[t][2]);
    }
    out.text = text();
    return out;
  }

  [[nodiscard]] std::string text() const {
    std::string text;
    const auto add = [&](std::size_t count, const char* one, const char* many) {
      if (count > 0) text += (text.empty() ? "" : " and ") + plural(count, one, many);
    };
    add(triangles_, "triangle", "triangles");
    add(shells_, "shell", "shells");
    add(open_parts_, "part", "parts");
    return text + (triangles_ + shells_ + open_parts_ == 1 ? " was reversed" : " were reversed");
  }

  const MeshView& given_;
  const Context& context_;
  MeshView view_;  ///< the mesh that is examined
  const SiteTable* sites_;
  Orientation facts_;
  std::optional<SiteTable> own_sites_;
  std::vector<Triangle> joined_;
  std::vector<Triangle> oriented_;  ///< with consistent orientations in each part
  bool is_joined_ = false;
  std::optional<std::vector<Triangle>> turned_;  ///< triangles of the examined mesh after reversal
  std::size_t triangles_ = 0, shells_ = 0, open_parts_ = 0;
  bool has_unclear_ = false;
  std::vector<Warning> warnings_;
};

}  // namespace

FacingRepair repair_facing(const MeshView& mesh, const SiteTable& sites, const Orientation& facts,
                           FunctionRef<bool(const MeshView&)> crosses, const Context& context) {
  return Repairer(mesh, sites, facts, context).run(crosses);
}

}  // namespace blum::sign
