// Blum: what results say of inputs that can be used, but look as if something else were meant.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <string_view>
#include <tuple>

#include "blum/core/describe.hpp"

namespace blum {

/// What a warning is about, for programs that act on it: texts may change, codes stay.
enum class WarningCode : std::uint8_t {
  form_not_certified,  ///< an axis in a better form was not certified
  not_certified,       ///< a result is not certified
  grid_moved,          ///< an axis was certified on a grid that was moved by a part of a voxel, not on the first one
  reversed_shells,     ///< shells or triangles faced the wrong way and were reversed
  solid_of_voxels,     ///< a mesh bounds no polyhedron, so that its solid is known as voxels
  crossings_removed,   ///< a mesh crosses itself: the result is that of the mesh without the crossings
  other_solid,         ///< options name another solid than the file of an axis
  other_vertices,      ///< vertices were merged, or equal ones are apart, so that the mesh may be another one than was
                       ///< meant
  left_out,            ///< parts of an input or a result were left out
  open_mesh,           ///< a mesh has a boundary where a closed one is meant
  facing,              ///< triangles face different ways, or into the solid
  nothing_inside,      ///< no node of a field is inside
  nothing_found,       ///< nothing of what was asked for is there
  other_topology,      ///< a result has another topology than its solid
  single_layer,        ///< an image has one layer of voxels, which are a plate
  rounded,             ///< a file holds rounded numbers, and what was certain of the exact ones need not be of these
  not_extended,        ///< rims of an axis were not extended
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
  };
};

/// One thing that a result warns of. Results carry all of them, in the order in which they were found.
struct Warning {
  WarningCode code = WarningCode::left_out;
  std::string text;  ///< one sentence without a full stop

  bool operator==(const Warning&) const = default;
};

template <>
struct Description<Warning> {
  static constexpr std::string_view name = "ResultWarning";  // as Python's own Warning is another thing
  static constexpr std::string_view doc = "One thing that a result warns of";
  static constexpr std::tuple members{
      Member{"code", &Warning::code, "", "what it is about"},
      Member{"text", &Warning::text, "", "one sentence"},
  };
};

}  // namespace blum
