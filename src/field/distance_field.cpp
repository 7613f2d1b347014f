// Fields of meshes: decides the sign rule, runs the back end, settles what it leaves open.
#include <algorithm>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "blum/core/error.hpp"
#include "blum/core/parallel.hpp"
#include "blum/field/field.hpp"
#include "blum/field/phase_timer.hpp"
#include "blum/geometry/bvh.hpp"
#include "blum/geometry/pseudonormals.hpp"
#include "field/backend.hpp"
#include "field/field_options.hpp"
#include "field/sign.hpp"
#include "field/sign_scan.hpp"

namespace blum {
namespace {

constexpr std::size_t nodes_per_range = std::size_t{1} << 18;

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

/// Negates the distances of nodes whose closest site, as the field has it, faces away from them.
/// @return  nodes without a site, rising.
std::vector<std::size_t> tell_sides(const MeshView& mesh, const SiteTable& sites, const Context& context,
                                    Field& field) {
  const Pseudonormals normals(mesh, sites, context);
  const GridSpec& grid = field.grid;
  const auto per_slice = static_cast<std::size_t>(grid.size[0] * grid.size[1]);
  std::vector<std::vector<std::size_t>> open(static_cast<std::size_t>(grid.size[2]));
  parallel_for(context, open.size(), 1, "", [&](const WorkRange& range) {
    for (std::size_t slice = range.begin; slice < range.end; ++slice) {
      for (std::size_t k = 0; k < per_slice; ++k) {
        const std::size_t node = slice * per_slice + k;
        const SiteId site = field.site[node];
        if (!site.has_value()) {
          open[slice].push_back(node);
          continue;
        }
        const auto at = static_cast<std::int64_t>(k);
        const Vec3d query = grid.position(at % grid.size[0], at / grid.size[0], static_cast<std::int64_t>(slice));
        // A site's normal is perpendicular to it, so that any of its points will do.
        const auto corner = static_cast<std::size_t>(sites.vertices(site)[0]);
        if (normals.is_inside(query, mesh.vertices[corner], site)) field.distance[node] = -field.distance[node];
      }
    }
  });
  std::vector<std::size_t> all;
  for (const auto& part : open) all.insert(all.end(), part.begin(), part.end());
  return all;
}

/// Signs an unsigned field by winding numbers: counted along rows where they are whole, else summed.
void sign_by_winding(const MeshView& mesh, const SiteTable& sites, const Context& context, Field& field) {
  if (is_balanced(mesh, sites)) {
    if (const std::optional<SignScan> scan = SignScan::make(mesh, field.grid, context)) {
      (void)scan->apply(field, 0, context);
      return;
    }
  }
  (void)apply_winding_sign(field, mesh, sites, context);
}

void invert_signs(const Context& context, Field& field) {
  parallel_for(context, field.distance.size(), nodes_per_range, "", [&](const WorkRange& range) {
    for (std::size_t node = range.begin; node < range.end; ++node) {
      if (field.distance[node] != 0) field.distance[node] = -field.distance[node];
    }
  });
}

/// Signs an unsigned field of a closed mesh as its normals do. Its winding numbers tell the same sides, without being
/// misled where the mesh crosses itself or where float32 cannot tell which of two sheets is the closer one.
/// @return  whether the mesh is known not to cross itself.
bool sign_by_orientation(const MeshView& mesh, const SiteTable& sites, int level, const Context& context,
                         Field& field) {
  if (const std::optional<SignScan> scan = SignScan::make(mesh, field.grid, context)) {
    return scan->apply(field, level, context);
  }
  if (level == 0) {
    (void)apply_winding_sign(field, mesh, sites, context);
  } else {
    const std::vector<Triangle> turned = turned_triangles(mesh.triangles);
    (void)apply_winding_sign(field, {mesh.vertices, turned, {}, {}}, sites, context);
    invert_signs(context, field);
  }
  return false;
}

/// Says of a field signed by orientation that its mesh crosses itself.
void tell_crossing(const SignChoice& choice, Field& field) {
  if (choice.is_automatic) {
    field.sign_rule = SignRule::winding;
    field.sign_reason = "winding number above 1/2: the mesh is closed and oriented, but it crosses itself";
  } else {
    field.sign_reason += "; the mesh crosses itself: inside is what lies in any of the overlapping parts";
  }
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
  std::unique_ptr<FieldBackend> engine;
  Field field;

  void compute(const MeshView& mesh, const Context& frame_context);
};

void FieldSolver::State::compute(const MeshView& mesh, const Context& frame_context) {
  validate(mesh);
  check_site_ids(options, !mesh.segments.empty() || !mesh.points.empty());
  throw_if_cancelled(frame_context);
  const std::size_t nodes = field.grid.node_count();
  // One by one: where memory runs out between the two, the next frame_context finds the first one there already.
  if (field.distance.size() != nodes) field.distance = Buffer<float>(nodes);
  if (field.site.size() != nodes) field.site = Buffer<SiteId>(nodes);
  field.band = options.band;
  field.site_ids = SiteIds::features;
  field.device = engine->device();
  field.phases.clear();

  PhaseTimer connectivity_timer(field.phases);
  engine->set_mesh(mesh, frame_context);
  const SignChoice choice = choose_sign_rule(options.sign, mesh, engine->sites());
  connectivity_timer.lap("connectivity");
  const bool with_sides = choice.rule == SignRule::normals && !choice.level;
  const FieldRequest request{field.grid, options.band, with_sides && engine->can_tell_sides(),
                             choice.rule == SignRule::winding ? std::optional<int>(0) : choice.level};
  FieldResult result = engine->compute(request, frame_context, field);
  PhaseTimer sign_timer(field.phases);
  if (with_sides && !engine->can_tell_sides())
    result.unsettled = tell_sides(mesh, engine->sites(), frame_context, field);
  settle_nodes(result.unsettled, mesh, engine->sites(), with_sides, frame_context, field);
  field.sign_rule = choice.rule;
  field.sign_reason = choice.reason;
  if (choice.rule == SignRule::winding && !result.is_signed) {
    sign_by_winding(mesh, engine->sites(), frame_context, field);
  }
  if (choice.level) {
    const bool is_simple = result.is_signed
                               ? result.is_simple
                               : sign_by_orientation(mesh, engine->sites(), *choice.level, frame_context, field);
    if (!is_simple) tell_crossing(choice, field);
  }
  sign_timer.lap("sign");
  if (options.site_ids == SiteIds::triangles) show_triangles(engine->sites(), frame_context, field);
}

FieldSolver::FieldSolver(const GridSpec& grid, const FieldOptions& options, const Context& context)
    : state_(std::make_unique<State>()) {
  validate(grid);
  check_options(options);
  (void)thread_count(context);
  state_->engine = make_field_backend(context);
  state_->options = options;
  state_->context = context;
  state_->field.grid = grid;
}

FieldSolver::FieldSolver(FieldSolver&&) noexcept = default;
FieldSolver& FieldSolver::operator=(FieldSolver&&) noexcept = default;
FieldSolver::~FieldSolver() = default;

const Field& FieldSolver::compute(const MeshView& mesh) {
  return compute(mesh, state_->context);
}

const Field& FieldSolver::compute(const MeshView& mesh, const Context& context) {
  state_->compute(mesh, context);
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
