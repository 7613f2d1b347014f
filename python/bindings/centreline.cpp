#include "blum/medial_axis/centreline.hpp"

#include <nanobind/stl/array.h>
#include <nanobind/stl/optional.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>

#include <optional>
#include <utility>
#include <vector>

#include "arrays.hpp"
#include "bindings.hpp"
#include "call.hpp"
#include "images.hpp"
#include "structs.hpp"

namespace blum::python {
namespace {

/// Returns (kinds, positions, radii).
nb::tuple nodes_of(const Centreline& line) {
  nb::list kinds;
  std::vector<Vec3d> positions;
  std::vector<double> radii;
  for (const CentrelineNode& node : line.nodes) {
    kinds.append(nb::cast(std::string(to_string(node.kind))));
    positions.push_back(node.position);
    radii.push_back(node.radius);
  }
  return nb::make_tuple(nb::tuple(kinds), handed_over<double>(std::move(positions), 3),
                        handed_over<double>(std::move(radii)));
}

/// Returns (nodes, length, mean radius, least radius, points, radii) of each branch.
nb::list branches_of(Centreline& line) {
  nb::list out;
  for (CentrelineBranch& branch : line.branches) {
    out.append(nb::make_tuple(nb::make_tuple(branch.nodes[0], branch.nodes[1]), branch.length, branch.mean_radius,
                              branch.min_radius, handed_over<double>(std::move(branch.points), 3),
                              handed_over<double>(std::move(branch.radii))));
  }
  return out;
}

/// Returns (label, voxels, nodes, branches, label_betti, graph_betti, homotopy_kept, homotopy).
nb::tuple parts_of(Centreline& line) {
  return nb::make_tuple(line.label, line.voxels, nodes_of(line), branches_of(line), line.label_betti, line.graph_betti,
                        line.homotopy_kept, line.homotopy);
}

}  // namespace

void bind_centreline(nb::module_& m) {
  static_cast<void>(type_name<CentrelineNodeKind>(m));
  bind_options<CentrelineOptions>(m);
  m.def(
      "centreline",
      [](const ImageArrays& image, const std::optional<std::vector<std::int64_t>>& labels, const nb::dict& given,
         int threads, nb::object progress) {
        const auto options = options_from<CentrelineOptions>(given);
        Centrelines lines = run({threads, std::move(progress)}, [&](const Context& context) {
          return labels ? centreline(image.view, *labels, options, context) : centreline(image.view, options, context);
        });
        Complex complex = complex_of(lines);
        nb::list parts;
        for (Centreline& line : lines.labels) parts.append(parts_of(line));
        return nb::make_tuple(std::move(parts), nb::cast(std::move(complex)), seconds_of(lines.phases),
                              to_python(lines.warnings));
      },
      nb::arg("image"), nb::arg("labels").none(), nb::arg("options"), nb::arg("threads"), nb::arg("progress").none());
}

}  // namespace blum::python
