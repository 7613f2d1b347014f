// Blum: first contacts for Python. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <nanobind/nanobind.h>

#include <optional>
#include <string>
#include <variant>

#include "blum/proximity/first_contact.hpp"

namespace blum::python {

/// Returns the values of the Python class FirstContact; None if nothing meets.
inline nanobind::object contact_out(const std::optional<FirstContact>& found) {
  namespace nb = nanobind;
  if (!found) return nb::none();
  nb::object vertex = nb::none();
  nb::object face = nb::none();
  nb::object edges = nb::none();
  if (const auto* pair = std::get_if<VertexFaceCollision>(&found->features)) {
    vertex = nb::cast(pair->vertex);
    face = nb::cast(pair->face.value);
  } else {
    const auto& both = std::get<EdgeEdgeCollision>(found->features);
    edges =
        nb::make_tuple(nb::make_tuple(both.first[0], both.first[1]), nb::make_tuple(both.second[0], both.second[1]));
  }
  return nb::make_tuple(found->time(), nb::str(std::string(to_string(found->kind)).c_str()),
                        nb::make_tuple(found->first.value, found->second.value), vertex, face, edges);
}

}  // namespace blum::python
