#include <nanobind/stl/map.h>
#include <nanobind/stl/optional.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>

#include <algorithm>
#include <array>
#include <span>
#include <string>
#include <vector>

#include "arrays.hpp"
#include "bindings.hpp"
#include "blum/core/parallel.hpp"
#include "blum/field/reference.hpp"
#include "blum/geometry/pseudonormals.hpp"
#include "blum/geometry/self_intersections.hpp"
#include "blum/geometry/sites.hpp"
#include "blum/geometry/topology.hpp"
#include "blum/geometry/weld.hpp"
#include "blum/geometry/winding_number.hpp"
#include "blum/grid/image_generators.hpp"
#include "blum/shapes/generators.hpp"
#include "blum/shapes/shape_catalog.hpp"
#include "call.hpp"
#include "images.hpp"
#include "structs.hpp"

namespace blum::python {
namespace {

constexpr std::size_t queries_per_range = 256;

/// Returns the number of brute-force queries between two checks for cancellation, a few milliseconds of work.
std::size_t queries_between_looks(const MeshView& mesh) {
  return std::max<std::size_t>(1, 65536 / std::max<std::size_t>(1, mesh.triangles.size()));
}

/// Returns one value per point, computed by all threads.
template <class T, class Value>
Out<T> for_each_point(const PointsIn& points, const Call& call, const char* phase, const Value& value,
                      std::size_t at_once = queries_per_range) {
  const std::span<const Vec3d> queries = vectors(points);
  return handed_over<T>(run(call, [&](const Context& context) {
    std::vector<T> out(queries.size());
    parallel_for(context, queries.size(), at_once, phase, [&](const WorkRange& range) {
      for (std::size_t q = range.begin; q < range.end; ++q) out[q] = value(queries[q]);
    });
    return out;
  }));
}

void bind_winding(nb::module_& m) {
  nb::class_<WindingNumber>(m, "WindingNumber")
      .def(
          "__init__",
          [](WindingNumber* self, const MeshArrays& mesh, int threads, nb::object progress) {
            const MeshView view = mesh.view();
            new (self) WindingNumber(run({threads, std::move(progress)}, [&](const Context& context) {
              validate(view);
              return WindingNumber(view, context);
            }));
          },
          nb::arg("mesh"), nb::arg("threads"), nb::arg("progress").none())
      .def(
          "values",
          [](const WindingNumber& self, const PointsIn& points, double beta, int threads, nb::object progress) {
            return for_each_point<double>(
                points, {threads, std::move(progress)}, "winding numbers",
                [&](const Vec3d& q) { return beta > 0 ? self.approximate(q, beta) : self(q); });
          },
          nb::arg("points").noconvert(), nb::arg("beta"), nb::arg("threads"), nb::arg("progress").none())
      .def(
          "is_inside",
          [](const WindingNumber& self, const PointsIn& points, int threads, nb::object progress) {
            return for_each_point<std::uint8_t>(
                points, {threads, std::move(progress)}, "winding numbers",
                [&](const Vec3d& q) { return self.is_inside(q) ? std::uint8_t{1} : std::uint8_t{0}; });
          },
          nb::arg("points").noconvert(), nb::arg("threads"), nb::arg("progress").none());
}

void bind_sites(nb::module_& m) {
  nb::class_<SiteTable>(m, "SiteTable")
      .def(
          "__init__",
          [](SiteTable* self, const MeshArrays& mesh, int threads, nb::object progress) {
            const MeshView view = mesh.view();
            new (self) SiteTable(run({threads, std::move(progress)}, [&](const Context& context) {
              validate(view);
              return SiteTable(view, context);
            }));
          },
          nb::arg("mesh"), nb::arg("threads"), nb::arg("progress").none())
      .def_prop_ro("vertex_count", &SiteTable::vertex_count)
      .def_prop_ro("face_count", &SiteTable::face_count)
      .def_prop_ro("edges",
                   [](nb::pointer_and_handle<SiteTable> self) {
                     const auto edges = self.p->edges();
                     return view_of(reinterpret_cast<const std::int32_t*>(edges.data()), {edges.size(), 2}, self.h);
                   })
      .def_prop_ro("triangle_edges",
                   [](nb::pointer_and_handle<SiteTable> self) {
                     const auto sides = self.p->triangle_edges();
                     return view_of(reinterpret_cast<const std::int32_t*>(sides.data()), {sides.size(), 3}, self.h);
                   })
      .def("vertices",
           [](const SiteTable& self, const IndicesIn& ids) {
             const auto sites = rows<std::uint32_t>(ids);
             std::vector<std::array<std::int32_t, 3>> out(sites.size());
             for (std::size_t k = 0; k < sites.size(); ++k) out[k] = self.vertices(SiteId(sites[k]));
             return handed_over<std::int32_t>(std::move(out), 3);
           })
      .def("triangles", [](const SiteTable& self, const IndicesIn& ids) {
        const auto sites = rows<std::uint32_t>(ids);
        std::vector<std::int32_t> out(sites.size());
        for (std::size_t k = 0; k < sites.size(); ++k) out[k] = self.triangle(SiteId(sites[k])).to_file();
        return handed_over<std::int32_t>(std::move(out));
      });
  m.def(
      "pseudonormals",
      [](const MeshArrays& mesh, int threads, nb::object progress) {
        const MeshView view = mesh.view();
        return handed_over<double>(run({threads, std::move(progress)},
                                       [&](const Context& context) {
                                         validate(view);
                                         const SiteTable sites(view, context);
                                         return Pseudonormals(view, sites, context).normals();
                                       }),
                                   3);
      },
      nb::arg("mesh"), nb::arg("threads"), nb::arg("progress").none());
}

nb::dict entry(const std::string& name, const std::string& description, const char* kind,
               const std::vector<Parameter>& parameters) {
  nb::list all;
  for (const Parameter& p : parameters) {
    all.append(nb::make_tuple(p.name, p.description, p.default_value, p.minimum, p.maximum, p.integer));
  }
  nb::dict out;
  out["name"] = name;
  out["description"] = description;
  out["kind"] = kind;
  out["parameters"] = all;
  return out;
}

using OutlineIn = In<double, nb::shape<-1, 2>>;

std::span<const Point2> polygon(const OutlineIn& points) {
  return rows<Point2>(points);
}

/// Binds functions that make meshes from polygons and from other meshes.
void bind_makers(nb::module_& m) {
  m.def(
      "extrusion",
      [](const OutlineIn& outline, const std::vector<OutlineIn>& holes, double thickness, int stacks) {
        std::vector<std::vector<Point2>> inner;
        for (const OutlineIn& hole : holes) inner.emplace_back(polygon(hole).begin(), polygon(hole).end());
        const ExtrusionOptions options{thickness, stacks};
        return arrays_of(run({0, nb::none()}, [&](const Context& context) {
          return make_extrusion(polygon(outline), inner, options, context);
        }));
      },
      nb::arg("outline").noconvert(), nb::arg("holes"), nb::arg("thickness"), nb::arg("stacks"));
  m.def(
      "noisy",
      [](const MeshArrays& mesh, double amplitude, std::uint64_t seed) {
        const MeshView view = mesh.view();
        return arrays_of(run({0, nb::none()}, [&](const Context&) { return make_noisy(view, amplitude, seed); }));
      },
      nb::arg("mesh"), nb::arg("amplitude"), nb::arg("seed"));
  m.def(
      "subdivided",
      [](const MeshArrays& mesh, int levels) {
        const MeshView view = mesh.view();
        return arrays_of(run({0, nb::none()}, [&](const Context&) { return make_subdivided(view, levels); }));
      },
      nb::arg("mesh"), nb::arg("levels"));
}

void bind_shapes(nb::module_& m) {
  m.def("catalogue", [] {
    nb::list out;
    for (const ShapeInfo& shape : shape_catalog())
      out.append(entry(shape.name, shape.description, "mesh", shape.parameters));
    for (const ImageInfo& image : image_catalog())
      out.append(entry(image.name, image.description, "image", image.parameters));
    return out;
  });
  m.def(
      "make_shape",
      [](const std::string& name, const ParameterValues& parameters) {
        return arrays_of(run({0, nb::none()}, [&](const Context&) { return make_shape(name, parameters); }));
      },
      nb::arg("name"), nb::arg("parameters"));
  m.def(
      "make_image",
      [](const std::string& name, const ParameterValues& parameters) {
        return image_of(run({0, nb::none()}, [&](const Context&) { return make_image(name, parameters); }));
      },
      nb::arg("name"), nb::arg("parameters"));
  m.def(
      "known_betti",
      [](const std::string& name, const std::string& kind, const ParameterValues& given) {
        if (kind == "mesh") {
          const ShapeInfo& shape = find_shape(name);
          return result_of(shape.betti(complete_parameters(name, shape.parameters, given)));
        }
        const ImageInfo& image = find_image(name);
        return result_of(image.betti(complete_parameters(name, image.parameters, given)));
      },
      nb::arg("name"), nb::arg("kind"), nb::arg("parameters"));
}

void bind_reference(nb::module_& m) {
  m.def(
      "reference_nearest",
      [](const MeshArrays& mesh, const PointsIn& points, int threads, nb::object progress) {
        const MeshView view = mesh.view();
        const std::span<const Vec3d> queries = vectors(points);
        std::vector<double> distances(queries.size());
        std::vector<std::int32_t> sites(queries.size());
        run_call({threads, std::move(progress)}, [&](const Context& context) {
          validate(view);
          const reference::BruteForce brute(view);
          parallel_for(context, queries.size(), queries_between_looks(view), "brute force",
                       [&](const WorkRange& range) {
                         for (std::size_t q = range.begin; q < range.end; ++q) {
                           const reference::Nearest nearest = brute.nearest(queries[q]);
                           distances[q] = nearest.distance;
                           sites[q] = nearest.site.to_file();
                         }
                       });
        });
        return nb::make_tuple(handed_over<double>(std::move(distances)), handed_over<std::int32_t>(std::move(sites)));
      },
      nb::arg("mesh"), nb::arg("points").noconvert(), nb::arg("threads"), nb::arg("progress").none());
  m.def(
      "reference_winding_number",
      [](const MeshArrays& mesh, const PointsIn& points, int threads, nb::object progress) {
        const MeshView view = mesh.view();
        validate(view);
        return for_each_point<double>(
            points, {threads, std::move(progress)}, "brute force",
            [&](const Vec3d& query) { return reference::winding_number(view, query); }, queries_between_looks(view));
      },
      nb::arg("mesh"), nb::arg("points").noconvert(), nb::arg("threads"), nb::arg("progress").none());
}

}  // namespace

void bind_geometry(nb::module_& m) {
  bind_struct<Topology>(m);
  nb::class_<MeshArrays>(m, "MeshArrays")
      .def(
          "__init__",
          [](MeshArrays* self, PointsIn vertices, TrianglesIn triangles, SegmentsIn segments, IndicesIn points) {
            new (self) MeshArrays{std::move(vertices), std::move(triangles), std::move(segments), std::move(points)};
          },
          nb::arg("vertices").noconvert(), nb::arg("triangles").noconvert(), nb::arg("segments").noconvert(),
          nb::arg("points").noconvert())
      .def("validate", [](const MeshArrays& mesh) { validate(mesh.view()); })
      .def("bounds", [](const MeshArrays& mesh) {
        validate(mesh.view());
        return result_of(bounds(mesh.view()));
      });
  m.def(
      "topology",
      [](const MeshArrays& mesh, int threads, nb::object progress) {
        const MeshView view = mesh.view();
        return result_of(
            run({threads, std::move(progress)}, [&](const Context& context) { return topology(view, context); }));
      },
      nb::arg("mesh"), nb::arg("threads"), nb::arg("progress").none());
  m.def(
      "self_intersections",
      [](const MeshArrays& mesh, std::size_t limit, int threads, nb::object progress) {
        const MeshView view = mesh.view();
        const SelfIntersections found = run({threads, std::move(progress)}, [&](const Context& context) {
          validate(view);
          return find_self_intersections(view, limit, context);
        });
        std::vector<std::array<std::int32_t, 2>> pairs;
        std::vector<std::uint8_t> crosses;
        for (const TrianglePair& pair : found.pairs) {
          pairs.push_back({pair.first.to_file(), pair.second.to_file()});
          crosses.push_back(pair.crosses ? 1 : 0);
        }
        return nb::make_tuple(handed_over<std::int32_t>(std::move(pairs), 2),
                              handed_over<std::uint8_t>(std::move(crosses)), found.complete);
      },
      nb::arg("mesh"), nb::arg("limit"), nb::arg("threads"), nb::arg("progress").none());
  m.def(
      "weld",
      [](const MeshArrays& mesh, double tolerance) {
        const MeshView view = mesh.view();
        return arrays_of(run({0, nb::none()}, [&](const Context&) { return weld(view, tolerance); }));
      },
      nb::arg("mesh"), nb::arg("tolerance"));
  m.def(
      "weld_clusters",
      [](const PointsIn& vertices, double tolerance) {
        return handed_over<std::int32_t>(
            run({0, nb::none()}, [&](const Context&) { return weld_clusters(vectors(vertices), tolerance); }));
      },
      nb::arg("vertices").noconvert(), nb::arg("tolerance"));
  bind_winding(m);
  bind_sites(m);
  bind_shapes(m);
  bind_makers(m);
  bind_reference(m);
}

}  // namespace blum::python
