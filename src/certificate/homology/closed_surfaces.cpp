#include "certificate/homology/closed_surfaces.hpp"

#include <algorithm>
#include <map>
#include <memory>
#include <optional>
#include <utility>

#include "blum/complex/complex.hpp"
#include "certificate/box_hierarchy.hpp"
#include "certificate/homology/edge_labels.hpp"

namespace blum::verifier {
namespace {

using Face = std::array<std::uint32_t, 3>;

constexpr std::uint32_t none = 0xffffffffU;

/// Returns true if a triangle traverses one of its sides from the lower vertex to the higher one.
bool rises(const Face& face, std::size_t side) {
  return face[side] < face[(side + 1) % 3];
}

/// The triangles in bodies with voids that remain after triangles with free edges are removed. Duplicates are left out.
class Core {
 public:
  Core(const ComplexView& axis, const Incidence& incidence, const std::vector<bool>& is_wanted)
      : axis_(axis), incidence_(incidence), is_in_(axis.triangles.size(), false) {
    for (std::size_t t = 0; t < is_in_.size(); ++t) is_in_[t] = is_wanted[axis.triangles[t][0]];
    take_doubles();
    std::vector<std::uint32_t> count(incidence.edges().size(), 0);
    std::vector<std::uint32_t> free;
    for_each([&](std::uint32_t t) {
      for (const std::uint32_t e : incidence.sides()[t]) ++count[e];
    });
    for (std::uint32_t e = 0; e < count.size(); ++e) {
      if (count[e] == 1) free.push_back(e);
    }
    while (!free.empty()) {
      const std::uint32_t e = free.back();
      free.pop_back();
      if (count[e] != 1) continue;
      for (const std::uint32_t t : at_edge(e)) {
        is_in_[t] = false;
        for (const std::uint32_t side : incidence.sides()[t]) {
          if (--count[side] == 1) free.push_back(side);
        }
      }
    }
  }

  template <class Use>
  void for_each(const Use& use) const {
    for (std::uint32_t t = 0; t < is_in_.size(); ++t) {
      if (is_in_[t]) use(t);
    }
  }
  /// Returns the remaining triangles at an edge.
  [[nodiscard]] std::vector<std::uint32_t> at_edge(std::uint32_t e) const {
    std::vector<std::uint32_t> found;
    for (const std::uint32_t t : incidence_.triangles_of_edge()[e]) {
      if (is_in_[t]) found.push_back(t);
    }
    return found;
  }
  [[nodiscard]] const Face& face(std::uint32_t t) const { return axis_.triangles[t]; }
  /// Returns 1 if a triangle traverses one of its sides from the lower vertex to the higher one, otherwise -1.
  [[nodiscard]] int sign(std::uint32_t t, std::uint32_t edge) const {
    const auto& sides = incidence_.sides()[t];
    const auto side = static_cast<std::size_t>(std::find(sides.begin(), sides.end(), edge) - sides.begin());
    return rises(face(t), side) ? 1 : -1;
  }
  [[nodiscard]] const Incidence& incidence() const { return incidence_; }
  [[nodiscard]] std::size_t size() const { return is_in_.size(); }

 private:
  /// Keeps only the first of several triangles with the same sides.
  void take_doubles() {
    const auto sorted = [&](std::uint32_t t) {
      Face sides = incidence_.sides()[t];
      std::sort(sides.begin(), sides.end());
      return sides;
    };
    for (std::uint32_t t = 0; t < is_in_.size(); ++t) {
      if (!is_in_[t]) continue;
      const Face own = sorted(t);
      for (const std::uint32_t other : incidence_.triangles_of_edge()[own[0]]) {
        if (other > t && is_in_[other] && sorted(other) == own) is_in_[other] = false;
      }
    }
  }

  ComplexView axis_;
  const Incidence& incidence_;
  std::vector<bool> is_in_;
};

/// Sheets: triangles that are connected over edges of two triangles. They get consistent orientations as far as
/// possible.
class Sheets {
 public:
  explicit Sheets(const Core& core) : sheet_(core.size(), none), facing_(core.size(), 0) {
    std::vector<std::uint32_t> line;
    core.for_each([&](std::uint32_t first) {
      if (sheet_[first] != none) return;
      const std::uint32_t sheet = count();
      two_sided_.push_back(true);
      first_.push_back(first);
      sheet_[first] = sheet;
      facing_[first] = 1;
      line.assign(1, first);
      while (!line.empty()) {
        const std::uint32_t t = line.back();
        line.pop_back();
        for (const std::uint32_t e : core.incidence().sides()[t]) {
          const auto both = core.at_edge(e);
          if (both.size() != 2) continue;
          const std::uint32_t other = both[0] == t ? both[1] : both[0];
          const int wanted = core.sign(t, e) == core.sign(other, e) ? -facing_[t] : facing_[t];
          if (sheet_[other] != none) {
            if (facing_[other] != wanted) two_sided_[sheet] = false;
            continue;
          }
          sheet_[other] = sheet;
          facing_[other] = static_cast<std::int8_t>(wanted);
          line.push_back(other);
        }
      }
    });
  }

  [[nodiscard]] std::uint32_t count() const { return static_cast<std::uint32_t>(first_.size()); }
  [[nodiscard]] std::uint32_t of(std::uint32_t triangle) const { return sheet_[triangle]; }
  [[nodiscard]] int facing(std::uint32_t triangle) const { return facing_[triangle]; }
  [[nodiscard]] bool is_two_sided(std::uint32_t sheet) const { return two_sided_[sheet]; }
  [[nodiscard]] std::uint32_t first_triangle(std::uint32_t sheet) const { return first_[sheet]; }

 private:
  std::vector<std::uint32_t> sheet_;
  std::vector<std::int8_t> facing_;
  std::vector<bool> two_sided_;
  std::vector<std::uint32_t> first_;
};

/// The border of each sheet: how often it runs along each seam, with sign. Seams with the same sheets and signs are
/// counted once.
struct Borders {
  std::vector<SparseRow> rows;
  std::uint32_t columns = 0;

  Borders(const Core& core, const Sheets& sheets) : rows(sheets.count()) {
    std::map<SparseRow, std::uint32_t> known;
    for (std::uint32_t e = 0; e < core.incidence().edges().size(); ++e) {
      const auto around = core.at_edge(e);
      if (around.size() < 3) continue;
      SparseRow seam;
      for (const std::uint32_t t : around) seam.emplace_back(sheets.of(t), sheets.facing(t) * core.sign(t, e));
      tidy_keeping_parity(seam);
      if (seam.empty() || !known.try_emplace(seam, columns).second) continue;
      for (const auto& [sheet, times] : seam) rows[sheet].emplace_back(columns, times);
      ++columns;
    }
  }

 private:
  /// Adds up the entries of each sheet, and makes the first entry positive.
  static void tidy_keeping_parity(SparseRow& row) {
    tidy(row);
    if (row.empty() || row.front().second > 0) return;
    for (auto& entry : row) entry.second = -entry.second;
  }
};

/// Counts crossings of sheets with lines from the voids to a far point.
class VoidLines {
 public:
  VoidLines(const Core& core, const Sheets& sheets, const std::vector<Vec3d>& positions,
            const std::vector<std::uint32_t>& body_of, const Complement& complement, const Apex& apex,
            const Context& context)
      : core_(core), sheets_(sheets), positions_(positions), body_of_(body_of), complement_(complement), apex_(apex) {
    core_.for_each([&](std::uint32_t t) {
      Box3& box = boxes_.emplace_back();
      for (const std::uint32_t v : core_.face(t)) box.extend(apex.seen(positions_[v]));
      triangles_.push_back(t);
    });
    tree_ = BoxHierarchy(boxes_, context);
  }

  /// Adds to each sheet's row how often the line from a point of each void crosses the sheet.
  /// @param choice  index of the point of a void to use; its last point if it has fewer.
  /// @return        for each void: true if a crossing is undecided.
  [[nodiscard]] std::vector<bool> add(std::size_t choice, std::uint32_t first_column, std::vector<SparseRow>& rows,
                                      const Context& context) const {
    std::vector<bool> is_doubtful(complement_.voids().size(), false);
    for (std::uint32_t k = 0; k < complement_.voids().size(); ++k) {
      throw_if_cancelled(context);
      const Complement::Void& own = complement_.voids()[k];
      const Vec3d point = own.points[std::min(choice, own.points.size() - 1)];
      const Vec3d seen = apex_.seen(point);
      const double room = apex_.rounding();
      const auto meets = [&](const Box3& box) {
        return box.lower.x <= seen.x + room && seen.x - room <= box.upper.x && box.lower.y <= seen.y + room &&
               seen.y - room <= box.upper.y && box.lower.z <= seen.z + room;
      };
      tree_.visit_where(meets, [&](std::uint32_t place) {
        const std::uint32_t item = tree_.order()[place];
        const std::uint32_t t = triangles_[item];
        const auto [a, b, c] = core_.face(t);
        if (!meets(boxes_[item]) || body_of_[a] != own.body) return true;
        const auto times = apex_.crossing_above(point, positions_[a], positions_[b], positions_[c]);
        if (!times) is_doubtful[k] = true;
        if (times.value_or(0) != 0) rows[sheets_.of(t)].emplace_back(first_column + k, sheets_.facing(t) * *times);
        return true;
      });
    }
    for (SparseRow& row : rows) tidy(row);
    return is_doubtful;
  }

 private:
  const Core& core_;
  const Sheets& sheets_;
  const std::vector<Vec3d>& positions_;
  const std::vector<std::uint32_t>& body_of_;
  const Complement& complement_;
  Apex apex_;
  std::vector<Box3> boxes_;
  std::vector<std::uint32_t> triangles_;
  BoxHierarchy tree_;
};

constexpr std::size_t most_steps = 300'000'000;

/// Returns for each cycle of a body's sheets its winding numbers around the voids; nullopt if the elimination is
/// incomplete.
std::optional<std::vector<SparseRow>> wound(Elimination::Over over, const std::vector<SparseRow>& rows,
                                            const std::vector<bool>& is_taken, std::uint32_t columns) {
  Elimination seams(over, columns, most_steps);
  for (std::size_t s = 0; s < rows.size(); ++s) {
    if (is_taken[s]) seams.add(rows[s]);
  }
  if (!seams.is_complete()) return std::nullopt;
  return seams.left();
}

/// Winding numbers of the closed surfaces in one body, from the rows of its sheets.
struct Wound {
  std::size_t rank = 0;
  bool over_integers = false;
};

Wound wound_in(std::uint32_t body, std::size_t voids, const Core& core, const Sheets& sheets,
               const std::vector<std::uint32_t>& body_of, const std::vector<SparseRow>& rows, std::uint32_t seams,
               std::uint32_t columns) {
  std::vector<bool> is_own(sheets.count());
  std::vector<bool> is_own_and_two_sided(sheets.count());
  for (std::uint32_t s = 0; s < sheets.count(); ++s) {
    is_own[s] = body_of[core.face(sheets.first_triangle(s))[0]] == body;
    is_own_and_two_sided[s] = is_own[s] && sheets.is_two_sided(s);
  }
  Wound result;
  const auto around = wound(Elimination::Over::two, rows, is_own, seams);
  if (around) result.rank = rank_modulo_2(*around, columns);
  const auto exact = wound(Elimination::Over::integers, rows, is_own_and_two_sided, seams);
  Elimination all(Elimination::Over::integers, columns, most_steps);
  if (exact) {
    for (const SparseRow& row : *exact) all.add(row);
  }
  result.over_integers = all.rank() == voids;
  return result;
}

}  // namespace

Windings windings(const ComplexView& axis, const Incidence& incidence, const std::vector<Vec3d>& positions,
                  const std::vector<std::uint32_t>& body_of, const Complement& complement, std::size_t body_count,
                  const Box3& box, const Context& context) {
  constexpr std::uint32_t most_attempts = 4;
  Windings result{std::vector<std::size_t>(body_count, 0), true, std::vector<std::optional<Vec3d>>(body_count)};
  if (complement.voids().empty()) return result;
  std::vector<std::size_t> voids(body_count, 0);
  std::size_t choices = 0;
  for (const Complement::Void& one : complement.voids()) {
    ++voids[one.body];
    choices = std::max(choices, one.points.size());
  }
  std::vector<bool> is_wanted(positions.size());
  for (std::size_t v = 0; v < is_wanted.size(); ++v) is_wanted[v] = voids[body_of[v]] > 0;
  const Core core(axis, incidence, is_wanted);
  const Sheets sheets(core);
  const Borders borders(core, sheets);
  std::vector<std::unique_ptr<VoidLines>> lines;  // one for each far point
  const auto void_count = static_cast<std::uint32_t>(complement.voids().size());
  std::vector<bool> is_decided(body_count, false);
  std::vector<bool> is_decided_by_rows(body_count, false);  // for the previous choice
  std::vector<SparseRow> rows;
  for (std::size_t choice = 0; choice < choices; ++choice) {
    const std::vector<SparseRow> rows_before = std::exchange(rows, {});
    std::vector<bool> is_doubtful(void_count, true);
    for (std::uint32_t attempt = 0; attempt < most_attempts; ++attempt) {
      if (std::find(is_doubtful.begin(), is_doubtful.end(), true) == is_doubtful.end()) break;
      if (attempt == lines.size()) {
        const Apex apex(box, attempt);
        lines.push_back(std::make_unique<VoidLines>(core, sheets, positions, body_of, complement, apex, context));
      }
      rows = borders.rows;
      is_doubtful = lines[attempt]->add(choice, borders.columns, rows, context);
    }
    std::vector<bool> is_decided_now(body_count, true);
    for (std::uint32_t k = 0; k < void_count; ++k) {
      const Complement::Void& one = complement.voids()[k];
      if (!is_doubtful[k]) continue;
      is_decided_now[one.body] = false;
      if (!is_decided[one.body]) result.undecided[one.body] = one.points.front();
    }
    const bool is_same = rows == rows_before;
    for (std::uint32_t body = 0; body < body_count; ++body) {
      if (voids[body] == 0 || !is_decided_now[body] || (is_same && is_decided_by_rows[body])) continue;
      const Wound own =
          wound_in(body, voids[body], core, sheets, body_of, rows, borders.columns, borders.columns + void_count);
      result.rank[body] = is_decided[body] ? std::min(result.rank[body], own.rank) : own.rank;
      result.over_integers = result.over_integers && own.over_integers;
      is_decided[body] = true;
      result.undecided[body].reset();
    }
    is_decided_by_rows = std::move(is_decided_now);
  }
  return result;
}

}  // namespace blum::verifier
