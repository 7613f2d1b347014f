#include "blum/medial_axis/medial_axis.hpp"

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <cstddef>
#include <functional>
#include <numeric>
#include <string>
#include <string_view>
#include <unordered_map>
#include <utility>
#include <vector>

#include "blum/axis/label_sheets.hpp"
#include "blum/axis/order_sheets.hpp"
#include "blum/axis/patch_numbers.hpp"
#include "blum/complex/complex.hpp"
#include "blum/complex/incidence.hpp"
#include "blum/complex/medial_columns.hpp"
#include "blum/core/check_angle.hpp"
#include "blum/core/context.hpp"
#include "blum/core/exact_text.hpp"
#include "blum/core/parts.hpp"
#include "blum/core/phase_timer.hpp"
#include "blum/geometry/sites.hpp"
#include "blum/solid/solid_warnings.hpp"
#include "medial_axis/cells/voxelize.hpp"
#include "medial_axis/fit/contract_points.hpp"
#include "medial_axis/fit/fit_axis.hpp"
#include "medial_axis/shape/axis_piece.hpp"
#include "medial_axis/surface/mesh_surface.hpp"
#include "medial_axis/surface/voxel_surface.hpp"

namespace blum {
namespace {

using detail::append;
using detail::append_at;
using detail::AxisCell;
using detail::AxisLists;
using detail::AxisPiece;
using detail::AxisVertex;
using detail::check_angle;
using detail::complex_of;
using detail::contract_points;
using detail::fit_axis;
using detail::FitTarget;
using detail::GovernorField;
using detail::label_sheets;
using detail::make_axis_piece;
using detail::MeshSurface;
using detail::NoiseFloor;
using detail::order_sheets;
using detail::PatchNumbers;
using detail::split_further;
using detail::Surface;
using detail::voxelize_body;
using detail::voxelize_by_winding;
using detail::voxelize_image;
using detail::Voxelized;
using detail::VoxelSurface;

using Pair = std::array<std::uint32_t, 2>;

/// Number of cells that are handled between two checks for cancellation. They take a few milliseconds.
constexpr std::size_t cells_between_looks = 65536;

struct HashOfPlace {
  std::size_t operator()(const Vec3d& p) const {
    std::size_t hash = 0;
    // Adding 0.0 turns -0 into 0. The numbers 0 and -0 are equal, so they must have the same hash.
    for (const double x : {p.x, p.y, p.z}) hash = (hash ^ std::hash<double>()(x + 0.0)) * 0x9e3779b97f4a7c15U;
    return hash ^ hash >> 32U;
  }
};

/// Level until which an edge exists, in degrees, and its importance.
struct Stay {
  float until = 0;
  float angle = 0;

  void extend(const Stay& other) {
    until = std::max(until, other.until);
    angle = std::max(angle, other.angle);
  }
};

class Nest {
 public:
  Nest(double least_theta, const Context& context) : least_theta_(least_theta), context_(context) {}

  void add(const AxisPiece& piece) {
    std::vector<std::uint32_t> vertex(piece.vertices.size(), 0);
    std::vector<bool> is_known(piece.vertices.size(), false);
    // Vertices are added before edges, and edges before polygons. A face exists at least as long as the cells that it
    // is a face of.
    for (int dimension = 0; dimension <= 2; ++dimension) {
      for (std::size_t c = 0; c < piece.cells.size(); ++c) {
        if (c % cells_between_looks == 0) throw_if_cancelled(context_);
        const AxisCell& cell = piece.cells[c];
        if (!is_there(cell) || cell.dimension != dimension) continue;
        const auto shape = piece.shapes[c];
        for (const std::uint32_t v : shape) {
          if (!is_known[v]) vertex[v] = vertex_at(piece.vertices[v], cell.level);
          is_known[v] = true;
        }
        for (std::size_t k = 0; dimension == 1 && k + 1 < shape.size(); ++k) {
          add_thread(vertex[shape[k]], vertex[shape[k + 1]], cell);
        }
        for (std::size_t k = 0; dimension == 2 && k < shape.size(); k += 3) {
          add_triangle({vertex[shape[k]], vertex[shape[k + 1]], vertex[shape[k + 2]]}, cell);
        }
      }
    }
  }

  Complex finish() {
    add_edges();
    Complex nested = labelled();
    set_edges(nested);
    add_level(nested.vertex_columns, medial_columns::until, std::move(vertex_until_));
    add_level(nested.edge_columns, medial_columns::from, std::move(edge_from_));
    add_level(nested.edge_columns, medial_columns::until, std::move(edge_until_));
    add_level(nested.triangle_columns, medial_columns::until, std::move(triangle_until_));
    return nested;
  }

 private:
  [[nodiscard]] bool is_there(const AxisCell& cell) const { return cell.level > least_theta_; }

  std::uint32_t vertex_at(const AxisVertex& vertex, float until) {
    const auto next = static_cast<std::uint32_t>(lists_.vertices.size());
    const auto [entry, is_new] = place_.try_emplace(vertex.position, next);
    if (is_new) {
      lists_.vertices.push_back(vertex);
      vertex_until_.push_back(until);
    } else {
      float& known = vertex_until_[entry->second];
      known = std::max(known, until);
    }
    return entry->second;
  }

  void add_thread(std::uint32_t a, std::uint32_t b, const AxisCell& cell) {
    if (a == b) return;
    threads_.push_back({a, b});
    stays_.push_back({cell.level, cell.angle});
  }

  /// Adds a triangle. If two of its corners are equal, it adds its sides instead.
  void add_triangle(const std::array<std::uint32_t, 3>& corners, const AxisCell& cell) {
    const auto& [a, b, c] = corners;
    if (a == b || b == c || c == a) {
      add_thread(a, b, cell);
      add_thread(b, c, cell);
      add_thread(c, a, cell);
      return;
    }
    lists_.add_triangle(corners, cell.angle);
    triangle_until_.push_back(cell.level);
  }

  /// Adds each pair of vertices that is an edge at some angle, once for each of its roles. The edge is a seam while it
  /// has three or more triangles, a rim while it has one, and a curve while it has none.
  void add_edges() {
    const Incidence incidence({lists_.vertices.size(), threads_, lists_.triangles}, context_);
    // All sides of triangles are also in threads_, except diagonals of polygons.
    std::vector<Stay> threads(incidence.edges().size());
    for (std::size_t t = 0; t < threads_.size(); ++t) threads[incidence.edge_of_listed()[t]].extend(stays_[t]);
    std::vector<float> untils;  // levels of the triangles at an edge, descending
    for (std::size_t e = 0; e < threads.size(); ++e) {
      untils.clear();
      float angle = 0;
      for (const std::uint32_t t : incidence.triangles_of_edge()[e]) {
        untils.push_back(triangle_until_[t]);
        angle = std::max(angle, lists_.triangle_angles[t]);
      }
      std::sort(untils.begin(), untils.end(), std::greater<>());
      const auto until_of = [&](std::size_t k) { return k < untils.size() ? untils[k] : 0; };
      const Pair& pair = incidence.edges()[e];
      add_role(pair, MedialRole::seam, angle, 0, until_of(2));
      add_role(pair, MedialRole::rim, angle, until_of(1), until_of(0));
      add_role(pair, MedialRole::curve, threads[e].angle, until_of(0), threads[e].until);
    }
  }

  void add_role(const Pair& pair, MedialRole role, float angle, float from, float until) {
    if (!(until > from)) return;
    edges_.push_back(pair);
    edge_angles_.push_back(angle);
    edge_roles_.push_back(static_cast<std::int32_t>(role));
    edge_from_.push_back(from);
    edge_until_.push_back(until);
  }

  /// Returns the complex of the least angle, with sheets and roles.
  Complex labelled() {
    for (std::size_t e = 0; e < edges_.size(); ++e) {
      const bool is_curve = edge_roles_[e] == static_cast<std::int32_t>(MedialRole::curve);
      if (is_curve && edge_from_[e] <= least_theta_) lists_.add_edge(edges_[e], edge_angles_[e]);
    }
    Complex complex = complex_of(std::move(lists_));
    label_sheets(complex, Incidence(complex.view(), context_));
    throw_if_cancelled(context_);
    return complex;
  }

  /// Replaces the edges at the least angle by the edges at all angles.
  void set_edges(Complex& nested) {
    nested.edges = std::move(edges_);
    nested.edge_columns = Columns(nested.edges.size());
    nested.edge_columns.add({std::string(medial_columns::separation_angle), 1, std::move(edge_angles_)});
    nested.edge_columns.add({std::string(medial_columns::role), 1, std::move(edge_roles_)});
  }

  static void add_level(Columns& columns, std::string_view name, std::vector<float> levels) {
    columns.add({std::string(name), 1, std::move(levels)});
  }

  double least_theta_;
  const Context& context_;
  AxisLists lists_;  ///< vertices and triangles
  std::unordered_map<Vec3d, std::uint32_t, HashOfPlace> place_;
  std::vector<float> vertex_until_, triangle_until_;
  std::vector<Pair> threads_;  ///< edges of the pieces, and sides of triangles with two equal corners
  std::vector<Stay> stays_;    ///< for each of threads_
  // Edges of the result.
  std::vector<Pair> edges_;
  std::vector<float> edge_angles_, edge_from_, edge_until_;
  std::vector<std::int32_t> edge_roles_;
};

/// Returns one complex that contains the results of append_at() and contract_points() at all angles of at least
/// `least_theta`.
/// @throws Cancelled.
Complex nest_pieces(const std::vector<AxisPiece>& pieces, double least_theta, const Context& context) {
  Nest nest(least_theta, context);
  for (const AxisPiece& piece : pieces) nest.add(piece);
  return nest.finish();
}

constexpr int least_resolution = 8;
constexpr int most_resolution = 800;
/// Noise floor of images. Voxels represent a smooth surface by steps. Without this floor, the axis would extend to the
/// edges of the steps.
constexpr NoiseFloor stairs{20, 120, 3, 3, 15, 0};

void check(const MedialAxisOptions& options) {
  const auto check_resolution = [](const char* name, int value) {
    if (value >= least_resolution && value <= most_resolution) return;
    throw InvalidOption(std::string(name) + " is " + std::to_string(value) + ", but must be " +
                        std::to_string(least_resolution) + " to " + std::to_string(most_resolution));
  };
  check_resolution("resolution", options.resolution);
  check_resolution("max_resolution", options.max_resolution);
  if (options.spacing && !(*options.spacing > 0 && std::isfinite(*options.spacing))) {
    throw InvalidOption("spacing is " + exact_text(*options.spacing) + ", but must be above 0");
  }
  if (!(options.grid_shift >= -1 && options.grid_shift <= 1)) {
    throw InvalidOption("grid_shift is " + exact_text(options.grid_shift) + " voxels, but must be -1 to 1");
  }
  check_angle("least_theta", options.least_theta);
  check_angle("greatest_theta", options.greatest_theta);
  if (options.greatest_theta < options.least_theta) {
    throw InvalidOption("greatest_theta is " + exact_text(options.greatest_theta) +
                        " degrees, but must be at least least_theta, " + exact_text(options.least_theta));
  }
  if (!(options.lambda >= 0 && std::isfinite(options.lambda))) {
    throw InvalidOption("lambda is " + exact_text(options.lambda) + ", but must be at least 0");
  }
}

double longest_side(const Box3& box) {
  return std::max({box.size().x, box.size().y, box.size().z});
}

void add(BettiNumbers& sum, const BettiNumbers& part) {
  for (std::size_t k = 0; k < 3; ++k) sum[k] += part[k];
}

/// Throws if a solid is so small relative to its coordinates that rounding leaves too few different positions.
void check_place(const Box3& box) {
  // Relative to the largest coordinate. In smaller solids, rounding errors look like corners.
  constexpr double least_size = 5e-7;
  const Vec3d furthest = max(max(box.lower, box.upper), max(-1.0 * box.lower, -1.0 * box.upper));
  const double coordinate = std::max({furthest.x, furthest.y, furthest.z});
  const double size = longest_side(box);
  if (!(size > 0 && size < least_size * coordinate)) return;
  throw InvalidMesh("the mesh is " + exact_text(size) + " long, with coordinates of up to " + exact_text(coordinate) +
                    ", which leaves too few digits: move it towards the origin");
}

/// Returns true if a failure of the model, for example at a needle, would also occur with smaller voxels.
/// @param smaller  smallest allowed side of a voxel, as a fraction of the present one.
bool stays_stuck(const BodyReport& report, double smaller) {
  return std::any_of(report.failures.begin(), report.failures.end(),
                     [&](const ModelFailure& failure) { return failure.cuts * smaller > ModelFailure::most_cuts; });
}

InvalidMesh without_interior(const Solid& solid, double spacing) {
  if (solid.rule() == SolidRule::polyhedron) return InvalidMesh("the mesh has no interior");
  return InvalidMesh("the mesh has no interior: no winding number above 1/2 was found with voxels of " +
                     exact_text(spacing) + (solid.faces_inwards() ? "; its triangles face inwards: flip them" : ""));
}

}  // namespace

namespace {

/// Surface of a body, to which the borders of its axis are fitted.
struct BodySurface {
  Solid solid;  ///< shares its data with the solid of the axis
  const SolidBody* body;
  SiteTable sites;
  MeshSurface surface;

  BodySurface(Solid own, const SolidBody& of, bool bounds_solid, const Context& context)
      : solid(std::move(own)), body(&of), sites(of.mesh, context), surface(of.mesh, sites, bounds_solid, context) {}

  [[nodiscard]] SiteId input_site(SiteId site) const { return body->input_site(site, sites, solid.sites()); }
};

}  // namespace

struct MedialAxis::Data {
  MedialAxisReport report;
  std::vector<AxisPiece> pieces;
  std::vector<std::unique_ptr<BodySurface>> surfaces;  ///< for each piece of a polyhedron; empty for other solids
  PatchNumbers patches;
  double least_theta = 0;
  double greatest_theta = 180;
  double lambda = 0;

  /// Axis at an angle, fitted to the surfaces of a polyhedron.
  struct Fitted {
    AxisLists lists;
    std::size_t vertices_before = 0;
    double moved = 0;  ///< mesh units: greatest distance that sheets were moved when vertices were removed
  };
  /// @param tolerance  FitTarget::tolerance
  [[nodiscard]] Fitted fitted(double theta, double tolerance, const Context& context) const {
    std::vector<AxisLists> parts(pieces.size());
    std::vector<std::size_t> sizes(parts.size());
    std::vector<double> moved(parts.size(), 0);
    for (std::size_t p = 0; p < parts.size(); ++p) {
      append_at(pieces[p], theta, parts[p], context);
      sizes[p] = parts[p].vertices.size();
    }
    detail::for_each_part(context, sizes, "borders", [&](std::size_t p, const Context& own) {
      const BodySurface& known = *surfaces[p];
      const auto input_site = [&](SiteId site) { return known.input_site(site); };
      const FitTarget target{known.surface, input_site, report.bodies[p].spacing, std::max(theta, NoiseFloor{}.angle),
                             tolerance};
      moved[p] = fit_axis(parts[p], target, own);
    });
    Fitted out;
    for (AxisLists& part : parts) append(std::move(part), out.lists);
    out.vertices_before = std::accumulate(sizes.begin(), sizes.end(), std::size_t{0});
    out.moved = *std::max_element(moved.begin(), moved.end());
    return out;
  }

  /// Returns the complex of the given lists, with sheets and roles.
  [[nodiscard]] Complex labelled(AxisLists lists, const Context& context) const {
    Complex complex = complex_of(std::move(lists));
    Incidence incidence(complex.view(), context);
    if (contract_points(complex, incidence)) incidence = Incidence(complex.view(), context);
    throw_if_cancelled(context);
    label_sheets(complex, incidence);
    order_sheets(complex, patches);
    return complex;
  }
};

/// Makes the pieces of an axis: one for each body of a mesh, or one for an image.
class MedialAxisBuilder {
 public:
  MedialAxisBuilder(const MedialAxisOptions& options, const Context& context)
      : options_(options), context_(context), data_(std::make_unique<MedialAxis::Data>()) {
    check(options);
    data_->least_theta = options.least_theta;
    data_->greatest_theta = options.greatest_theta;
    data_->lambda = options.lambda;
  }

  MedialAxis of(const Solid& solid) {
    report().rule = solid.rule();
    report().reason = solid.reason();
    report().reversed_shells = solid.reversed_shells();
    report().warnings = reversal_warnings(solid.reversed_triangles(), solid.reversed_shells());
    if (solid.rule() == SolidRule::winding) {
      report().warnings.emplace_back(WarningCode::solid_of_voxels, solid.reason() + ", as voxels");
    }
    check_place(solid.box());
    check_lengths(solid.box());
    if (solid.rule() == SolidRule::voxels) {
      add_voxels(solid);
    } else {
      const double spacing = options_.spacing.value_or(longest_side(solid.box()) / options_.resolution);
      if (!(spacing > 0)) throw InvalidMesh("the mesh is a single point, so it has no interior");
      data_->patches = PatchNumbers(solid.sites());
      add_bodies(solid, spacing);
      data_->patches.choose_anchors();
    }
    return finish();
  }

  /// Returns the axis of the solid that make() returns. The time of make() is reported as the phase `phase`.
  template <class Make>
  MedialAxis of(const Make& make, const char* phase) {
    PhaseTimer timer(report().phases);
    const Solid solid = make();
    timer.lap(phase);
    return of(solid);
  }

 private:
  MedialAxisReport& report() { return data_->report; }

  /// Throws if an option is a length above the diagonal of the solid. No cell of the axis would be left.
  void check_lengths(const Box3& box) const {
    const double diagonal = box.diagonal();
    const auto check_length = [&](const char* name, double length) {
      if (length <= diagonal || !(diagonal > 0)) return;
      throw InvalidOption(std::string(name) + " is " + exact_text(length) +
                          ", but must be at most the diagonal of the solid, " + exact_text(diagonal));
    };
    check_length("lambda", options_.lambda);
    check_length("spacing", options_.spacing.value_or(0));
  }

  /// Returns a model of a body with voxels small enough for its topology. If the options do not allow such voxels, it
  /// returns the model with the smallest voxels tried.
  [[nodiscard]] Voxelized voxelize(const SolidBody& body, double spacing, const Context& context) const {
    const bool is_polyhedron = data_->report.rule == SolidRule::polyhedron;
    const double finest = longest_side(bounds(body.mesh)) / options_.max_resolution;
    while (true) {
      Voxelized out = is_polyhedron ? voxelize_body(body, spacing, context, options_.grid_shift)
                                    : voxelize_by_winding(body.mesh, spacing, context, options_.grid_shift);
      const bool is_done = out.report.topology_matches && out.report.voxels + out.report.extra_cells > 0;
      if (is_done || !(spacing > finest * (1 + 1e-9)) || stays_stuck(out.report, finest / spacing)) return out;
      spacing = std::max(0.5 * spacing, finest);
    }
  }

  void add_voxels(const Solid& solid) {
    std::array<std::int64_t, 3> first{};
    PhaseTimer timer(report().phases);
    Voxelized voxelized = voxelize_image(solid.voxels(), solid.grid(), first, context_);
    timer.lap("voxels");
    const VoxelSurface surface(voxelized.solid.voxels, voxelized.solid.grid);
    AxisPiece piece = make_piece(voxelized, surface, stairs, report().phases, context_);
    const GridSpec& grid = solid.grid();
    const auto input_site = [&](SiteId own) {
      std::array<std::int64_t, 3> at = voxelized.solid.voxels.place(own.value);
      for (std::size_t a = 0; a < 3; ++a) {
        at[a] = std::clamp(at[a] + first[a], std::int64_t{0}, grid.size[a] - 1);
      }
      return SiteId(static_cast<std::uint32_t>(grid.index(at[0], at[1], at[2])));
    };
    for (AxisVertex& vertex : piece.vertices) {
      for (SiteId& site : vertex.sites) site = input_site(site);
    }
    add_piece(voxelized, std::move(piece));
  }

  /// Results for one body.
  struct BodyPart {
    Voxelized voxelized;  ///< If it has no voxels and no extra cells, the other members are empty.
    std::unique_ptr<BodySurface> surface;
    AxisPiece piece;
    std::vector<PhaseTime> phases;

    [[nodiscard]] bool is_empty() const { return voxelized.report.voxels + voxelized.report.extra_cells == 0; }
  };

  void add_bodies(const Solid& solid, double spacing) {
    const auto& bodies = solid.bodies();
    std::vector<std::size_t> sizes;
    for (const SolidBody& body : bodies) sizes.push_back(voxels_around(body, spacing));
    std::vector<BodyPart> parts(bodies.size());
    const auto start = std::chrono::steady_clock::now();
    detail::for_each_part(context_, sizes, "bodies", [&](std::size_t b, const Context& context) {
      parts[b] = make_part(solid, bodies[b], spacing, context);
    });
    const std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - start;
    add_phases(parts, seconds.count());
    for (std::size_t b = 0; b < parts.size(); ++b) add_part(solid, bodies[b], std::move(parts[b]));
  }

  /// Returns the approximate number of voxels in the box of a body.
  [[nodiscard]] static std::size_t voxels_around(const SolidBody& body, double spacing) {
    constexpr double most = 1e15;
    const Vec3d size = bounds(body.mesh).size() / spacing;
    return static_cast<std::size_t>(std::min((size.x + 1) * (size.y + 1) * (size.z + 1), most));
  }

  [[nodiscard]] BodyPart make_part(const Solid& solid, const SolidBody& body, double spacing,
                                   const Context& context) const {
    BodyPart part;
    PhaseTimer timer(part.phases);
    part.voxelized = voxelize(body, spacing, context);
    timer.lap("field and voxels");
    if (part.is_empty()) return part;
    part.surface = std::make_unique<BodySurface>(solid, body, data_->report.rule == SolidRule::polyhedron, context);
    timer.lap("surface");
    part.piece = make_piece(part.voxelized, part.surface->surface, NoiseFloor{}, part.phases, context);
    split_where_left(part, body, context);
    for (AxisVertex& vertex : part.piece.vertices) {
      for (SiteId& site : vertex.sites) site = part.surface->input_site(site);
    }
    return part;
  }

  /// Splits the model of a body in the boxes where cells of its axis leave the solid, and computes the axis again.
  /// Cells in smaller boxes have fewer obstacles.
  void split_where_left(BodyPart& part, const SolidBody& body, const Context& context) const {
    constexpr int most_rounds = 6;
    if (!part.voxelized.report.topology_matches) return;
    std::vector<Box3> finer;
    for (int round = 0; round < most_rounds && !part.piece.leaving.empty(); ++round) {
      finer.insert(finer.end(), part.piece.leaving.begin(), part.piece.leaving.end());
      PhaseTimer timer(part.phases);
      split_further(part.voxelized, body, finer, context);
      timer.lap("field and voxels");
      part.piece = make_piece(part.voxelized, part.surface->surface, NoiseFloor{}, part.phases, context);
    }
  }

  /// Adds the phases of all bodies to the report. If bodies are computed in parallel, the sum of their times exceeds
  /// the elapsed time `seconds`. In this case, all times are scaled so that their sum is `seconds`.
  void add_phases(const std::vector<BodyPart>& parts, double seconds) {
    double all = 0;
    for (const BodyPart& part : parts) {
      for (const PhaseTime& phase : part.phases) all += phase.seconds;
    }
    for (const BodyPart& part : parts) {
      for (const PhaseTime& phase : part.phases) {
        report().phases.push_back({phase.phase, all > seconds ? phase.seconds * seconds / all : phase.seconds});
      }
    }
  }

  void add_part(const Solid& solid, const SolidBody& body, BodyPart part) {
    if (part.is_empty()) throw without_interior(solid, part.voxelized.report.spacing);
    PhaseTimer timer(report().phases);
    const SiteTable& own = part.surface->sites;
    data_->patches.add({body.mesh, body.triangle_of, body.vertex_of,
                        [&](SiteId site) { return body.input_site(site, own, solid.sites()); }},
                       own, context_);
    timer.lap("surface");
    add_piece(part.voxelized, std::move(part.piece));
    if (report().rule == SolidRule::polyhedron) data_->surfaces.push_back(std::move(part.surface));
  }

  [[nodiscard]] AxisPiece make_piece(const Voxelized& voxelized, const Surface& surface, NoiseFloor floor,
                                     std::vector<PhaseTime>& phases, const Context& context) const {
    floor.lambda = options_.lambda;
    floor.angle = std::max(floor.angle, options_.least_theta);
    return make_axis_piece(GovernorField(voxelized.solid, surface), floor, options_.greatest_theta, phases, context);
  }

  void add_piece(const Voxelized& voxelized, AxisPiece piece) {
    data_->pieces.push_back(std::move(piece));
    if (report().bodies.empty()) report().grid = voxelized.solid.grid;
    report().bodies.push_back(voxelized.report);
  }

  MedialAxis finish() {
    for (const BodyReport& body : report().bodies) add(report().betti, body.betti);
    report().topology_matches = std::all_of(report().bodies.begin(), report().bodies.end(),
                                            [](const BodyReport& body) { return body.topology_matches; });
    return MedialAxis(std::move(data_));
  }

  const MedialAxisOptions& options_;
  const Context& context_;
  std::unique_ptr<MedialAxis::Data> data_;
};

MedialAxis::MedialAxis(std::unique_ptr<Data> data) : data_(std::move(data)) {}
MedialAxis::MedialAxis(MedialAxis&&) noexcept = default;
MedialAxis& MedialAxis::operator=(MedialAxis&&) noexcept = default;
MedialAxis::~MedialAxis() = default;

const MedialAxisReport& MedialAxis::report() const {
  return data_->report;
}

void MedialAxis::check_theta(double theta) const {
  if (theta >= data_->least_theta && theta <= data_->greatest_theta) return;
  throw InvalidOption("theta is " + exact_text(theta) + " degrees, but must be " + exact_text(data_->least_theta) +
                      " to " + exact_text(data_->greatest_theta));
}

Complex MedialAxis::simplify(double theta, const Context& context) const {
  check_theta(theta);
  AxisLists lists;
  for (const AxisPiece& piece : data_->pieces) append_at(piece, theta, lists, context);
  return data_->labelled(std::move(lists), context);
}

Complex MedialAxis::fitted(double theta, const Context& context) const {
  check_theta(theta);
  if (data_->surfaces.empty()) return simplify(theta, context);
  return data_->labelled(data_->fitted(theta, 0, context).lists, context);
}

DecimatedAxis MedialAxis::lean(double theta, double tolerance, const Context& context) const {
  check_theta(theta);
  if (data_->surfaces.empty() || !(tolerance > 0)) return decimate(fitted(theta, context), tolerance, context);
  Data::Fitted fitted = data_->fitted(theta, tolerance, context);
  const Complex whole = data_->labelled(std::move(fitted.lists), context);
  DecimatedAxis lean = decimate(whole, tolerance - fitted.moved, context);
  lean.deviation += fitted.moved;
  lean.vertices_before = fitted.vertices_before;
  return lean;
}

double MedialAxis::lambda() const {
  return data_->lambda;
}

double MedialAxis::least_theta() const {
  return data_->least_theta;
}

double MedialAxis::greatest_theta() const {
  return data_->greatest_theta;
}

Complex MedialAxis::nested(const Context& context) const {
  check_theta(180);
  Complex nested = nest_pieces(data_->pieces, data_->least_theta, context);
  order_sheets(nested, data_->patches);
  return nested;
}

MedialAxis medial_axis(const Solid& solid, const MedialAxisOptions& options, const Context& context) {
  return MedialAxisBuilder(options, context).of(solid);
}

MedialAxis medial_axis(const MeshView& mesh, const MedialAxisOptions& options, const Context& context) {
  MedialAxisBuilder builder(options, context);  // checks the options before anything is computed
  return builder.of([&] { return Solid::of(mesh, context); }, "bodies");
}

MedialAxis medial_axis(const VoxelImageView& image, const MedialAxisOptions& options, const Context& context) {
  MedialAxisBuilder builder(options, context);
  return builder.of([&] { return Solid::of(image, options.selection, context); }, "voxels");
}

}  // namespace blum
