#include "medial_axis/fit/fit_axis.hpp"

#include <cmath>
#include <cstddef>
#include <memory>

#include "medial_axis/fit/contract_short.hpp"
#include "medial_axis/fit/fitter.hpp"
#include "medial_axis/fit/merge_curves.hpp"
#include "medial_axis/fit/take_crumbs.hpp"
#include "medial_axis/fit/thin_insides.hpp"
#include "medial_axis/fit/trim.hpp"
#include "medial_axis/fit/unfold.hpp"

namespace blum {
namespace {

/// Triangles this high are two of their sides, and curves this close are one, in voxels.
constexpr double thin = 0.02;
constexpr double thin_if_round = 0.2;
constexpr double beside = 0.1;
/// Radius in walls much thinner than cells, in voxels.
constexpr double far_below_a_voxel = 0.05;
/// Sheets up to this size, in square voxels, that lie this close to others, in voxels, go.
constexpr double crumb = 16;
constexpr double on_others = 0.2;
/// Edges this long that stick out of a rim are a part of its sheet, in voxels.
constexpr double whiskers = 1;

/// The steps one after the other. What is told by the triangles alone is kept from step to step while these stay.
class Fitting {
 public:
  Fitting(AxisLists& lists, const FitTarget& target, const Context& context)
      : lists_(lists), target_(target), context_(context) {}

  using Step = double (Fitter::*)();

  /// @return  how far the furthest vertex went, voxels.
  double take(Step step) { return (fitter().*step)() / target_.voxel; }
  double take(Step step, const ShortLengths& lengths) {
    const double furthest = take(step);
    contract(lengths);
    return furthest;
  }
  void contract(const ShortLengths& lengths) {
    if (contract_short(lists_, fitter().incidence(), target_.surface, target_.voxel, lengths, context_)) {
      fitter_.reset();
    }
  }
  /// Takes away what lies beyond the angle and can go, or on other cells.
  /// @return  whether there was anything.
  bool trim_excess() {
    const std::size_t before = lists_.triangles.size() + lists_.edges.size();
    const double voxel = target_.voxel;
    const TrimLimits limits{target_.theta, thin * voxel, thin_if_round * voxel, whiskers * voxel, beside * voxel};
    if (trim(lists_, fitter().incidence(), fitter().angles(), limits, context_)) fitter_.reset();
    merge();
    return lists_.triangles.size() + lists_.edges.size() != before;
  }
  void bend_curves() {
    if (fitter().bend_curves()) fitter_.reset();
    merge();
  }
  /// @return  how far sheets moved, mesh units.
  double thin_out() {
    if (!(target_.tolerance > 0)) return 0;
    const double moved = thin_insides(lists_, fitter().incidence(), target_, context_);
    fitter_.reset();
    return moved;
  }
  /// @param most_radius  voxels: only where radii are this small.
  void take_folds_away(double most_radius) {
    const UnfoldLimits limits{target_.voxel, most_radius * target_.voxel};
    if (unfold(lists_, fitter().incidence(), target_.surface, limits, context_)) fitter_.reset();
  }
  void take_crumbs_away() {
    const double voxel = target_.voxel;
    const CrumbLimits limits{crumb * voxel * voxel, on_others * voxel};
    if (take_crumbs(lists_, fitter().incidence(), limits, context_)) fitter_.reset();
  }

 private:
  void merge() {
    if (merge_curves(lists_, target_.surface, beside * target_.voxel, context_)) fitter_.reset();
  }
  Fitter& fitter() {
    if (!fitter_) fitter_ = std::make_unique<Fitter>(lists_, target_, known_, context_);
    return *fitter_;
  }

  AxisLists& lists_;
  const FitTarget& target_;
  const Context& context_;
  Fitter::Known known_;
  std::unique_ptr<Fitter> fitter_;
};

}  // namespace

double fit_axis(AxisLists& lists, const FitTarget& target, const Context& context) {
  constexpr ShortLengths nothing{};
  constexpr ShortLengths inside{.on_seams = 0, .on_rims = 0};
  constexpr ShortLengths with_seams{.on_seams = 0.6, .at_corners = 2};
  constexpr ShortLengths with_rims{.on_seams = 0.6, .on_rims = 0.3, .of_crumbs = 1.5, .at_corners = 2, .of_slivers = 4};
  Fitting fitting(lists, target, context);
  fitting.take(&Fitter::find_centres);
  fitting.trim_excess();
  // Of vertices close beside each other one is put on its sheet, not all.
  fitting.contract(inside);
  fitting.take(&Fitter::find_sheets, nothing);
  // Where walls are much closer than the cells, these tell nothing of the order of vertices along the walls.
  fitting.take_folds_away(far_below_a_voxel);
  const double moved = fitting.thin_out();
  fitting.take(&Fitter::place_seams, with_seams);
  fitting.take(&Fitter::place_seams, with_seams);
  fitting.take(&Fitter::straighten, with_seams);
  fitting.take(&Fitter::straighten, with_seams);
  fitting.take(&Fitter::cut_rims, with_seams);
  double furthest_cut = fitting.take(&Fitter::cut_rims, with_rims);
  bool is_changed = fitting.trim_excess();
  fitting.take(&Fitter::place_seams, with_rims);
  fitting.bend_curves();
  // What one round changes may show what the next one is for, and ends of curves go far in several steps.
  constexpr int most_rounds = 3;
  constexpr double far = 0.5;
  for (int round = 0; round < most_rounds; ++round) {
    is_changed = fitting.take(&Fitter::take_back, with_rims) > 0 || is_changed;
    is_changed = fitting.trim_excess() || is_changed;
    if (!is_changed && furthest_cut < far) break;
    furthest_cut = fitting.take(&Fitter::cut_rims, with_rims);
    is_changed = false;
  }
  fitting.take(&Fitter::cut_rims_short);
  fitting.take(&Fitter::place_curves);
  fitting.bend_curves();
  fitting.take_folds_away(HUGE_VAL);
  fitting.take_crumbs_away();
  return moved;
}

}  // namespace blum
