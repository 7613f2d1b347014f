#include "blum/medial_axis/medial_axis.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <numeric>
#include <string>
#include <utility>

#include "blum/complex/incidence.hpp"
#include "blum/core/exact_text.hpp"
#include "blum/core/parts.hpp"
#include "blum/core/phase_timer.hpp"
#include "blum/geometry/sites.hpp"
#include "medial_axis/shape/axis_piece.hpp"
#include "blum/axis/check_angle.hpp"
#include "medial_axis/fit/contract_points.hpp"
#include "medial_axis/fit/fit_axis.hpp"
#include "blum/axis/label_sheets.hpp"
#include "medial_axis/surface/mesh_surface.hpp"
#include "medial_axis/shape/nest_pieces.hpp"
#include "blum/axis/order_sheets.hpp"
#include "blum/axis/patch_numbers.hpp"
#include "medial_axis/surface/voxel_surface.hpp"
#include "medial_axis/cells/voxelize.hpp"

namespace blum {
namespace {

constexpr int least_resolution = 8;
constexpr int most_resolution = 800;
/// What a grid of voxels makes of a smooth surface: steps whose edges the axis would reach out for.
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

/// Throws where rounding of coordinates leaves a solid too few places to lie in.
void check_place(const Box3& box) {
  constexpr double least_size = 5e-7;  // of the largest coordinate: with less, roundings look like corners
  const Vec3d furthest = max(max(box.lower, box.upper), max(-1.0 * box.lower, -1.0 * box.upper));
  const double coordinate = std::max({furthest.x, furthest.y, furthest.z});
  const double size = longest_side(box);
  if (!(size > 0 && size < least_size * coordinate)) return;
  throw InvalidMesh("the mesh is " + exact_text(size) + " long, with coordinates of up to " + exact_text(coordinate) +
                    ", which leave it too few digits: move it towards the origin");
}

/// Whether a needle keeps the model from passing with smaller voxels, too.
/// @param smaller  the least part of a voxel's side.
bool stays_stuck(const BodyReport& report, double smaller) {
  return std::any_of(report.failures.begin(), report.failures.end(),
                     [&](const ModelFailure& failure) { return failure.cuts * smaller > ModelFailure::most_cuts; });
}

InvalidMesh without_interior(const Solid& solid, double spacing) {
  if (solid.rule() == SolidRule::polyhedron) return InvalidMesh("the mesh has no interior");
  return InvalidMesh("the mesh has no interior: no winding number above 1/2 shows at voxels of " + exact_text(spacing) +
                     (solid.faces_inwards() ? "; its triangles face inwards: flip them" : ""));
}

}  // namespace

namespace {

/// The surface of a body of a polyhedron, which borders of its axis are fitted to.
struct BodySurface {
  Solid solid;  ///< shares what it holds
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
  std::vector<std::unique_ptr<BodySurface>> surfaces;  ///< of the pieces of a polyhedron
  PatchNumbers patches;
  double least_theta = 0;
  double greatest_theta = 180;
  double lambda = 0;

  /// An axis at an angle, fitted to the surfaces of a polyhedron.
  struct Fitted {
    AxisLists lists;
    std::size_t vertices_before = 0;
    double moved = 0;  ///< insides of sheets, at most, mesh units
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

  /// The complex of lists, with sheets and roles.
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

/// Makes the pieces of an axis one after the other.
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

  /// The axis of the solid that make() finds, which counts as a phase.
  template <class Make>
  MedialAxis of(const Make& make, const char* phase) {
    PhaseTimer timer(report().phases);
    const Solid solid = make();
    timer.lap(phase);
    return of(solid);
  }

 private:
  MedialAxisReport& report() { return data_->report; }

  /// Throws where options are lengths that the solid does not have: nothing of its axis would be told.
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

  /// Voxels fine enough for the topology of a body, if any are that the options allow.
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

  /// What is made of one body.
  struct BodyPart {
    Voxelized voxelized;  ///< without voxels nothing else was made
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

  /// About how many voxels the box of a body holds.
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

  /// Makes the model of a body finer where cells of its axis leave the solid, and the axis anew: in smaller boxes there
  /// is less for them to run around.
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

  /// Bodies that were made side by side tell more seconds together than went by.
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
    data_->patches.add(body, part.surface->sites, solid.sites(), context_);
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
