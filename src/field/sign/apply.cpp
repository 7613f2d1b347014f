#include "field/sign/apply.hpp"

#include <cstdint>
#include <optional>

#include "blum/core/parallel.hpp"
#include "blum/geometry/pseudonormals.hpp"
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

}  // namespace

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
  // Above -1 where the winding number is, that of the mesh turned inside out is not above 1/2.
  const std::vector<Triangle> turned = reversed_triangles(mesh.triangles);
  (void)apply_winding_sign(field, {mesh.vertices, turned, {}, {}}, sites, context);
  invert_signs(context, field);
}

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

}  // namespace blum::sign
