// Blum: the second site of single points, exactly. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <limits>

#include "blum/core/ids.hpp"
#include "blum/core/vec3.hpp"
#include "blum/field/field.hpp"
#include "blum/geometry/bvh.hpp"
#include "blum/geometry/sites.hpp"
#include "blum/geometry/triangle_mesh.hpp"
#include "field/second_labels.hpp"

namespace blum {

struct SecondSite {
  double distance = std::numeric_limits<double>::infinity();
  SiteId site = SiteId::none();
};

/// Finds second sites in double precision, point by point. For the few nodes that the kernels leave open: it looks at
/// balls that grow. Everything given must outlive it.
class SecondSearch {
 public:
  SecondSearch(const MeshView& mesh, const SiteTable& sites, const SecondLabels& labels, const Context& context);

  /// The closest site, of the smallest id, that has no label in common with `first`; none beyond `limit`.
  /// @param first_distance  where it is, about, which tells how far to look.
  [[nodiscard]] SecondSite find(const Vec3d& query, SiteId first, double first_distance, double limit) const;

 private:
  void offer(const NearestPrimitive& found, const Vec3d& query, const SecondLabels::OfSite& first,
             SecondSite& best) const;

  MeshView mesh_;
  const SiteTable& sites_;
  const SecondLabels& labels_;
  Bvh bvh_;
};

}  // namespace blum
