// Blum: search for the first contact of moving objects. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <mutex>
#include <optional>
#include <tuple>
#include <vector>

#include "blum/core/context.hpp"
#include "blum/geometry/moving_box_bvh.hpp"
#include "blum/proximity/first_contact.hpp"
#include "blum/proximity/impact.hpp"
#include "proximity/impact_search.hpp"

namespace blum {

/// Finds the first contact of moving objects, by branch and bound. A pair of features is tested only if it may precede
/// the best contact that is known. The boxes of the pair must touch before the best contact, or at the same time if the
/// pair precedes it in the results.
class FirstSearch {
 public:
  FirstSearch(const ImpactOptions& options, const Context& context);

  /// Compares two objects, or an object with itself. Pairs of objects may be added in any order; all must exist until
  /// the search ends.
  /// @throws Cancelled
  void add(ObjectId first, const MovingObject& a, ObjectId second, const MovingObject& b);

  /// Returns true if no contact of these objects can be the first one.
  /// @param bound a lower bound on the times of the objects' contacts.
  [[nodiscard]] bool is_hopeless(ObjectId first, ObjectId second, double bound) const;

  /// Returns a lower bound of the reported times at which features in two boxes meet; infinite if they never touch.
  [[nodiscard]] double bound(const MovingBox& a, const MovingBox& b) const;

  /// Returns the first contact of all objects that were added.
  [[nodiscard]] const std::optional<FirstContact>& result() const { return best_; }

 private:
  /// Position of a pair of features in the order of results.
  struct Rank {
    double time = std::numeric_limits<double>::infinity();
    ObjectId first, second;
    ContactKind kind = ContactKind::vertex_face;
    std::uint32_t a = 0;  ///< index of the vertex, or of the edge of the first object
    std::uint32_t b = 0;  ///< index of the face, or of the edge of the second object

    friend bool operator<(const Rank& x, const Rank& y) { return x.key() < y.key(); }

    [[nodiscard]] std::tuple<double, ObjectId, ObjectId, ContactKind, std::uint32_t, std::uint32_t> key() const {
      return {time, first, second, kind, a, b};
    }
  };
  /// Objects that are compared, and the kind of their features.
  struct Side;
  /// A feature that may meet others, and a lower bound of the times.
  struct Feature {
    double bound;
    ContactKind kind;
    std::uint32_t index;

    friend bool operator<(const Feature& x, const Feature& y) {
      return std::tie(x.bound, x.kind, x.index) < std::tie(y.bound, y.kind, y.index);
    }
  };

  [[nodiscard]] static const Side& side_of(const std::vector<Side>& sides, ContactKind kind);
  [[nodiscard]] std::vector<Feature> features_of(const std::vector<Side>& sides) const;
  void probe(const std::vector<Side>& sides, const std::vector<Feature>& features);
  void look_at(const Side& side, const Feature& feature);
  void sweep(const Side& side);
  void test(const Side& side, std::uint32_t first, std::uint32_t second, double of_pair, Rank& best);
  [[nodiscard]] Rank best_rank() const;
  [[nodiscard]] static bool may_precede(const Rank& best, const Side& side, const Feature& feature);
  void offer(const Rank& rank, const Side& side);

  ImpactOptions options_;
  const Context& context_;
  int depth_;
  double step_;
  mutable std::mutex mutex_;
  Rank best_rank_;
  std::optional<FirstContact> best_;
};

}  // namespace blum
