// Blum: yes or no: do objects meet? SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "blum/core/context.hpp"
#include "blum/geometry/rigid_transform.hpp"
#include "proximity/scene_object.hpp"
#include "proximity/scene_pairs.hpp"

namespace blum::detail {

/// Returns true if a primitive of the first object meets a primitive of the second object. For an object and itself,
/// returns true if near_pairs() with Neighbours::folded would find a pair at distance 0.
/// @throws InvalidOption if the context has no threads.
/// @throws Cancelled
/// @throws InvalidMesh if more than most_candidates pairs lie on each other.
[[nodiscard]] bool meet(const TwoObjects& objects, const Context& context);

/// Returns for each transform of the second object 1 if the object then meets the first object, otherwise 0.
/// @throws as meet(); InvalidOption for the first transform that check() rejects.
[[nodiscard]] std::vector<std::uint8_t> meet_at(const SceneObject& first, const SceneObject& second,
                                                std::span<const RigidTransform> places, const Context& context);

}  // namespace blum::detail
