#include "blum/certificate/certificate.hpp"

#include <nanobind/stl/array.h>
#include <nanobind/stl/optional.h>
#include <nanobind/stl/pair.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/tuple.h>
#include <nanobind/stl/vector.h>

#include <cmath>
#include <cstdint>
#include <new>
#include <optional>
#include <string>
#include <tuple>
#include <utility>

#include "arrays.hpp"
#include "bindings.hpp"
#include "blum/certified/axis_solid.hpp"
#include "blum/certified/verify_axis.hpp"
#include "call.hpp"
#include "images.hpp"
#include "structs.hpp"

namespace blum::python {
namespace {

/// Returns the claims of an axis.
/// @param has  true for each attribute with real values, false for one with fillers.
MedialClaims claims_from(const nb::dict& metadata, const nb::dict& has) {
  const auto holds = [&](const char* name) { return nb::cast<bool>(has[name]); };
  return {options_from<MedialMetadata>(metadata),
          holds("radii"),
          holds("footprints"),
          holds("sites"),
          holds("angles"),
          holds("labels")};
}

}  // namespace

void bind_certificate(nb::module_& m) {
  bind_options<CertificateOptions>(m);
  bind_struct<Certificate>(m);
  bind_struct<MeshSolidRule>(m);
  m.def(
      "solid_rule",
      [](const MeshArrays& mesh, int threads, nb::object progress) {
        const MeshView view = mesh.view();
        return result_of(
            run({threads, std::move(progress)}, [&](const Context& context) { return solid_rule(view, context); }));
      },
      nb::arg("mesh"), nb::arg("threads"), nb::arg("progress").none());
  m.def(
      "solid_of_axis",
      [](const nb::dict& metadata, bool is_image, std::optional<std::int64_t> label, std::optional<double> threshold,
         std::optional<double> weld) {
        const auto& [selection, warnings] =
            solid_of_axis({label, threshold, weld}, is_image, options_from<MedialMetadata>(metadata), "the axis",
                          OptionStyle::python);
        return nb::make_tuple(selection.label, selection.threshold, selection.weld, result_of(warnings));
      },
      nb::arg("metadata"), nb::arg("is_image"), nb::arg("label").none(), nb::arg("threshold").none(),
      nb::arg("weld").none());
  nb::class_<MeshAxisVerifier>(m, "MeshAxisVerifier")
      .def(
          "__init__", [](MeshAxisVerifier* self, const MeshArrays& mesh) { new (self) MeshAxisVerifier(mesh.view()); },
          nb::arg("mesh"), nb::keep_alive<1, 2>())
      .def(
          "verify",
          [](const MeshAxisVerifier& self, const Complex& complex, const nb::dict& metadata, const nb::dict& has,
             const nb::dict& checks, int threads, nb::object progress) {
            const MedialClaims claims = claims_from(metadata, has);
            const auto options = options_from<CertificateOptions>(checks);
            return result_of(run({threads, std::move(progress)}, [&](const Context& context) {
              return self.verify(complex, claims, options, HUGE_VAL, context);
            }));
          },
          nb::arg("complex"), nb::arg("metadata"), nb::arg("has"), nb::arg("checks"), nb::arg("threads"),
          nb::arg("progress").none());
  nb::class_<ImageAxisVerifier>(m, "ImageAxisVerifier")
      .def(
          "__init__",
          [](ImageAxisVerifier* self, const ImageArrays& image) { new (self) ImageAxisVerifier(image.view); },
          nb::arg("image"), nb::keep_alive<1, 2>())
      .def(
          "verify",
          [](const ImageAxisVerifier& self, const Complex& complex, const nb::dict& metadata, const nb::dict& has,
             std::optional<std::int64_t> label, std::optional<double> threshold, const nb::dict& checks, int threads,
             nb::object progress) {
            const MedialClaims claims = claims_from(metadata, has);
            const LabelSelection selection = LabelSelection::of(label, threshold);
            const auto options = options_from<CertificateOptions>(checks);
            return result_of(run({threads, std::move(progress)}, [&](const Context& context) {
              return self.verify(complex, claims, selection, options, context);
            }));
          },
          nb::arg("complex"), nb::arg("metadata"), nb::arg("has"), nb::arg("label").none(), nb::arg("threshold").none(),
          nb::arg("checks"), nb::arg("threads"), nb::arg("progress").none());
}

}  // namespace blum::python
