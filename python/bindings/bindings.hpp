// Blum: the parts of the extension module. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <nanobind/nanobind.h>

namespace blum::python {

namespace nb = nanobind;

void bind_grid(nb::module_& m);
void bind_geometry(nb::module_& m);
void bind_field(nb::module_& m);
void bind_device_field(nb::module_& m);
void bind_closest_points(nb::module_& m);
void bind_points(nb::module_& m);
void bind_surface_map(nb::module_& m);
void bind_images(nb::module_& m);
void bind_complex(nb::module_& m);
void bind_solid(nb::module_& m);
void bind_medial_axis(nb::module_& m);
void bind_axis_graph(nb::module_& m);
void bind_extend_axis(nb::module_& m);
void bind_voronoi(nb::module_& m);
void bind_centreline(nb::module_& m);
void bind_certificate(nb::module_& m);
void bind_proximity(nb::module_& m);
void bind_proximity_scene(nb::module_& m);
void bind_planning(nb::module_& m);
void bind_files(nb::module_& m);

}  // namespace blum::python
