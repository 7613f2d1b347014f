#include "certificate/homology/homology_check.hpp"

#include <algorithm>
#include <optional>
#include <utility>

#include "blum/core/exact_text.hpp"
#include "certificate/homology/axis_labels.hpp"
#include "certificate/homology/closed_surfaces.hpp"
#include "certificate/homology/elimination.hpp"
#include "certificate/homology/generating_cycles.hpp"

namespace blum::verifier {
namespace {

constexpr std::size_t most_steps = 300'000'000;

/// Facts about one body.
struct BodyProof {
  bool is_compared = false;           ///< true if its Betti numbers agree and edges lie in the solid
  std::size_t generators = 0;         ///< number of generators of the axis's fundamental group in it
  bool loops_over_integers = true;    ///< true if loops of the axis span all of its first homology
  std::size_t across = 0;             ///< number of triangles that span its tunnels
  std::size_t doubtful = 0;           ///< number of edges that touch the surface, so that linking is undecided
  bool are_triangles_decided = true;  ///< true if no such edge is the side of a triangle
};

std::string counted(std::size_t count, const char* one, const char* many) {
  return count_text(count) + " " + (count == 1 ? one : many);
}

/// Checks the loops of an axis, and sets the ranks of bodies and proofs.
class Loops {
 public:
  Loops(const AxisInSolid& given, const GeneratingCycles& cycles, const Complement& complement)
      : given_(given), cycles_(cycles), complement_(complement) {}

  void look(HomologyCheck& check, std::vector<BodyCheck>& bodies, std::vector<BodyProof>& proofs,
            const Context& context) const {
    std::vector<bool> is_wanted(bodies.size());
    for (std::size_t b = 0; b < bodies.size(); ++b) is_wanted[b] = proofs[b].is_compared && bodies[b].solid[1] > 0;
    if (std::find(is_wanted.begin(), is_wanted.end(), true) == is_wanted.end()) return;
    check.paths = complement_.path_count();
    AxisLabels labels(given_, complement_, is_wanted, context);
    labels.look_at_grazing(context);
    measure(labels, is_wanted, check, bodies, proofs, context);
    const auto is_short = [&](std::size_t b) { return is_wanted[b] && bodies[b].tunnels_met < bodies[b].solid[1]; };
    bool is_any_short = false;
    for (std::size_t b = 0; b < bodies.size(); ++b) is_any_short = is_any_short || is_short(b);
    if (is_any_short && labels.look_at_thin_parts(context)) measure(labels, is_wanted, check, bodies, proofs, context);
    check.doubtful = labels.doubtful().size();
    for (const std::uint32_t e : labels.doubtful()) {
      BodyProof& proof = proofs[body_of(e)];
      ++proof.doubtful;
      if (!given_.incidence.triangles_of_edge()[e].empty()) proof.are_triangles_decided = false;
    }
  }

 private:
  [[nodiscard]] std::uint32_t body_of(std::uint32_t edge) const {
    return given_.parts.body_of[given_.incidence.edges()[edge][0]];
  }

  void measure(AxisLabels& labels, const std::vector<bool>& is_wanted, HomologyCheck& check,
               std::vector<BodyCheck>& bodies, std::vector<BodyProof>& proofs, const Context& context) const {
    count_triangles(labels, is_wanted, check, proofs, context);
    std::vector<std::vector<SparseRow>> rows(bodies.size());
    for (const std::uint32_t closing : cycles_.closing()) {
      throw_if_cancelled(context);
      const std::uint32_t body = body_of(closing);
      if (!is_wanted[body]) continue;
      if (is_doubtful(labels, closing)) continue;
      SparseRow row = linked(labels, closing);
      if (!row.empty()) rows[body].push_back(std::move(row));
    }
    for (std::size_t b = 0; b < bodies.size(); ++b) {
      throw_if_cancelled(context);
      if (!is_wanted[b]) continue;
      bodies[b].tunnels_met = static_cast<std::int64_t>(rank_modulo_2(rows[b], complement_.path_count()));
      Elimination exact(Elimination::Over::integers, complement_.path_count(), most_steps);
      for (SparseRow& row : rows[b]) exact.add(std::move(row));
      proofs[b].loops_over_integers = exact.rank() == static_cast<std::size_t>(bodies[b].solid[1]);
    }
  }

  /// Returns true if the cycle that an edge closes contains a doubtful edge.
  [[nodiscard]] bool is_doubtful(const AxisLabels& labels, std::uint32_t closing) const {
    if (labels.doubtful().empty()) return false;
    bool is_on = false;
    cycles_.walk(closing, [&](std::uint32_t e, int) { is_on = is_on || labels.is_doubtful(e); });
    return is_on;
  }

  /// Returns how often each path is linked with the cycle that an edge closes.
  [[nodiscard]] SparseRow linked(const AxisLabels& labels, std::uint32_t closing) const {
    std::vector<std::pair<std::uint32_t, std::int64_t>> crossed;
    cycles_.walk(closing, [&](std::uint32_t e, int sign) {
      for (const Label& label : labels.of(e)) crossed.emplace_back(label.segment, std::int64_t{sign} * label.times);
    });
    tidy(crossed);
    SparseRow row;
    for (const auto& [segment, times] : crossed) {
      for (const Complement::Use& use : complement_.paths_along(segment)) row.emplace_back(use.path, times * use.times);
    }
    tidy(row);
    return row;
  }

  void count_triangles(AxisLabels& labels, const std::vector<bool>& is_wanted, HomologyCheck& check,
                       std::vector<BodyProof>& proofs, const Context& context) const {
    check.triangles = 0;
    check.where = {};
    for (BodyProof& proof : proofs) proof.across = 0;
    for (const auto& corners : given_.axis.triangles) check.triangles += is_wanted[given_.parts.body_of[corners[0]]];
    const std::vector<std::uint32_t> across = labels.triangles_across(context);
    check.across = across.size();
    for (const std::uint32_t t : across) ++proofs[given_.parts.body_of[given_.axis.triangles[t][0]]].across;
    if (across.empty()) return;
    for (const std::uint32_t v : given_.axis.triangles[across.front()]) check.where += given_.axis.positions[v] / 3.0;
    check.where = check.where / given_.factor;
  }

  const AxisInSolid& given_;
  const GeneratingCycles& cycles_;
  const Complement& complement_;
};

/// Findings about loops and closed surfaces.
struct Found {
  bool is_looked_at = false;  ///< false if the solid consists of voxels
  std::vector<BodyProof> proofs;
  Windings surfaces;
};

/// Returns what is proven for a body.
Proven proven_of(const BodyCheck& body, const Found& found, std::size_t b) {
  const BodyProof& proof = found.proofs[b];
  if (!proof.is_compared) return Proven::nothing;
  const bool has_tunnels = body.solid[1] > 0;
  const bool has_voids = body.solid[2] > 0;
  if ((has_tunnels || has_voids) && !found.is_looked_at) return Proven::betti_numbers;
  if (has_tunnels && (!proof.are_triangles_decided || proof.across > 0 || body.tunnels_met != body.solid[1])) {
    return Proven::betti_numbers;
  }
  if (has_voids && (found.surfaces.undecided[b] || body.voids_met != body.solid[2])) return Proven::betti_numbers;
  const bool is_exact = proof.generators == static_cast<std::size_t>(body.solid[1]) && proof.loops_over_integers &&
                        (!has_voids || found.surfaces.over_integers);
  if (!is_exact) return Proven::homology_modulo_2;
  return has_tunnels ? Proven::homology : Proven::homotopy_type;
}

std::string sentence(Proven proven) {
  switch (proven) {
    case Proven::homotopy_type:
      return "the axis is homotopy equivalent to the solid";
    case Proven::homology:
      return "the inclusion of the axis into the solid is an isomorphism of homology";
    case Proven::homology_modulo_2:
      return "the inclusion of the axis into the solid is an isomorphism of homology modulo 2 (not shown over the "
             "integers)";
    case Proven::betti_numbers:
      return "the axis has the Betti numbers of the solid";
    default:
      return "nothing";
  }
}

/// Returns the mismatch about the loops in a body; empty if there is none.
std::string wrong_loops(const BodyCheck& body, const BodyProof& proof, const std::string& name) {
  const bool is_short = body.tunnels_met < body.solid[1];
  if (proof.doubtful > 0 && (is_short || !proof.are_triangles_decided)) {
    return "it is unknown if loops of the axis run around the " +
           counted(static_cast<std::size_t>(body.solid[1]), "tunnel", "tunnels") + " of " + name + ": " +
           counted(proof.doubtful, "edge of the axis touches", "edges of the axis touch") + " the surface";
  }
  if (!is_short) return {};
  return "loops of the axis run around " + count_text(static_cast<std::uint64_t>(body.tunnels_met)) + " of the " +
         counted(static_cast<std::size_t>(body.solid[1]), "tunnel", "tunnels") + " of " + name +
         ": its other loops run around no tunnel, or around the same tunnels";
}

/// Returns the mismatch about the closed surfaces in a body; empty if there is none.
std::string wrong_surfaces(const BodyCheck& body, const std::optional<Vec3d>& undecided, double factor,
                           const std::string& name) {
  if (undecided) {
    return "it is unknown if closed surfaces of the axis enclose the void at " +
           verifier::place_text(*undecided / factor) + " of " + name + ": triangles of the axis pass through it";
  }
  if (body.voids_met >= body.solid[2]) return {};
  return "closed surfaces of the axis enclose " + count_text(static_cast<std::uint64_t>(body.voids_met)) + " of the " +
         counted(static_cast<std::size_t>(body.solid[2]), "void", "voids") + " of " + name;
}

/// Records what is proven, and adds mismatches.
void conclude(HomologyCheck& check, const Found& found, const AxisInSolid& given, std::vector<BodyCheck>& bodies,
              const std::function<std::string(std::size_t)>& name, std::vector<std::string>& mismatches) {
  check.proven = Proven::homotopy_type;
  check.holds = true;
  const auto refuse = [&](std::string reason) {
    if (reason.empty()) return;
    check.holds = false;
    mismatches.push_back(std::move(reason));
  };
  bool has_tunnels_or_voids = false;
  for (std::size_t b = 0; b < bodies.size(); ++b) {
    BodyCheck& body = bodies[b];
    has_tunnels_or_voids = has_tunnels_or_voids || body.solid[1] > 0 || body.solid[2] > 0;
    if (found.is_looked_at) {
      body.voids_met = static_cast<std::int64_t>(found.surfaces.rank[b]);
      refuse(wrong_loops(body, found.proofs[b], name(b)));
      refuse(wrong_surfaces(body, found.surfaces.undecided[b], given.factor, name(b)));
    }
    body.proven = proven_of(body, found, b);
    check.proven = std::min(check.proven, body.proven);
  }
  if (check.across > 0) {
    refuse(counted(check.across, "triangle of the axis spans", "triangles of the axis span") +
           " a tunnel of the solid, the first one at " + verifier::place_text(check.where));
  }
  if (given.undecided_edges > 0) {
    check.proven = std::min(check.proven, Proven::betti_numbers);
    for (BodyCheck& body : bodies) body.proven = std::min(body.proven, Proven::betti_numbers);
  }
  check.shown = sentence(check.proven);
  if (given.undecided_edges > 0) {
    check.shown += "; nothing stronger is proven, because " + counted(given.undecided_edges, "edge", "edges") +
                   " may cross a gap of the solid";
  }
  if (!found.is_looked_at && has_tunnels_or_voids)
    check.shown += "; nothing stronger is proven, because the solid consists of voxels";
  if (check.across > 0) check.shown += "; nothing stronger is proven, because triangles span a tunnel of the solid";
  if (check.doubtful > 0) check.shown += "; " + counted(check.doubtful, "edge touches", "edges touch") + " the surface";
}

}  // namespace

HomologyCheck check_homology(const AxisInSolid& given, bool edges_hold, std::vector<BodyCheck>& bodies,
                             const std::function<std::string(std::size_t)>& name, std::vector<std::string>& mismatches,
                             const Context& context) {
  HomologyCheck check;
  Found found;
  found.proofs.resize(bodies.size());
  std::vector<BodyProof>& proofs = found.proofs;
  bool needs_complement = false;
  bool all_agree = true;
  for (std::size_t b = 0; b < bodies.size(); ++b) {
    const bool agrees = bodies[b].solid == bodies[b].axis;
    all_agree = all_agree && agrees;
    proofs[b].is_compared = agrees && edges_hold;
    bodies[b].proven = agrees ? Proven::betti_numbers : Proven::nothing;
    needs_complement =
        needs_complement || (proofs[b].is_compared && (bodies[b].solid[1] > 0 || bodies[b].solid[2] > 0));
  }
  if (!edges_hold || !all_agree) {
    check.proven = all_agree ? Proven::betti_numbers : Proven::nothing;
    check.shown = all_agree ? sentence(check.proven) + "; nothing stronger is proven, because edges leave the solid"
                            : "the axis has other Betti numbers than the solid";
    return check;
  }
  const auto& sides = given.incidence.sides();
  const GeneratingCycles cycles({given.axis.positions.size(),
                                 given.incidence.edges(),
                                 {sides.empty() ? nullptr : sides.front().data(), 3 * sides.size()},
                                 3},
                                context);
  for (const std::uint32_t e : cycles.closing())
    ++proofs[given.parts.body_of[given.incidence.edges()[e][0]]].generators;
  const Complement* complement = nullptr;
  if (needs_complement) complement = given.solid.solid->complement(context);
  if (complement != nullptr) {
    found.is_looked_at = true;
    Loops(given, cycles, *complement).look(check, bodies, proofs, context);
    Box3 box;
    for (std::uint32_t b = 0; b < bodies.size(); ++b) box.extend(given.solid.solid->box(b));
    found.surfaces =
        windings(given.axis.cells(), given.incidence, {given.axis.positions.begin(), given.axis.positions.end()},
                 given.parts.body_of, *complement, bodies.size(), box, context);
  }
  conclude(check, found, given, bodies, name, mismatches);
  return check;
}

}  // namespace blum::verifier
