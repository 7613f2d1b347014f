#include "blum/planning/certified_motion.hpp"

#include <new>

#include "arrays.hpp"
#include "bindings.hpp"
#include "call.hpp"
#include "places.hpp"
#include "structs.hpp"

namespace blum::python {

void bind_planning(nb::module_& m) {
  bind_options<MotionOptions>(m);
  bind_struct<MotionPair>(m);
  bind_struct<CertifiedMotion>(m);
  nb::class_<MotionCertifier>(m, "MotionCertifier")
      .def(
          "__init__",
          [](MotionCertifier* self, const MeshArrays& body, const MeshArrays& obstacles, int threads) {
            const MeshView first = body.view(), second = obstacles.view();
            new (self) MotionCertifier(run({threads, nb::none()}, [&](const Context& context) {
              return MotionCertifier(first, second, context);
            }));
          },
          nb::arg("body"), nb::arg("obstacles"), nb::arg("threads"))
      .def("centre",
           [](const MotionCertifier& self) {
             const Vec3d centre = self.centre();
             return nb::make_tuple(centre.x, centre.y, centre.z);
           })
      .def(
          "certify",
          [](const MotionCertifier& self, const PlaceIn& from, const PlaceIn& to, double x, double y, double z,
             const nb::dict& given) {
            const auto options = options_from<MotionOptions>(given);
            const RigidMotion motion(place_of(from), place_of(to), {x, y, z});
            return result_of(
                run({1, nb::none()}, [&](const Context& context) { return self.certify(motion, options, context); }));
          },
          nb::arg("start"), nb::arg("goal"), nb::arg("x"), nb::arg("y"), nb::arg("z"), nb::arg("options"));
}

}  // namespace blum::python
