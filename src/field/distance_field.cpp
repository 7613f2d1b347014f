// Fields of meshes: decides the sign rule, runs the back end, settles what it leaves open.
#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "blum/core/error.hpp"
#include "blum/core/parallel.hpp"
#include "blum/field/field.hpp"
#include "blum/geometry/bvh.hpp"
#include "blum/geometry/pseudonormals.hpp"
#include "blum/geometry/topology.hpp"
#include "blum/geometry/winding_number.hpp"
#include "field/cpu/engine.hpp"
#include "field/phase_timer.hpp"
#include "field/sign_agreement.hpp"

namespace blum {
namespace {

constexpr std::size_t nodes_per_range = std::size_t{1} << 18;

void check_options(const FieldOptions& options) {
  if (options.band && !(*options.band > 0 && std::isfinite(*options.band))) {
    throw InvalidOption("the band's half-width must be positive and finite, in mesh units");
  }
  if (options.site_ids == SiteIds::voxels) {
    throw InvalidOption("voxel ids are for fields of images; a mesh has features or triangles");
  }
}

void check_site_ids(const MeshView& mesh, const FieldOptions& options) {
  if (options.site_ids == SiteIds::triangles && (!mesh.segments.empty() || !mesh.points.empty())) {
    throw InvalidOption("triangle ids were asked for, but the mesh also has segments or points: ask for features");
  }
}

/// Diagonal of the box around mesh and grid, which the precision promise refers to.
double common_diagonal(const MeshView& mesh, const GridSpec& grid) {
  Box3 box = bounds(mesh);
  box.extend(bounds(grid));
  return box.diagonal();
}

/// A sign rule before anything is computed, and why.
struct SignPlan {
  SignRule rule = SignRule::none;
  std::string reason;
  bool is_to_be_checked = false;  ///< pseudonormals were chosen by `auto`: their signs must prove to be consistent
};

std::string describe_defects(const Orientation& facts) {
  if (facts.boundary_edges + facts.nonmanifold_edges + facts.inconsistent_edges == 0) return "no triangle with an area";
  return std::to_string(facts.boundary_edges) + " boundary edges, " + std::to_string(facts.nonmanifold_edges) +
         " non-manifold edges and " + std::to_string(facts.inconsistent_edges) + " inconsistently oriented edges";
}

/// Whether a triangle is too flat for its normal to mean anything. Such triangles close cracks in many CAD meshes, and
/// leave their edges with a pseudonormal of one side only.
bool has_flat_triangles(const MeshView& mesh) {
  return std::any_of(mesh.triangles.begin(), mesh.triangles.end(), [&](const Triangle& t) {
    const Vec3d u = mesh.vertices[t[1]] - mesh.vertices[t[0]];
    const Vec3d v = mesh.vertices[t[2]] - mesh.vertices[t[0]];
    const double longest = std::max({squared_length(u), squared_length(v), squared_length(u - v)});
    return !(squared_length(cross(u, v)) > 1e-24 * longest * longest);
  });
}

SignPlan plan_automatic_sign(const MeshView& mesh, const Orientation& facts) {
  if (!mesh.segments.empty() || !mesh.points.empty()) {
    return {SignRule::winding, "winding number above 1/2: the mesh has free segments or points, which have no sides"};
  }
  if (!facts.closed || !facts.oriented) {
    return {SignRule::winding, "winding number above 1/2: the mesh has " + describe_defects(facts)};
  }
  if (!facts.outward) {
    return {SignRule::winding,
            "winding number above 1/2: the mesh is closed, but its shells do not all face away from the solid (flip an "
            "inverted mesh to get its inside)"};
  }
  if (has_flat_triangles(mesh)) {
    return {SignRule::winding, "winding number above 1/2: the mesh is closed, but has triangles too flat for a normal"};
  }
  return {SignRule::normals, "pseudonormals: the mesh is closed, consistently oriented and faces outwards", true};
}

SignPlan plan_sign(SignMode mode, const MeshView& mesh, const SiteTable& sites) {
  if (mode == SignMode::none) return {SignRule::none, "unsigned, as asked for"};
  if (mesh.triangles.empty()) {
    if (mode == SignMode::automatic) return {SignRule::none, "unsigned: there are no triangles, so there is no inside"};
    throw InvalidOption("a sign was asked for, but the mesh has no triangles, so it has no inside: ask for none");
  }
  if (mode == SignMode::winding) return {SignRule::winding, "winding number above 1/2, as asked for"};
  const Orientation facts = orientation(mesh, sites);
  const bool is_consistent = facts.closed && facts.oriented;
  if (mode == SignMode::normals) {
    if (!mesh.segments.empty() || !mesh.points.empty()) {
      throw InvalidMesh(
          "signs by normals were asked for, but the mesh has free segments or points, which have no sides: "
          "use winding");
    }
    if (!is_consistent) {
      throw InvalidMesh("signs by normals need a closed, consistently oriented mesh; this one has " +
                        describe_defects(facts) + ": use winding, or weld or repair the mesh");
    }
    return {SignRule::normals, facts.outward ? "pseudonormals, as asked for"
                                             : "pseudonormals, as asked for, of a mesh whose outer shells do not face "
                                               "outwards: flip it if the sign looks inverted"};
  }
  return plan_automatic_sign(mesh, facts);
}

/// Finishes nodes that float32 left open: exact distance and site, and the side by its pseudonormal.
void settle_nodes(const std::vector<std::size_t>& nodes, const MeshView& mesh, const SiteTable& sites, bool with_sides,
                  const Context& context, Field& field) {
  if (nodes.empty()) return;
  const Bvh bvh(mesh, sites, context);
  const std::optional<Pseudonormals> normals =
      with_sides ? std::make_optional<Pseudonormals>(mesh, sites, context) : std::nullopt;
  const GridSpec& grid = field.grid;
  parallel_for(context, nodes.size(), 256, "", [&](const WorkRange& range) {
    for (std::size_t k = range.begin; k < range.end; ++k) {
      const auto node = static_cast<std::int64_t>(nodes[k]);
      const Vec3d query =
          grid.position(node % grid.size[0], node / grid.size[0] % grid.size[1], node / (grid.size[0] * grid.size[1]));
      const std::optional<NearestSite> nearest = bvh.nearest(query);
      if (!nearest) continue;
      const bool is_inside = normals && normals->is_inside(query, nearest->point, nearest->site);
      const bool is_beyond = field.band && nearest->distance > *field.band;
      const double distance = is_beyond ? *field.band : nearest->distance;
      field.distance[nodes[k]] = static_cast<float>(is_inside ? -distance : distance);
      field.site[nodes[k]] = is_beyond ? SiteId::none() : nearest->site;
    }
  });
}

void apply_winding_sign(Field& field, const MeshView& mesh, const SiteTable& sites, const Context& context) {
  const WindingNumber winding(mesh, sites, context);
  const GridSpec& grid = field.grid;
  parallel_for(context, field.distance.size(), 4096, "sign", [&](const WorkRange& range) {
    for (std::size_t k = range.begin; k < range.end; ++k) {
      const auto node = static_cast<std::int64_t>(k);
      if (winding.is_inside(grid.position(node % grid.size[0], node / grid.size[0] % grid.size[1],
                                          node / (grid.size[0] * grid.size[1])))) {
        field.distance[k] = -field.distance[k];
      }
    }
  });
}

void drop_signs(const Context& context, Field& field) {
  parallel_for(context, field.distance.size(), nodes_per_range, "", [&](const WorkRange& range) {
    for (std::size_t node = range.begin; node < range.end; ++node)
      field.distance[node] = std::abs(field.distance[node]);
  });
}

void show_triangles(const SiteTable& sites, const Context& context, Field& field) {
  parallel_for(context, field.site.size(), nodes_per_range, "", [&](const WorkRange& range) {
    for (std::size_t node = range.begin; node < range.end; ++node) {
      const SiteId site = field.site[node];
      if (site.has_value()) field.site[node] = SiteId(sites.triangle(site).value);
    }
  });
  field.site_ids = SiteIds::triangles;
}

}  // namespace

struct FieldSolver::State {
  FieldOptions options;
  Context context;
  cpu::Engine engine;
  Field field;

  void compute(const MeshView& mesh);
};

void FieldSolver::State::compute(const MeshView& mesh) {
  validate(mesh);
  check_site_ids(mesh, options);
  throw_if_cancelled(context);
  const std::size_t nodes = field.grid.node_count();
  if (field.distance.size() != nodes) {
    field.distance = Buffer<float>(nodes);
    field.site = Buffer<SiteId>(nodes);
  }
  field.band = options.band;
  field.site_ids = SiteIds::features;
  field.phases.clear();

  PhaseTimer connectivity_timer(field.phases);
  engine.set_mesh(mesh, context);
  const SignPlan plan = plan_sign(options.sign, mesh, engine.sites());
  connectivity_timer.lap("connectivity");
  const bool with_sides = plan.rule == SignRule::normals;
  const std::vector<std::size_t> unsettled = engine.compute({field.grid, options.band, with_sides}, context, field);
  PhaseTimer sign_timer(field.phases);
  settle_nodes(unsettled, mesh, engine.sites(), with_sides, context, field);
  field.sign_rule = plan.rule;
  field.sign_reason = plan.reason;
  if (plan.rule == SignRule::winding) {
    apply_winding_sign(field, mesh, engine.sites(), context);
  } else if (plan.is_to_be_checked && !signs_agree(field, common_diagonal(mesh, field.grid), context)) {
    drop_signs(context, field);
    apply_winding_sign(field, mesh, engine.sites(), context);
    field.sign_rule = SignRule::winding;
    field.sign_reason =
        "winding number above 1/2: the mesh is closed and oriented, but its pseudonormals disagree between "
        "neighbouring nodes (it crosses itself)";
  }
  sign_timer.lap("sign");
  if (options.site_ids == SiteIds::triangles) show_triangles(engine.sites(), context, field);
}

FieldSolver::FieldSolver(const GridSpec& grid, const FieldOptions& options, const Context& context)
    : state_(std::make_unique<State>()) {
  validate(grid);
  check_options(options);
  (void)thread_count(context);
  state_->options = options;
  state_->context = context;
  state_->field.grid = grid;
}

FieldSolver::FieldSolver(FieldSolver&&) noexcept = default;
FieldSolver& FieldSolver::operator=(FieldSolver&&) noexcept = default;
FieldSolver::~FieldSolver() = default;

const Field& FieldSolver::compute(const MeshView& mesh) {
  state_->compute(mesh);
  return state_->field;
}

Field FieldSolver::take() {
  Field taken = std::move(state_->field);
  state_->field = Field{};
  state_->field.grid = taken.grid;
  return taken;
}

Field distance_field(const MeshView& mesh, const GridSpec& grid, const FieldOptions& options, const Context& context) {
  FieldSolver solver(grid, options, context);
  (void)solver.compute(mesh);
  return solver.take();
}

}  // namespace blum
