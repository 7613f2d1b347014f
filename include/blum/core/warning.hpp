// Blum: warnings about results, and about valid inputs that may not be the intended ones. SPDX-License-Identifier:
// Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <string_view>
#include <tuple>

#include "blum/core/describe.hpp"

namespace blum {

/// Subject of a warning, for programs that react to warnings. Texts of warnings may change; codes do not.
enum class WarningCode : std::uint8_t {
  form_not_certified,  ///< an axis lacks a preferred property, because the form with this property was not certified
  not_certified,       ///< a result is not certified
  grid_moved,          ///< an axis was certified on a grid that was moved by part of a voxel, not on the first grid
  reversed_shells,     ///< shells or triangles faced the wrong way and were reversed
  solid_of_voxels,     ///< a mesh bounds no polyhedron, so its solid is represented by voxels
  crossings_removed,   ///< a mesh crosses itself; the result is for the mesh after its crossings were removed
  other_solid,         ///< options select a solid that differs from the solid recorded in the file of an axis
  other_vertices,      ///< vertices were merged, or equal vertices are separate: the mesh may not be the intended one
  left_out,            ///< parts of an input or a result were left out
  open_mesh,           ///< a mesh has a boundary, although a closed mesh is expected
  facing,              ///< triangles have inconsistent orientations, or face into the solid
  nothing_inside,      ///< no node of a field is inside
  nothing_found,       ///< none of the requested objects was found
  other_topology,      ///< the topology of a result differs from that of its solid
  single_layer,        ///< an image has one layer of voxels, which form a plate
  rounded,             ///< a file contains rounded numbers, so guarantees for the exact numbers may not hold
  not_extended,        ///< rims of an axis were not extended
  coarse_grid,         ///< a grid is too coarse for the shape
  meet_at_start,       ///< features meet at the start of a motion, so the times of their contacts are 0
};

template <>
struct Description<WarningCode> {
  static constexpr std::string_view name = "WarningCode";
  static constexpr std::array values{
      NamedValue{WarningCode::form_not_certified, "form-not-certified"},
      NamedValue{WarningCode::not_certified, "not-certified"},
      NamedValue{WarningCode::grid_moved, "grid-moved"},
      NamedValue{WarningCode::reversed_shells, "reversed-shells"},
      NamedValue{WarningCode::solid_of_voxels, "solid-of-voxels"},
      NamedValue{WarningCode::crossings_removed, "crossings-removed"},
      NamedValue{WarningCode::other_solid, "other-solid"},
      NamedValue{WarningCode::other_vertices, "other-vertices"},
      NamedValue{WarningCode::left_out, "left-out"},
      NamedValue{WarningCode::open_mesh, "open-mesh"},
      NamedValue{WarningCode::facing, "facing"},
      NamedValue{WarningCode::nothing_inside, "nothing-inside"},
      NamedValue{WarningCode::nothing_found, "nothing-found"},
      NamedValue{WarningCode::other_topology, "other-topology"},
      NamedValue{WarningCode::single_layer, "single-layer"},
      NamedValue{WarningCode::rounded, "rounded"},
      NamedValue{WarningCode::not_extended, "not-extended"},
      NamedValue{WarningCode::coarse_grid, "coarse-grid"},
      NamedValue{WarningCode::meet_at_start, "meet-at-start"},
  };
};

/// Warning about a result. Results list all warnings in the order in which they were found.
struct Warning {
  WarningCode code = WarningCode::left_out;
  std::string text;  ///< one sentence without a full stop

  bool operator==(const Warning&) const = default;
};

template <>
struct Description<Warning> {
  static constexpr std::string_view name = "ResultWarning";  // because Python has a Warning of its own
  static constexpr std::string_view doc = "Warning about a result";
  static constexpr std::tuple members{
      Member{"code", &Warning::code, "", "subject of the warning"},
      Member{"text", &Warning::text, "", "the warning in one sentence"},
  };
};

}  // namespace blum
