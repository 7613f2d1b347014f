#include "blum/surface_map/surface_deviation.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "blum/core/exact_text.hpp"
#include "blum/core/parallel.hpp"
#include "blum/core/scale.hpp"
#include "blum/field/closest_points.hpp"
#include "surface_map/cut_surface.hpp"
#include "surface_map/deviation_piece.hpp"
#include "surface_map/linear_values.hpp"
#include "surface_map/triangle_sides.hpp"
#include "surface_map/weighted_statistics.hpp"

namespace blum {
namespace {

using surface::DeviationBounds;
using surface::DeviationPiece;
using surface::LinearValue;
using surface::LongSum;

constexpr std::size_t pieces_per_range = 64;
/// Greatest number of pieces. This number takes about 150 gigabytes.
constexpr std::size_t most_pieces = 1'000'000'000;
/// Greatest number of pieces that one piece is divided into before the statistics are computed again.
constexpr std::size_t most_per_piece = 256;
/// Number of pieces whose statistics take as long as the bounds of thousands of pieces.
constexpr std::size_t many_pieces = 20'000;
/// Number of searches for one closest point that take as long as sharpen().
constexpr std::size_t search_share = 7;
/// A mesh is cut at once if it has more triangles than the number of pieces divided by this.
constexpr std::size_t triangles_for_cut = 4;
/// Greatest number of bounds for one piece and its parts.
constexpr std::size_t least_per_piece = 4;

using Bounds = std::pair<double, double>;

/// Statistics of all pieces, in the units of the search.
struct Statistics {
  double mean = 0;
  double mean_error = 0;
  double rms = 0;
  double rms_error = 0;
  double mean_magnitude = 0;
  double largest_magnitude = 0;
  std::pair<double, double> smallest;  ///< bounds
  std::pair<double, double> largest;
  std::vector<double> lower, upper;  ///< bounds of the percentiles
};

double middle(const std::pair<double, double>& bounds) {
  return bounds.first + (bounds.second - bounds.first) / 2;
}

double half_width(const std::pair<double, double>& bounds) {
  return (bounds.second - bounds.first) / 2;
}

/// Divides a surface into pieces until the statistics are precise enough.
class DeviationSearch {
 public:
  /// @param mesh, other  scaled so that the largest coordinate of both is about 1.
  /// @param area_scale   the scaled mesh times this has a size of about 1.
  /// @param tolerance    largest error of statistics; nullopt: `usual` or a tenth of the mean, if that is smaller.
  DeviationSearch(const MeshView& mesh, const MeshView& other, double area_scale, std::optional<double> tolerance,
                  double usual, const DeviationOptions& options, const Context& context)
      : mesh_(mesh),
        other_(other),
        query_(other, {options.sign, {}}, context),
        tolerance_(tolerance),
        usual_(usual),
        most_(options.pieces),
        context_(context) {
    make_pieces(area_scale);
  }

  [[nodiscard]] Statistics find() {
    Statistics found = statistics();
    while (spent_ < most_ - most_ / 8) {  // the last few would take many rounds
      const std::vector<std::uint32_t> wanted = pieces_to_divide(found);
      if (wanted.empty()) break;
      divide(wanted);
      found = statistics();
    }
    add_percentiles(found, tolerance_of(found) / 1000);
    return found;
  }

  [[nodiscard]] const ClosestPointQuery& query() const { return query_; }
  [[nodiscard]] std::size_t size() const { return pieces_.size(); }
  /// Returns the area of all pieces, in square units of the constructor's `area_scale`.
  [[nodiscard]] double area() const { return area_; }

 private:
  /// Makes a piece of each triangle with an area. Its bounds follow from the distance of its centroid. If the mesh has
  /// many triangles, they are cut into all pieces at once: many wide bounds take less time than a few narrow bounds.
  void make_pieces(double area_scale) {
    const bool is_cut = mesh_.triangles.size() > most_ / triangles_for_cut;
    if (is_cut) {
      const double size = tolerance_.value_or(0);
      const std::vector<surface::CutPiece> cut =
          surface::cut_surface(mesh_, static_cast<double>(most_ * search_share), size, context_);
      pieces_.reserve(cut.size());
      for (const surface::CutPiece& one : cut) add_piece(one.corners, one.area * area_scale * area_scale);
    } else {
      for (std::size_t t = 0; t < mesh_.triangles.size(); ++t) {
        const std::array<Vec3d, 3> p = triangle_corners(mesh_, t);
        add_piece(p, length(cross((p[1] - p[0]) * area_scale, (p[2] - p[0]) * area_scale)) / 2);
      }
    }
    if (pieces_.empty()) return;
    std::vector<Vec3d> centroids;
    LongSum area;
    centroids.reserve(pieces_.size());
    for (const DeviationPiece& piece : pieces_) {
      area.add(piece.area);
      centroids.push_back(surface::centroid_of(piece.corners));
    }
    area_ = area.value();
    const std::vector<ClosestPoint> found = query_.nearest(centroids, context_);
    for (std::size_t k = 0; k < pieces_.size(); ++k) surface::set_around(pieces_[k], found[k].distance);
    spent_ = is_cut ? most_ : pieces_.size() / search_share;
  }

  void add_piece(const std::array<Vec3d, 3>& corners, double area) {
    if (!(area > 0)) return;
    DeviationPiece& piece = pieces_.emplace_back();
    piece.corners = corners;
    piece.area = area;
  }

  /// Extends the bounds of the smallest and the largest value by a value that occurs.
  static void include(Statistics& out, double value, double error) {
    const double low = value - error;
    const double high = value + error;
    out.smallest = {std::min(out.smallest.first, low), std::min(out.smallest.second, high)};
    out.largest = {std::max(out.largest.first, low), std::max(out.largest.second, high)};
  }

  [[nodiscard]] Statistics statistics() {
    Statistics out;
    LongSum mean, mean_error, square, square_error, magnitude;
    out.smallest = {HUGE_VAL, HUGE_VAL};
    out.largest = {-HUGE_VAL, -HUGE_VAL};
    for (const DeviationPiece& piece : pieces_) {
      for (std::size_t k = 0; k < 3; ++k) {
        include(out, piece.value[k], piece.error[k]);
      }
      if (piece.is_round) include(out, piece.inner, piece.error[0]);
    }
    out.largest_magnitude = std::max(std::abs(out.smallest.first), std::abs(out.largest.second));
    const double unit = out.largest_magnitude > 0 ? out.largest_magnitude : 1;  // squares must not underflow
    for (const DeviationPiece& piece : pieces_) {
      mean.add(piece.area * piece.mean_value);
      mean_error.add(piece.area * piece.mean_error());
      magnitude.add(piece.area * std::abs(piece.mean_value));
      square.add(piece.area * piece.mean_square(unit));
      square_error.add(piece.area * piece.mean_square_error());
    }
    out.mean = mean.value() / area_;
    out.mean_error = mean_error.value() / area_;
    out.mean_magnitude = magnitude.value() / area_;
    out.rms = unit * std::sqrt(square.value() / area_);
    out.rms_error = std::sqrt(square_error.value() / area_);
    return out;
  }

  /// Adds the bounds of percentiles. @param error  they may be about this much wider than needed.
  void add_percentiles(Statistics& found, double error) const {
    double largest = 0;
    for (const DeviationPiece& piece : pieces_) largest = std::max(largest, piece.largest_error());
    const bool are_exact = largest <= error;
    const std::vector<Bounds> low = percentiles_of(are_exact ? 0 : -1, error);
    const std::vector<Bounds> high = are_exact ? low : percentiles_of(1, error);
    found.lower.clear();
    found.upper.clear();
    for (std::size_t k = 0; k < low.size(); ++k) {
      found.lower.push_back(low[k].first - (are_exact ? largest : 0));
      found.upper.push_back(high[k].second + (are_exact ? largest : 0));
    }
  }

  /// Returns bounds on the percentiles of the values plus the errors times `side`.
  /// @param error  bounds may be this far apart.
  [[nodiscard]] std::vector<Bounds> percentiles_of(double side, double error) const {
    std::vector<surface::RoundValues> rounds;
    rounds.reserve(pieces_.size());  // so that pointers stay valid
    std::vector<LinearValue> values;
    values.reserve(pieces_.size());
    for (const DeviationPiece& piece : pieces_) {
      if (piece.is_round) {
        rounds.push_back(bounds_->round_values(piece));
        const double shift = side * piece.error[0];
        const auto [low, high] = piece.values();
        values.push_back(
            {low + shift, low + shift, high + shift, piece.area, &rounds.back(), piece.inner < 0 ? -1.0 : 1.0, shift});
        continue;
      }
      const auto at = [&](std::size_t k) { return piece.value[k] + side * piece.error[k]; };
      values.push_back(surface::linear_value(at(0), at(1), at(2), piece.area));
    }
    return surface::percentiles(values, SurfaceDeviation::percents, error, context_);
  }

  /// Returns the largest error that is wanted.
  [[nodiscard]] double tolerance_of(const Statistics& found) const {
    const double usual = std::min(usual_, 0.1 * (found.mean_magnitude + found.mean_error));
    return std::max(tolerance_.value_or(usual), 1e-14);
  }

  /// Returns the pieces that must be divided to make the statistics more precise, in rising order. Returns none if all
  /// statistics are precise enough.
  [[nodiscard]] std::vector<std::uint32_t> pieces_to_divide(Statistics& found) {
    const double tolerance = 0.99 * tolerance_of(found);  // rounding is added later
    const bool is_mean_wanted = found.mean_error > tolerance || found.rms_error > tolerance;
    const double of_percentiles = (tolerance_ ? 1 : 2) * tolerance;
    Ranges by_area;
    // If the mean is not precise enough, pieces are divided whatever the percentiles.
    if (!is_mean_wanted) add_percentiles(found, tolerance / 20);
    for (std::size_t k = 0; k < found.lower.size(); ++k) {
      const std::pair bounds{found.lower[k], found.upper[k]};
      if (half_width(bounds) > of_percentiles) by_area.push_back(bounds);
    }
    Ranges of_corners;
    for (const auto& bounds : {found.smallest, found.largest}) {
      if (half_width(bounds) > of_percentiles) of_corners.push_back(bounds);
    }
    goal_ = 0.9 * (is_mean_wanted ? tolerance : of_percentiles);
    std::vector<std::uint32_t> out;
    // Mean errors of pieces usually decide, but only small largest errors guarantee small errors of all statistics.
    for (const bool is_strict : {false, true}) {
      for (std::uint32_t k = 0; k < pieces_.size(); ++k) {
        const bool is_large = pieces_[k].largest_error() > goal_;
        const bool is_bad = is_strict ? is_large : pieces_[k].mean_error() > goal_;
        if ((is_bad && (is_mean_wanted || meets(pieces_[k], by_area))) || (is_large && meets(pieces_[k], of_corners))) {
          out.push_back(k);
        }
      }
      if (!out.empty()) break;
    }
    keep_worst(out);
    keep_most_useful(out);
    return out;
  }

  using Ranges = std::vector<Bounds>;
  static bool meets(const DeviationPiece& piece, const Ranges& ranges) {
    if (ranges.empty()) return false;
    const auto [low, high] = piece.range();
    return std::any_of(ranges.begin(), ranges.end(), [low = low, high = high](const std::pair<double, double>& bounds) {
      return low <= bounds.second && high >= bounds.first;
    });
  }

  /// Keeps the pieces with the largest errors, and sets the goal. Results for these pieces may show that other pieces
  /// need no division.
  void keep_worst(std::vector<std::uint32_t>& wanted) {
    // Many pieces are divided in few rounds, because each computes all statistics again.
    const std::size_t least = pieces_.size() / (pieces_.size() < many_pieces ? 6 : 3) + 1;
    if (wanted.size() <= least) return;
    std::vector<double> errors;
    for (const std::uint32_t k : wanted) errors.push_back(pieces_[k].mean_error());
    std::nth_element(errors.begin(), errors.begin() + static_cast<std::ptrdiff_t>(least), errors.end(),
                     std::greater<>());
    const double most = *std::max_element(errors.begin(), errors.begin() + static_cast<std::ptrdiff_t>(least));
    goal_ = std::max(goal_, std::min(most / 4, errors[least]));
    std::erase_if(wanted, [&](std::uint32_t k) { return pieces_[k].mean_error() < errors[least]; });
  }

  /// Keeps as many pieces as may still be divided: those that contribute most to the error of the mean.
  void keep_most_useful(std::vector<std::uint32_t>& wanted) const {
    const std::size_t left = (most_ - spent_) / least_per_piece + 1;
    if (wanted.size() <= left) return;
    const auto weight = [&](std::uint32_t k) { return pieces_[k].area * pieces_[k].mean_error(); };
    std::nth_element(
        wanted.begin(), wanted.begin() + static_cast<std::ptrdiff_t>(left), wanted.end(),
        [&](std::uint32_t a, std::uint32_t b) { return weight(a) != weight(b) ? weight(a) > weight(b) : a < b; });
    wanted.resize(left);
    std::sort(wanted.begin(), wanted.end());
  }

  void divide(const std::vector<std::uint32_t>& wanted) {
    if (!bounds_) bounds_.emplace(other_, query_.sign_rule() == SignRule::none ? nullptr : &query_, context_);
    const std::size_t each = std::clamp<std::size_t>((most_ - spent_) / wanted.size(), least_per_piece, most_per_piece);
    struct Divided {
      std::vector<DeviationPiece> pieces;
      std::size_t spent = 0;
    };
    std::vector<Divided> parts((wanted.size() + pieces_per_range - 1) / pieces_per_range);
    parallel_for(context_, wanted.size(), pieces_per_range, "", [&](const WorkRange& range) {
      Divided& part = parts[range.begin / pieces_per_range];
      for (std::size_t k = range.begin; k < range.end; ++k) {
        part.spent += divide(pieces_[wanted[k]], each, part.pieces);
      }
    });
    std::size_t next = 0;
    std::size_t kept = 0;
    for (std::size_t k = 0; k < pieces_.size(); ++k) {
      if (next < wanted.size() && wanted[next] == k) {
        ++next;
      } else {
        pieces_[kept++] = pieces_[k];
      }
    }
    pieces_.resize(kept);
    for (Divided& part : parts) {
      pieces_.insert(pieces_.end(), part.pieces.begin(), part.pieces.end());
      spent_ += part.spent;
      part = {};
    }
  }

  /// Divides one piece at least once, until no mean error of its parts is above the goal.
  /// @param most  number of bounds that may be computed, at least `least_per_piece`.
  /// @param out   receives the parts.
  /// @return      the number of bounds that were computed.
  std::size_t divide(const DeviationPiece& piece, std::size_t most, std::vector<DeviationPiece>& out) const {
    std::vector<DeviationPiece> open{piece};
    std::size_t spent = 0;
    while (!open.empty()) {
      DeviationPiece now = open.back();
      open.pop_back();
      if (!now.is_sharp) {
        const DeviationPiece before = now;
        bounds_->sharpen(now);
        if (now.mean_error() > before.mean_error()) {
          now = before;
          now.is_sharp = true;
        }
        ++spent;
      }
      if ((spent > 0 && now.mean_error() <= goal_) || spent + 3 > most) {
        out.push_back(now);
        continue;
      }
      const std::vector<DeviationPiece> parts = bounds_->parts(now, most - spent);
      open.insert(open.end(), parts.begin(), parts.end());
      spent += parts.size();
    }
    return spent;
  }

  MeshView mesh_;
  MeshView other_;
  ClosestPointQuery query_;
  std::optional<double> tolerance_;
  double usual_;
  std::size_t most_;
  const Context& context_;
  std::optional<DeviationBounds> bounds_;
  std::vector<DeviationPiece> pieces_;
  double area_ = 0;
  double goal_ = 0;        ///< largest mean error of a piece that is not divided further
  std::size_t spent_ = 0;  ///< number of bounds that were computed
};

void check(const DeviationOptions& options) {
  if (options.pieces < 1 || options.pieces > most_pieces) {
    throw InvalidOption("pieces is " + std::to_string(options.pieces) + ", but must be 1 to " +
                        std::to_string(most_pieces));
  }
  if (options.max_error && !(*options.max_error > 0 && std::isfinite(*options.max_error))) {
    throw InvalidOption("max_error is " + exact_text(*options.max_error) + ", but must be a number above 0");
  }
}

/// Returns a copy of vertices, multiplied by a factor.
std::vector<Vec3d> scaled(std::span<const Vec3d> vertices, double scale) {
  std::vector<Vec3d> out(vertices.begin(), vertices.end());
  for (Vec3d& v : out) v *= scale;
  return out;
}

}  // namespace

SurfaceDeviation surface_deviation(const MeshView& mesh, const MeshView& other, const DeviationOptions& options,
                                   const Context& context) {
  validate(mesh);
  validate(other);
  check(options);
  Box3 box = bounds(mesh);
  const double own = scale_to_one(box.largest_coordinate());
  box.extend(bounds(other));
  const double scale = scale_to_one(box.largest_coordinate());
  const std::array<std::vector<Vec3d>, 2> vertices{scaled(mesh.vertices, scale), scaled(other.vertices, scale)};
  std::array<MeshView, 2> meshes{mesh, other};
  for (std::size_t k = 0; k < 2; ++k) meshes[k].vertices = vertices[k];
  std::optional<double> tolerance = options.max_error;
  if (tolerance) *tolerance *= scale;
  DeviationSearch search(meshes[0], meshes[1], own / scale, tolerance, box.diagonal() * scale / 2000, options, context);
  if (!(search.area() > 0)) throw InvalidMesh("no triangle of the mesh has an area, so there is no surface to measure");
  const Statistics found = search.find();
  const ClosestPointQuery& query = search.query();

  SurfaceDeviation out;
  const double rounding = 4e-15 * (1 + box.largest_coordinate() * scale + found.largest_magnitude);
  // If the sign may change at points that are not on the other mesh, it may differ within a piece.
  const bool may_jump = query.sign_may_jump();
  out.mean = found.mean / scale;
  out.mean_error = (found.mean_error + rounding + (may_jump ? 2 * found.mean_magnitude : 0)) / scale;
  out.rms = found.rms / scale;
  out.rms_error = (found.rms_error + rounding) / scale;
  const double least = query.sign_rule() == SignRule::none ? 0 : -HUGE_VAL;
  double percentile_error = std::max(half_width(found.smallest), half_width(found.largest));
  out.smallest = std::max(middle(found.smallest), least) / scale;
  out.largest = middle(found.largest) / scale;
  for (std::size_t k = 0; k < out.percentiles.size(); ++k) {
    const std::pair bounds{found.lower[k], found.upper[k]};
    out.percentiles[k] = std::max(middle(bounds), least) / scale;
    percentile_error = std::max(percentile_error, half_width(bounds));
  }
  out.percentile_error = (percentile_error + rounding + (may_jump ? 2 * found.largest_magnitude : 0)) / scale;
  out.area = search.area() / own / own;
  out.pieces = search.size();
  out.sign_rule = query.sign_rule();
  out.sign_reason = query.sign_reason();
  out.warnings = query.warnings();
  return out;
}

}  // namespace blum
