#include "blum/medial_axis/medial_axis.hpp"

#include <algorithm>
#include <cmath>
#include <string>

#include "blum/core/exact_text.hpp"
#include "blum/field/phase_timer.hpp"
#include "blum/geometry/sites.hpp"
#include "medial_axis/axis_piece.hpp"
#include "medial_axis/contract_points.hpp"
#include "medial_axis/label_sheets.hpp"
#include "medial_axis/mesh_surface.hpp"
#include "medial_axis/nest_pieces.hpp"
#include "medial_axis/solid_bodies.hpp"
#include "medial_axis/voxel_surface.hpp"
#include "medial_axis/voxelize.hpp"

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
  if (!(options.least_theta >= 0 && options.least_theta <= 180)) {
    throw InvalidOption("least_theta is " + exact_text(options.least_theta) + " degrees, but must be 0 to 180");
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

}  // namespace

struct MedialAxis::Data {
  MedialAxisReport report;
  std::vector<AxisPiece> pieces;
  double least_theta = 0;
};

/// Makes the pieces of an axis one after the other.
class MedialAxisBuilder {
 public:
  MedialAxisBuilder(const MedialAxisOptions& options, const Context& context)
      : options_(options), context_(context), data_(std::make_unique<MedialAxis::Data>()) {
    check(options);
    data_->least_theta = options.least_theta;
  }

  MedialAxis of_mesh(const MeshView& mesh) {
    validate(mesh);
    PhaseTimer timer(report().phases);
    const SiteTable sites(mesh, context_);
    const SolidBodies split = split_into_bodies(mesh, sites, context_);
    report().rule = split.rule;
    report().reason = split.reason;
    report().turned_shells = split.turned_shells;
    timer.lap("bodies");
    const double spacing = options_.spacing.value_or(longest_side(bounds(mesh)) / options_.resolution);
    if (!(spacing > 0)) throw InvalidMesh("the mesh is a single point, so it has no interior");
    for (const SolidBody& body : split.bodies) add_body(body, sites, spacing);
    return finish();
  }

  MedialAxis of_image(const VoxelImageView& image) {
    report().rule = SolidRule::voxels;
    report().reason = "the solid is the union of the selected voxels";
    std::array<std::int64_t, 3> first{};
    PhaseTimer timer(report().phases);
    Voxelized voxelized = voxelize_image(image, options_.selection, first, context_);
    timer.lap("voxels");
    const VoxelSurface surface(voxelized.solid.voxels, voxelized.solid.grid);
    AxisPiece& piece = add_piece(voxelized, surface, stairs);
    const auto input_site = [&](SiteId own) {
      std::array<std::int64_t, 3> at = voxelized.solid.voxels.place(own.value);
      for (std::size_t a = 0; a < 3; ++a) {
        at[a] = std::clamp(at[a] + first[a], std::int64_t{0}, image.grid.size[a] - 1);
      }
      return SiteId(static_cast<std::uint32_t>(image.grid.index(at[0], at[1], at[2])));
    };
    for (MedialVertex& vertex : piece.vertices) {
      for (SiteId& site : vertex.sites) site = input_site(site);
    }
    return finish();
  }

 private:
  MedialAxisReport& report() { return data_->report; }

  /// Voxels fine enough for the topology of a body, if any are that the options allow.
  [[nodiscard]] Voxelized voxelize(const SolidBody& body, double spacing) const {
    const bool is_polyhedron = data_->report.rule == SolidRule::polyhedron;
    const double finest = longest_side(bounds(body.mesh)) / options_.max_resolution;
    while (true) {
      Voxelized out =
          is_polyhedron ? voxelize_body(body, spacing, context_) : voxelize_by_winding(body.mesh, spacing, context_);
      const bool is_done = out.report.is_right && out.report.voxel_count > 0;
      if (is_done || !(spacing > finest * (1 + 1e-9))) return out;
      spacing = std::max(0.5 * spacing, finest);
    }
  }

  void add_body(const SolidBody& body, const SiteTable& input_sites, double spacing) {
    PhaseTimer timer(report().phases);
    Voxelized voxelized = voxelize(body, spacing);
    timer.lap("field and voxels");
    if (voxelized.report.voxel_count == 0) {
      throw InvalidMesh(report().rule == SolidRule::polyhedron
                            ? "the mesh has no interior"
                            : "the mesh has no interior: no winding number above 1/2 shows at voxels of " +
                                  exact_text(voxelized.report.spacing));
    }
    const SiteTable sites(body.mesh, context_);
    const MeshSurface surface(body.mesh, sites, report().rule == SolidRule::polyhedron, context_);
    timer.lap("surface");
    AxisPiece& piece = add_piece(voxelized, surface, NoiseFloor{});
    for (MedialVertex& vertex : piece.vertices) {
      for (SiteId& site : vertex.sites) site = body.input_site(site, sites, input_sites);
    }
  }

  AxisPiece& add_piece(const Voxelized& voxelized, const Surface& surface, NoiseFloor floor) {
    floor.lambda = options_.lambda;
    floor.angle = std::max(floor.angle, options_.least_theta);
    const GovernorField governors(voxelized.solid, surface);
    data_->pieces.push_back(make_axis_piece(governors, floor, report().phases, context_));
    if (report().bodies.empty()) report().grid = voxelized.solid.grid;
    report().bodies.push_back(voxelized.report);
    return data_->pieces.back();
  }

  MedialAxis finish() {
    for (const BodyReport& body : report().bodies) {
      add(report().solid, body.solid);
      add(report().voxels, body.voxels);
    }
    report().is_right = std::all_of(report().bodies.begin(), report().bodies.end(),
                                    [](const BodyReport& body) { return body.is_right; });
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

MedialComplex MedialAxis::extract(double theta) const {
  if (!(theta >= data_->least_theta && theta <= 180)) {
    throw InvalidOption("theta is " + exact_text(theta) + " degrees, but must be " + exact_text(data_->least_theta) +
                        " to 180");
  }
  MedialComplex complex;
  for (const AxisPiece& piece : data_->pieces) append_at(piece, theta, complex);
  contract_points(complex);
  label_sheets(complex);
  return complex;
}

NestedComplex MedialAxis::nested() const {
  return nest_pieces(data_->pieces, data_->least_theta);
}

MedialAxis medial_axis(const MeshView& mesh, const MedialAxisOptions& options, const Context& context) {
  return MedialAxisBuilder(options, context).of_mesh(mesh);
}

MedialAxis medial_axis(const VoxelImageView& image, const MedialAxisOptions& options, const Context& context) {
  return MedialAxisBuilder(options, context).of_image(image);
}

std::string_view to_string(SolidRule rule) {
  switch (rule) {
    case SolidRule::polyhedron:
      return "polyhedron";
    case SolidRule::winding:
      return "winding";
    case SolidRule::voxels:
      return "voxels";
  }
  return "unknown";
}

}  // namespace blum
