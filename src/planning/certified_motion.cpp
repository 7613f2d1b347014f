#include "blum/planning/certified_motion.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <utility>

#include "blum/core/error.hpp"
#include "blum/core/exact_text.hpp"
#include "planning/bodies.hpp"
#include "planning/least_clearance.hpp"
#include "planning/motion_tests.hpp"
#include "planning/pose_sources.hpp"

namespace blum {
namespace {

using detail::Doubt;
using detail::MotionTests;

void check(const MotionOptions& options) {
  if (!(options.clearance >= 0 && std::isfinite(options.clearance))) {
    throw InvalidOption("motion: clearance must be 0 or more, not " + exact_text(options.clearance));
  }
  if (options.delta && !(*options.delta > 0 && std::isfinite(*options.delta))) {
    throw InvalidOption("motion: delta must be positive, not " + exact_text(*options.delta));
  }
}

/// Returns for each pair the distance above the clearance that need not be proven.
std::vector<double> deltas_of(const MotionTests& tests, const std::optional<double>& given) {
  std::vector<double> out;
  for (std::size_t pair = 0; pair < tests.pairs(); ++pair) {
    const double smallest = 8 * tests.error(pair);
    out.push_back(std::max(given ? *given : 1e-6 * tests.size(pair), smallest));
  }
  return out;
}

/// Joins meshes into one. Primitives keep their order within triangles, segments and points.
TriangleMesh join(std::span<const MeshView> meshes, std::vector<detail::Bodies::Ends>& ends) {
  TriangleMesh out;
  for (const MeshView& mesh : meshes) {
    validate(mesh);
    const auto shift = static_cast<std::uint32_t>(out.vertices.size());
    out.vertices.insert(out.vertices.end(), mesh.vertices.begin(), mesh.vertices.end());
    for (const Triangle& t : mesh.triangles) out.triangles.push_back({t[0] + shift, t[1] + shift, t[2] + shift});
    for (const Segment& s : mesh.segments) out.segments.push_back({s[0] + shift, s[1] + shift});
    for (const std::uint32_t point : mesh.points) out.points.push_back(point + shift);
    ends.push_back({out.triangles.size(), out.segments.size(), out.points.size()});
  }
  return out;
}

CertifiedMotion certify(MotionTests tests, const MotionOptions& options) {
  CertifiedMotion out;
  const std::vector<double> deltas = deltas_of(tests, options.delta);
  const std::optional<Doubt> doubt = first_doubt(tests, options.clearance, deltas);
  out.tests = tests.count();
  if (!doubt) {
    out.free_until = 1;
    return out;
  }
  out.free_until = doubt->at.from;
  if (auto contact = contact_after(tests, doubt->at)) {
    out.verdict = MotionVerdict::colliding;
    out.time = contact->first;
    out.closest = contact->second;
    return out;
  }
  out.verdict = MotionVerdict::too_close;
  out.time = doubt->at.middle();
  out.closest = tests.closest(out.time, options.clearance + deltas[doubt->pair]);
  return out;
}

}  // namespace

void detail::Bodies::name_obstacle(std::uint32_t primitive, MotionPair& pair) const {
  const Ends& all = ends.back();
  std::size_t local = primitive;
  std::size_t Ends::* kind = &Ends::triangles;
  if (local >= all.triangles) {
    local -= all.triangles;
    kind = &Ends::segments;
    if (local >= all.segments) {
      local -= all.segments;
      kind = &Ends::points;
    }
  }
  std::size_t k = 0;
  while (local >= ends[k].*kind) ++k;
  const Ends before = k == 0 ? Ends{} : ends[k - 1];
  local -= before.*kind;
  if (kind != &Ends::triangles) local += ends[k].triangles - before.triangles;
  if (kind == &Ends::points) local += ends[k].segments - before.segments;
  pair.obstacle = static_cast<std::uint32_t>(k);
  pair.other_primitive = static_cast<std::uint32_t>(local);
}

MotionCertifier::MotionCertifier(const MeshView& body, const MeshView& obstacles, const Context& context)
    : MotionCertifier(std::span(&body, 1), std::span(&obstacles, 1), context) {}

MotionCertifier::MotionCertifier(std::span<const MeshView> bodies, std::span<const MeshView> obstacles,
                                 const Context& context)
    : bodies_(std::make_unique<detail::Bodies>()) {
  if (bodies.empty()) throw InvalidOption("motion: there is no body; give at least one");
  if (bodies.size() == 1 && obstacles.empty()) {
    throw InvalidOption("motion: there is one body, but no obstacle; give an obstacle or a second body");
  }
  for (std::size_t k = 0; k < bodies.size(); ++k) {
    const std::string name = bodies.size() == 1 ? "body" : "body " + std::to_string(k);
    bodies_->bodies.emplace_back(bodies[k], name, context);
  }
  if (!obstacles.empty()) bodies_->obstacles.emplace(join(obstacles, bodies_->ends), "obstacles", context);
  for (std::size_t k = 0; k < bodies.size(); ++k) {
    if (bodies_->obstacles) bodies_->pairs.push_back({.body = k});
    for (std::size_t other = k + 1; other < bodies.size(); ++other)
      bodies_->pairs.push_back({.body = k, .other = other});
  }
}

MotionCertifier::MotionCertifier(MotionCertifier&&) noexcept = default;
MotionCertifier& MotionCertifier::operator=(MotionCertifier&&) noexcept = default;
MotionCertifier::~MotionCertifier() = default;

std::size_t MotionCertifier::size() const {
  return bodies_->bodies.size();
}

namespace {

void check_body(std::size_t body, std::size_t bodies) {
  if (body < bodies) return;
  throw InvalidOption("motion: there is no body " + std::to_string(body) + "; the bodies are numbered from 0 to " +
                      std::to_string(bodies - 1));
}

}  // namespace

void MotionCertifier::exclude(std::size_t body, std::size_t other_body) {
  check_body(body, size());
  check_body(other_body, size());
  if (body == other_body) {
    throw InvalidOption("motion: body " + std::to_string(body) +
                        " is never compared with itself, so this pair cannot be excluded; give two bodies");
  }
  const detail::BodyPair excluded{.body = std::min(body, other_body), .other = std::max(body, other_body)};
  std::erase_if(bodies_->pairs,
                [&](const detail::BodyPair& p) { return p.body == excluded.body && p.other == excluded.other; });
}

void MotionCertifier::exclude_obstacles(std::size_t body) {
  check_body(body, size());
  std::erase_if(bodies_->pairs, [&](const detail::BodyPair& p) { return p.body == body && !p.other; });
}

Vec3d MotionCertifier::centre(std::size_t body) const {
  check_body(body, size());
  return bodies_->bodies[body].bounds().center();
}

CertifiedMotion MotionCertifier::certify(const RigidMotion& motion, const MotionOptions& options,
                                         const Context& context) const {
  return certify(std::span(&motion, 1), options, context);
}

CertifiedMotion MotionCertifier::certify(std::span<const RigidMotion> motions, const MotionOptions& options,
                                         const Context& context) const {
  check(options);
  throw_if_cancelled(context);
  const detail::RigidMotions poses(*bodies_, motions);
  return blum::certify(MotionTests(*bodies_, poses, context), options);
}

CertifiedMotion MotionCertifier::certify(const BoundedMotion& motion, const MotionOptions& options,
                                         const Context& context) const {
  check(options);
  throw_if_cancelled(context);
  const detail::GivenMotion poses(*bodies_, motion);
  return blum::certify(MotionTests(*bodies_, poses, context), options);
}

MotionClearance MotionCertifier::clearance(std::span<const RigidMotion> motions, double tolerance,
                                           const Context& context) const {
  detail::check_tolerance(tolerance);
  throw_if_cancelled(context);
  const detail::RigidMotions poses(*bodies_, motions);
  std::array tests{MotionTests(*bodies_, poses, context)};
  const detail::LeastClearance found = detail::least_clearance(tests, tolerance);
  return {.at_least = found.at_least,
          .at_most = found.closest ? found.closest->distance : found.at_least,
          .time = found.time,
          .closest = found.closest,
          .tests = tests[0].count()};
}

std::optional<MotionContact> MotionCertifier::first_contact(std::span<const RigidMotion> motions, double tolerance,
                                                            const Context& context) const {
  if (!(tolerance > 0 && tolerance <= 1)) {
    throw InvalidOption("motion: tolerance must be above 0 and at most 1, not " + exact_text(tolerance));
  }
  throw_if_cancelled(context);
  const detail::RigidMotions poses(*bodies_, motions);
  MotionTests tests(*bodies_, poses, context);
  // Only rounding limits how close the surfaces may come without being in doubt.
  const std::optional<Doubt> doubt = first_doubt(tests, 0, deltas_of(tests, 0));
  if (!doubt) return std::nullopt;
  MotionContact out{.earliest = doubt->at.from};
  auto contact = contact_after(tests, doubt->at);
  if (!contact) {
    // The pair was within this distance when the search stopped.
    out.pair = *tests.closest(doubt->pair, doubt->at.middle(), HUGE_VAL);
    return out;
  }
  // Contacts before the one that was found, by bisection.
  double before = doubt->at.from;
  while (contact->first - before > tolerance) {
    const double middle = before + 0.5 * (contact->first - before);
    if (middle <= before || middle >= contact->first) break;
    const auto pair = tests.closest(middle, 0);
    if (pair && pair->distance == 0) {
      contact = {middle, *pair};
    } else {
      before = middle;
    }
  }
  out.latest = contact->first;
  out.pair = contact->second;
  return out;
}

CertifiedMotion certify_motion(const MeshView& body, const MeshView& obstacles, const RigidMotion& motion,
                               const MotionOptions& options, const Context& context) {
  return MotionCertifier(body, obstacles, context).certify(motion, options, context);
}

}  // namespace blum
