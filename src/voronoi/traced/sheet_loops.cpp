#include "voronoi/traced/sheet_loops.hpp"

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <numbers>
#include <utility>

#include "voronoi/label_geometry.hpp"
#include "voronoi/traced/local_star.hpp"
#include "voronoi/traced/seam_tracer.hpp"
#include "voronoi/traced/trace_problem.hpp"

namespace blum::voronoi {
namespace {

using Curve = TracedStructure::Curve;

/// A wall beside a curve, at one of the curve's ends.
struct GermEnd {
  std::uint32_t curve = 0;
  std::size_t slot = 0;           ///< twice the number of the wall, plus the end
  Vec3d ray;                      ///< direction of the curve away from the end
  TracedSites::Index before = 0;  ///< region clockwise of the wall, as seen from the tip of the ray
  TracedSites::Index after = 0;
  Vec3d direction;  ///< of the wall, across the ray
};

class Linker {
 public:
  Linker(const TracedSites& sites, const TracedStructure& structure)
      : sites_(sites), structure_(structure), tracer_(sites, work_), ends_(structure.junctions.size()) {
    for (std::uint32_t c = 0; c < structure.curves.size(); ++c) {
      for (std::uint32_t g = 0; g < structure.curves[c].ring.germs.size(); ++g) owners_.push_back({c, g});
    }
    link_.resize(2 * owners_.size());
  }

  SheetLoops run() {
    std::size_t first = 0;
    for (std::uint32_t c = 0; c < structure_.curves.size(); ++c) {
      add_ends(c, first);
      first += structure_.curves[c].ring.germs.size();
    }
    for (std::size_t j = 0; j < ends_.size(); ++j) link(ends_[j], structure_.junctions[j].at);
    for (std::size_t k = 0; k < link_.size(); ++k) {
      if (link_[link_[k]] == k) continue;
      const Curve& curve = structure_.curves[owners_[k / 2].curve];
      throw TraceProblem{"walls at a junction do not match", structure_.junctions[curve.ends[k % 2]].at};
    }
    return loops();
  }

 private:
  void add_ends(std::uint32_t number, std::size_t first) {
    const Curve& curve = structure_.curves[number];
    for (const std::uint32_t end : {0U, 1U}) {
      const Vec3d& at = end == 0 ? curve.points.front() : curve.points.back();
      const Vec3d& next = point_next_to(curve, end, sites_.tolerance());
      const bool is_at_vertex = structure_.junctions[curve.ends[end]].vertex != TracedStructure::none;
      const Vec3d ray = is_at_vertex ? unit(next - at) : curve.directions[end];
      const RegionRing there = curve.is_edge ? curve.ring : ring_near(curve, at, next, ray);
      for (std::uint32_t g = 0; g < curve.ring.germs.size(); ++g) {
        const RegionRing::Germ& germ = curve.ring.germs[g];
        GermEnd found{number,     2 * (first + g) + end,
                      ray,        germ.before,
                      germ.after, curve.is_edge ? germ.direction : direction_in(there, germ, at)};
        if (end == 1) std::swap(found.before, found.after);
        ends_[curve.ends[end]].push_back(found);
      }
    }
  }

  /// Returns the regions around a seam close to its end, but not at it: there, other sites are as close.
  [[nodiscard]] RegionRing ring_near(const Curve& curve, const Vec3d& at, const Vec3d& next, const Vec3d& ray) const {
    Vec3d x = at + 0.5 * (next - at);
    if (const auto found = tracer_.point_in_plane(curve.curve, x, ray)) x = *found;
    Vec3d along = tracer_.tangent(curve.curve, x);
    if (dot(along, ray) < 0) along = -along;
    return LocalStar(sites_, x, curve.curve.sites).ray(along).ring;
  }

  static const Vec3d& direction_in(const RegionRing& ring, const RegionRing::Germ& germ, const Vec3d& at) {
    for (const RegionRing::Germ& other : ring.germs) {
      if ((other.before == germ.before && other.after == germ.after) ||
          (other.before == germ.after && other.after == germ.before)) {
        return other.direction;
      }
    }
    throw TraceProblem{"the regions around a seam change near its end", at};
  }

  /// Links the walls at a junction. A wall's partner lies at the next ray in the direction of the wall.
  void link(const std::vector<GermEnd>& at, const Vec3d& place) {
    for (const GermEnd& own : at) {
      const GermEnd* best = nullptr;
      double least = std::numeric_limits<double>::infinity();
      for (const GermEnd& other : at) {
        if (other.before != own.after || other.after != own.before) continue;
        if (other.curve == own.curve && other.slot % 2 == own.slot % 2) continue;
        double angle = std::atan2(dot(other.ray, own.direction), dot(other.ray, own.ray));
        if (angle <= 0) angle += 2 * std::numbers::pi;
        if (angle >= least) continue;
        least = angle;
        best = &other;
      }
      if (best == nullptr) throw TraceProblem{"a sheet has no boundary beyond a junction", place};
      link_[own.slot] = best->slot;
    }
  }

  SheetLoops loops() const {
    SheetLoops out;
    std::vector<bool> is_done(owners_.size(), false);
    for (std::size_t k = 0; k < owners_.size(); ++k) {
      if (is_done[k]) continue;
      const RegionRing::Germ& germ = structure_.curves[owners_[k].curve].ring.germs[owners_[k].germ];
      TracedStructure::Sheet sheet{germ.before, germ.after, {{}}};
      if (sites_[sheet.first].number > sites_[sheet.second].number) std::swap(sheet.first, sheet.second);
      std::vector<SeamGraph::Side>& sides = out.sides.emplace_back();
      std::size_t at = 2 * k;  // the start of the curve
      do {
        const SeamGraph::Side& side = owners_[at / 2];
        is_done[at / 2] = true;
        sheet.loops.front().push_back({side.curve, at % 2 == 0});
        sides.push_back(side);
        at = link_[at ^ 1U];
      } while (at != 2 * k && sides.size() <= owners_.size());
      out.sheets.push_back(std::move(sheet));
    }
    return out;
  }

  const TracedSites& sites_;
  const TracedStructure& structure_;
  TraceWork work_;
  const SeamTracer tracer_;
  std::vector<std::vector<GermEnd>> ends_;  ///< at each junction
  std::vector<SeamGraph::Side> owners_;     ///< all walls beside curves
  std::vector<std::size_t> link_;           ///< partners, by GermEnd::slot
};

}  // namespace

SheetLoops sheet_loops(const TracedSites& sites, const TracedStructure& structure) {
  return Linker(sites, structure).run();
}

}  // namespace blum::voronoi
