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

/// Writes pairs of primitives of a scene; the format goes by the extension.
///
///   .npz   `object` [n, 2], `primitive` [n, 2] int32; `distance` [n], `point` [n, 2, 3] float64: the closest points;
///          `feature` [n, 2, 3] int32: the one, two or three vertices of the mesh of each object that its point lies
///          on, padded with -1; `metadata`, a JSON object.
///   .csv   a row for each pair: first_object, first_primitive, second_object, second_primitive, distance, first_x,
///          first_y, first_z, second_x, second_y, second_z, first_feature_0 to _2, second_feature_0 to _2.
///   .json  an object with the metadata (max_distance and self as numbers, true and false) and the lists of .npz.
///   .vtp   VTK poly data: a line from the first to the second point of each pair, with cell data distance, object,
///          primitive, feature (six components); read_complex() reads them, too.
///
/// A file appears under its name only when it is complete.
/// @param objects  the meshes of the scene, by object.
/// @param more     further numbers of each pair, written behind those above: arrays of .npz, columns of .csv (of more
///                 than one component name_0, name_1, ...), lists of .json, cell data of .vtp. Empty, or with a row for
///                 each pair.
/// @throws InvalidOption for another extension, for pairs of objects or primitives that are not there, and for another
/// count of rows or a name above in `more`; FileError; Cancelled.
void write_proximity_pairs(const std::filesystem::path& path, std::span<const PrimitivePair> pairs,
                           std::span<const MeshView> objects, const FileMetadata& metadata = {},
                           const Columns& more = {}, const Context& context = {});

}  // namespace blum
