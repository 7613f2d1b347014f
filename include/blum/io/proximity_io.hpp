// Blum: files of close pairs of primitives. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <span>

#include "blum/complex/columns.hpp"
#include "blum/core/context.hpp"
#include "blum/geometry/triangle_mesh.hpp"
#include "blum/io/file_metadata.hpp"
#include "blum/proximity/scene.hpp"

namespace blum {

/// Writes pairs of primitives of a scene. The extension selects the format.
///
///   `.npz`   Arrays for n pairs. `object` [n, 2] and `primitive` [n, 2] are the indices of the two objects, and of the
///            primitives in the meshes of these objects (int32). `distance` [n] and `closest` [n, 2, 3], the two
///            closest points, are float64. `feature` [n, 2, 3] (int32) holds the vertices of the feature on which each
///            of the two points lies. A feature has one, two or three vertices: indices in the object's mesh, padded
///            with -1. `metadata` is a JSON object.
///   `.csv`   A row for each pair: `first_object, first_primitive, second_object, second_primitive, distance, first_x,
///            first_y, first_z, second_x, second_y, second_z`, `first_feature_0` to `_2`, `second_feature_0` to `_2`.
///   `.json`  An object with the metadata, and lists with the names of the .npz arrays. The metadata `max_distance` and
///            `self` are written as numbers, true or false, not as texts.
///   `.vtp`   VTK poly data: for each pair, a segment from its first to its second closest point. Cell data are
///            `distance`, `object`, `primitive` and `feature` (six components). read_complex() reads these files, too.
///
/// A file appears under its name only when it is complete.
/// @param objects  the mesh of each object of the scene.
/// @param more     further columns, with a row for each pair; may be empty. The further columns follow the numbers
///                 above, as arrays of .npz, columns of .csv, lists of .json, and cell data of .vtp. In .csv, a column
///                 of several components becomes name_0, name_1, ...
/// @throws InvalidOption for another extension, and for pairs with an object that is not in `objects`, or a primitive
/// that the object's mesh does not have.
/// @throws InvalidOption if `more` has another number of rows than pairs, or a column with the name of one of the .npz
/// arrays above.
/// @throws FileError, Cancelled.
void write_proximity_pairs(const std::filesystem::path& path, std::span<const PrimitivePair> pairs,
                           std::span<const MeshView> objects, const FileMetadata& metadata = {},
                           const Columns& more = {}, const Context& context = {});

}  // namespace blum
