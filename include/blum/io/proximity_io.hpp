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
///   `.npz`   `object` [n, 2] and `primitive` [n, 2] are int32. `distance` [n] and `point` [n, 2, 3], the closest
///            points, are float64. `feature` [n, 2, 3] int32 holds the one, two or three vertices that each point lies
///            on, padded with -1. They are vertices of the mesh of the point's object. `metadata` is a JSON object.
///   `.csv`   A row for each pair: `first_object, first_primitive, second_object, second_primitive, distance, first_x,
///            first_y, first_z, second_x, second_y, second_z`, `first_feature_0` to `_2`, `second_feature_0` to `_2`.
///   `.json`  An object with the metadata (max_distance and self as numbers, true and false) and the lists of .npz.
///   `.vtp`   VTK poly data: a line from the first to the second point of each pair. Cell data are `distance`,
///            `object`, `primitive` and `feature` (six components). read_complex() reads these files, too.
///
/// A file appears under its name only when it is complete.
/// @param objects  the meshes of the scene, by object.
/// @param more     further numbers of each pair, written after those above. They are arrays of .npz, columns of .csv,
///                 lists of .json, and cell data of .vtp. In .csv, columns of several components are name_0, name_1,
///                 ... It is empty or has a row for each pair.
/// @throws InvalidOption for another extension, and for pairs of objects or primitives that are not given.
/// @throws InvalidOption for another count of rows, or a name listed above, in `more`.
/// @throws FileError, Cancelled.
void write_proximity_pairs(const std::filesystem::path& path, std::span<const PrimitivePair> pairs,
                           std::span<const MeshView> objects, const FileMetadata& metadata = {},
                           const Columns& more = {}, const Context& context = {});

}  // namespace blum
