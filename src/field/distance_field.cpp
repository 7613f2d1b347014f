// Computes fields of meshes: plans the signs, runs the back end, and settles the nodes that the back end left
// unsettled.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "blum/core/context.hpp"
#include "blum/core/error.hpp"
#include "blum/core/ids.hpp"
#include "blum/core/parallel.hpp"
#include "blum/core/phase_timer.hpp"
#include "blum/core/vec3.hpp"
#include "blum/field/field.hpp"
#include "blum/geometry/bvh.hpp"
#include "blum/geometry/pseudonormals.hpp"
#include "blum/geometry/sites.hpp"
#include "blum/geometry/triangle_mesh.hpp"
#include "field/backend.hpp"
#include "field/field_options.hpp"
#include "field/second_labels.hpp"
#include "field/sign/policy.hpp"
#include "field/sign/scan.hpp"
#include "field/sign/winding.hpp"

namespace blum::sign {
namespace {

constexpr std::size_t nodes_per_range = std::size_t{1} << 18;

void invert_signs(const Context& context, Field& field) {
  parallel_for(context, field.distance.size(), nodes_per_range, "", [&](const WorkRange& range) {
    for (std::size_t node = range.begin; node < range.end; ++node) {
      if (field.distance[node] != 0) field.distance[node] = -field.distance[node];
    }
  });
}

/// Negates the distances of nodes inside. The results are identical for any number of threads.
/// @param plan   sign plan of this mesh; its method must be Method::crossings or Method::sums.
/// @param field  unsigned distances of this mesh. The error of the distances is at most 1e-6 of the diagonal of the box
/// around mesh and grid.
void apply_winding(const Plan& plan, const MeshView& mesh, const SiteTable& sites, const Context& context,
                   Field& field) {
  if (plan.method == Method::crossings) {
    if (const std::optional<SignScan> scan = SignScan::make(mesh, field.grid, context)) {
      scan->apply(field, plan.level, context);
      return;
    }
  }
  if (plan.level == 0) {
    (void)apply_winding_sign(field, mesh, sites, context);
    return;
  }
  // The reversed mesh has negated winding numbers. A point with a number above -1/2 in the given mesh has a number
  // below 1/2 in the reversed mesh. So the signs are inverted.
  const std::vector<Triangle> turned = reversed_triangles(mesh.triangles);
  (void)apply_winding_sign(field, {mesh.vertices, turned, {}, {}}, sites, context);
  invert_signs(context, field);
}

/// Negates the distance of each node whose closest site faces away from it. The sites must be stored in the field.
/// @return  nodes without a site, ascending.
std::vector<std::size_t> apply_pseudonormals(const MeshView& mesh, const SiteTable& sites, const Context& context,
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
        // A site's normal is perpendicular to the site, so any point of the site can be used.
        const auto corner = static_cast<std::size_t>(sites.vertices(site)[0]);
        if (normals.is_inside(query, mesh.vertices[corner], site)) field.distance[node] = -field.distance[node];
      }
    }
  });
  std::vector<std::size_t> all;
  for (const auto& part : open) all.insert(all.end(), part.begin(), part.end());
  return all;
}

}  // namespace
}  // namespace blum::sign

namespace blum {
namespace {

struct SecondSite {
  double distance = std::numeric_limits<double>::infinity();
  SiteId site = SiteId::none();
};

/// Finds second sites in double precision, one query at a time, in balls of growing radius. This search is for the few
/// nodes that the kernels leave unsettled. The mesh, sites and labels must outlive it.
class SecondSearch {
 public:
  SecondSearch(const MeshView& mesh, const SiteTable& sites, const SecondLabels& labels, const Context& context);

  /// Returns the closest site that shares no label with `first`, or none if it is further than `limit`. Among equally
  /// close sites, the site with the smallest id is returned.
  /// @param first_distance  approximate distance of the first site. The first radius follows from this distance.
  [[nodiscard]] SecondSite find(const Vec3d& query, SiteId first, double first_distance, double limit) const;

 private:
  void offer(const NearestPrimitive& found, const Vec3d& query, const SecondLabels::OfSite& first,
             SecondSite& best) const;

  MeshView mesh_;
  const SiteTable& sites_;
  const SecondLabels& labels_;
  Bvh bvh_;
};

void offer_site(double distance, SiteId site, SecondSite& best) {
  if (distance < best.distance || (distance == best.distance && site.value < best.site.value)) best = {distance, site};
}

/// Offers the closest of three sites: an edge and its two ends.
void offer_edge(const MeshView& mesh, const SiteTable& sites, const Segment& ends, const Vec3d& query,
                SecondSite& best) {
  const Vec3d& a = mesh.vertices[ends[0]];
  const Vec3d& b = mesh.vertices[ends[1]];
  const Vec3d along = b - a;
  const double from_a = dot(query - a, along);
  const double from_b = dot(b - query, along);
  if (from_a <= 0) return offer_site(length(query - a), SiteId(ends[0]), best);
  if (from_b <= 0) return offer_site(length(query - b), SiteId(ends[1]), best);
  // Measured from the nearer end, so that the rounding error does not grow with the edge's length.
  const double squared = from_a + from_b;
  const Vec3d point = from_a < from_b ? a + along * (from_a / squared) : b - along * (from_b / squared);
  const auto found = std::lower_bound(sites.edges().begin(), sites.edges().end(), ends);
  const auto edge = static_cast<std::uint32_t>(found - sites.edges().begin());
  offer_site(length(query - point), sites.id({SiteKind::edge, edge}), best);
}

std::array<std::uint32_t, 3> vertices_of(const MeshView& mesh, std::size_t primitive) {
  if (primitive < mesh.triangles.size()) return mesh.triangles[primitive];
  primitive -= mesh.triangles.size();
  if (primitive < mesh.segments.size()) {
    const Segment& s = mesh.segments[primitive];
    return {s[0], s[1], s[1]};
  }
  const std::uint32_t v = mesh.points[primitive - mesh.segments.size()];
  return {v, v, v};
}

SecondSearch::SecondSearch(const MeshView& mesh, const SiteTable& sites, const SecondLabels& labels,
                           const Context& context)
    : mesh_(mesh), sites_(sites), labels_(labels), bvh_(mesh, sites, context) {}

void SecondSearch::offer(const NearestPrimitive& found, const Vec3d& query, const SecondLabels::OfSite& first,
                         SecondSite& best) const {
  // Corners of the primitive that are not excluded. They form the whole primitive, an edge, a vertex or nothing.
  std::array<std::uint32_t, 3> left{};
  std::size_t count = 0;
  bool is_whole = true;
  for (const std::uint32_t v : vertices_of(mesh_, found.primitive)) {
    const std::uint32_t label = labels_.of_vertex(v);
    if (label == first[0] || label == first[1] || label == first[2]) {
      is_whole = false;
    } else if (std::find(left.begin(), left.begin() + count, v) == left.begin() + count) {
      left[count++] = v;
    }
  }
  if (count == 0) return;
  if (is_whole) return offer_site(found.distance, found.site, best);
  if (count == 1) return offer_site(length(query - mesh_.vertices[left[0]]), SiteId(left[0]), best);
  offer_edge(mesh_, sites_, {std::min(left[0], left[1]), std::max(left[0], left[1])}, query, best);
}

SecondSite SecondSearch::find(const Vec3d& query, SiteId first, double first_distance, double limit) const {
  const SecondLabels::OfSite labels = labels_.of_site(sites_, first);
  SecondSite best;
  if (!labels_.has_second(labels)) return best;
  const Box3& box = bvh_.bounds();
  const double furthest = length(max(box.upper - query, query - box.lower));
  const double end = std::min(limit, furthest * (1 + 1e-9));
  double radius = std::min(end, 1.25 * first_distance + 1e-3 * box.diagonal());
  while (true) {
    bvh_.for_each_within(query, radius, [&](const NearestPrimitive& found) {
      offer(found, query, labels, best);
      return true;
    });
    if (best.distance <= radius || radius >= end) break;
    // The next ball contains the best site found so far, which may lie outside of this ball. No site beyond the next
    // ball is closer.
    radius = std::min({end, best.distance, 2 * radius});
  }
  return best.distance <= limit ? best : SecondSite{};
}

/// Computes the exact second distance and site of nodes that the kernels left unsettled.
void settle_second(const std::vector<std::size_t>& nodes, const MeshView& mesh, const SiteTable& sites,
                   const SecondRequest& request, const Context& context) {
  if (nodes.empty()) return;
  const SecondSearch search(mesh, sites, *request.labels, context);
  const double limit = request.has_band() ? request.band : std::numeric_limits<double>::infinity();
  const GridSpec& grid = request.grid;
  parallel_for(context, nodes.size(), 64, "", [&](const WorkRange& range) {
    for (std::size_t k = range.begin; k < range.end; ++k) {
      const auto node = static_cast<std::int64_t>(nodes[k]);
      const SiteId first(request.site[nodes[k]]);
      SecondSite second;
      if (first.has_value()) {
        const Vec3d query = grid.position(node % grid.size[0], node / grid.size[0] % grid.size[1],
                                          node / (grid.size[0] * grid.size[1]));
        second = search.find(query, first, std::abs(static_cast<double>(request.distance[nodes[k]])), limit);
      }
      request.distance2[nodes[k]] = static_cast<float>(second.site.has_value() ? second.distance : limit);
      request.site2[nodes[k]] = second.site.value;
    }
  });
}

constexpr std::size_t nodes_per_range = std::size_t{1} << 18;

/// Computes the exact distance and site of nodes that the kernels left unsettled. With sides, also decides the sign by
/// the site's pseudonormal.
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
      if (!field.site.empty()) field.site[nodes[k]] = is_beyond ? SiteId::none() : nearest->site;
    }
  });
}

void show_triangles(const SiteTable& sites, const Context& context, Buffer<SiteId>& values) {
  parallel_for(context, values.size(), nodes_per_range, "", [&](const WorkRange& range) {
    for (std::size_t node = range.begin; node < range.end; ++node) {
      if (values[node].has_value()) values[node] = SiteId(sites.triangle(values[node]).value);
    }
  });
}

void check_object_count(const std::vector<std::uint32_t>& objects, const MeshView& mesh) {
  if (objects.empty() || objects.size() == mesh.vertices.size()) return;
  throw InvalidOption("objects has " + std::to_string(objects.size()) + " entries, but the mesh has " +
                      std::to_string(mesh.vertices.size()) + " vertices; give one entry for each vertex");
}

/// Returns the warnings about the signs of a computed field.
std::vector<Warning> sign_warnings(const sign::Plan& plan, std::span<const float> distance) {
  if (plan.rule == SignRule::none || std::any_of(distance.begin(), distance.end(), [](float d) { return d < 0; })) {
    return plan.warnings;
  }
  if (!plan.warnings.empty() && plan.triangles.empty()) {
    return {{WarningCode::nothing_inside, "no node is inside: " + plan.warnings.front().text}};
  }
  return {{WarningCode::nothing_inside,
           "no node is inside: the shape encloses nothing, lies outside the grid, or is too thin for its spacing"}};
}

}  // namespace

struct FieldSolver::State {
  FieldOptions options;
  Context context;
  std::unique_ptr<FieldBackend> engine;
  std::string device_reason;
  sign::Planner planner;
  std::vector<std::uint32_t> objects;  ///< one per vertex; if empty, the objects are the connected parts of the mesh
  Field field;

  void compute(const MeshView& given, const Context& frame_context);

 private:
  /// Allocates the memory of field and request. Existing memory of the right size is kept.
  void allocate(bool with_sites, FieldRequest& request);
  /// Adds the second order to a field. Everything else of the field must be complete, except the conversion of site ids
  /// to their requested kind.
  void compute_second(const MeshView& mesh, const Context& frame_context);
};

void FieldSolver::State::allocate(bool with_sites, FieldRequest& request) {
  const std::size_t nodes = field.grid.node_count();
  // The buffers are allocated one by one. If memory runs out after the first, the next frame reuses it.
  if (field.distance.size() != nodes) field.distance = Buffer<float>(nodes);
  request.distance = field.distance.data();
  if (!with_sites) return;
  if (field.site.size() != nodes) field.site = Buffer<SiteId>(nodes);
  request.site = &field.site.data()->value;
}

void FieldSolver::State::compute_second(const MeshView& mesh, const Context& frame_context) {
  PhaseTimer timer(field.phases);
  const SiteTable& sites = engine->sites();
  const SecondLabels labels(options.second, mesh, sites, objects, frame_context);
  field.second = options.second;
  const std::size_t nodes = field.grid.node_count();
  if (field.distance2.size() != nodes) field.distance2 = Buffer<float>(nodes);
  if (field.site2.size() != nodes) field.site2 = Buffer<SiteId>(nodes);
  SecondRequest request;
  request.grid = field.grid;
  request.band = options.band.value_or(0);
  request.labels = &labels;
  request.distance = field.distance.data();
  request.site = &field.site.data()->value;
  request.distance2 = field.distance2.data();
  request.site2 = &field.site2.data()->value;
  settle_second(engine->compute_second(request, frame_context), mesh, sites, request, frame_context);
  timer.lap("second order");
}

void FieldSolver::State::compute(const MeshView& given, const Context& frame_context) {
  MeshView mesh = given;
  validate(mesh);
  check_site_ids(options, !mesh.segments.empty() || !mesh.points.empty());
  check_object_count(objects, mesh);
  throw_if_cancelled(frame_context);
  field.band = options.band;
  field.site_ids = SiteIds::features;
  field.device = engine->device();
  field.device_reason = device_reason;
  field.phases.clear();

  PhaseTimer connectivity_timer(field.phases);
  engine->set_mesh(mesh, frame_context);
  const sign::Plan plan = planner.plan(options.sign, mesh, engine->sites(), frame_context);
  if (!plan.triangles.empty()) {
    mesh.triangles = plan.triangles;
    engine->set_mesh(mesh, frame_context);
  }
  const SiteTable& sites = engine->sites();
  connectivity_timer.lap("connectivity");
  FieldRequest request = make_field_request(field.grid, options, plan);
  allocate(options.sites || options.order == 2 || engine->needs_sites_for(plan.method), request);
  FieldResult result = engine->compute(request, frame_context, field.phases);
  PhaseTimer sign_timer(field.phases);
  const bool by_normals = plan.method == sign::Method::pseudonormals;
  if (by_normals && !result.is_signed) result.unsettled = sign::apply_pseudonormals(mesh, sites, frame_context, field);
  settle_nodes(result.unsettled, mesh, sites, by_normals, frame_context, field);
  if (sign::is_by_winding(plan.method) && !result.is_signed)
    sign::apply_winding(plan, mesh, sites, frame_context, field);
  field.sign_rule = plan.rule;
  field.sign_reason = plan.reason;
  field.warnings = sign_warnings(plan, field.distance.span());
  sign_timer.lap("sign");
  if (options.order == 2) compute_second(mesh, frame_context);
  if (!options.sites) {
    field.site = {};
    field.site2 = {};
  }
  if (options.site_ids == SiteIds::triangles) {
    show_triangles(sites, frame_context, field.site);
    show_triangles(sites, frame_context, field.site2);
    field.site_ids = SiteIds::triangles;
  }
}

FieldSolver::FieldSolver(const GridSpec& grid, const FieldOptions& options, const Context& context)
    : state_(std::make_unique<State>()) {
  validate(grid);
  check_options(options);
  (void)thread_count(context);
  state_->engine = make_field_backend(context, options.order, state_->device_reason);
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

void FieldSolver::set_objects(std::span<const std::uint32_t> objects) {
  if (!objects.empty()) check_objects(state_->options);
  state_->objects.assign(objects.begin(), objects.end());
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

Field distance_field(const MeshView& mesh, const GridSpec& grid, std::span<const std::uint32_t> objects,
                     const FieldOptions& options, const Context& context) {
  check_objects(options);
  FieldSolver solver(grid, options, context);
  solver.set_objects(objects);
  (void)solver.compute(mesh);
  return solver.take();
}

}  // namespace blum
