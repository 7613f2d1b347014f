// Blum: the CPU back end of distance_field. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "blum/field/field.hpp"
#include "blum/geometry/sites.hpp"
#include "field/cpu/adjacency.hpp"
#include "field/cpu/cluster_forest.hpp"
#include "field/cpu/normal_frame.hpp"
#include "field/cpu/site_records.hpp"
#include "field/cpu/tile_kernel.hpp"

namespace blum::cpu {

/// Computes fields; keeps connectivity and memory from one to the next.
class Engine {
 public:
  /// Makes `mesh` the current one: site numbering and adjacency, reused when the connectivity is the last one's.
  /// The mesh must stay alive until compute() returns.
  void set_mesh(const MeshView& mesh, const Context& context);
  [[nodiscard]] const SiteTable& sites() const { return sites_; }

  struct Request {
    GridSpec grid;
    std::optional<double> band = {};
    /// Signs by pseudonormals, of a closed, consistently oriented mesh.
    bool with_sides = false;
  };
  /// Fills distance and site (as feature ids) of a field whose buffers have the grid's size, and appends phase times.
  /// Returns nodes that are left to exact queries: those that no site claimed in float32, and those whose side is too
  /// close to call; rising.
  [[nodiscard]] std::vector<std::size_t> compute(const Request& request, const Context& context, Field& field);

 private:
  void build_records(const Request& request, const Context& context);

  MeshView mesh_;
  std::vector<Triangle> last_triangles_;
  std::vector<Segment> last_segments_;
  std::vector<std::uint32_t> last_points_;
  std::size_t last_vertex_count_ = 0;
  bool has_mesh_ = false;

  SiteTable sites_;
  Adjacency adjacency_;
  NormalFrame frame_;
  std::vector<Vec3d> positions_;
  SiteOrder order_;
  SiteRecords records_;
  ClusterForest forest_;
  std::vector<TileScratch> scratch_;
};

}  // namespace blum::cpu
