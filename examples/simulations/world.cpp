#include "world.hpp"

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <map>
#include <utility>

namespace simulations {
namespace {

using blum::Vec3d;

class Stopwatch {
 public:
  double lap() {
    const auto now = std::chrono::steady_clock::now();
    return std::chrono::duration<double>(now - std::exchange(start_, now)).count();
  }

 private:
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

Vec3d mean(const std::vector<Vec3d>& points) {
  Vec3d sum;
  for (const Vec3d& p : points) sum += p;
  return sum / static_cast<double>(points.size());
}

/// Barycentric coordinates of a point in a triangle.
std::array<double, 3> weights(const Vec3d& p, const std::array<Vec3d, 3>& t) {
  const Vec3d u = t[1] - t[0];
  const Vec3d v = t[2] - t[0];
  const Vec3d w = p - t[0];
  const double uu = dot(u, u), uv = dot(u, v), vv = dot(v, v), uw = dot(u, w), vw = dot(v, w);
  const double area = uu * vv - uv * uv;
  if (!(area > 0)) return {1, 0, 0};
  const double b = std::clamp((vv * uw - uv * vw) / area, 0.0, 1.0);
  const double c = std::clamp((uu * vw - uv * uw) / area, 0.0, 1.0 - b);
  return {1 - b - c, b, c};
}

}  // namespace

/// Two triangles that must keep a distance along a direction.
struct World::Contact {
  std::array<std::size_t, 2> object{};
  std::array<blum::Triangle, 2> corners{};
  std::array<std::array<double, 3>, 2> weight{};
  Vec3d normal;  ///< from the first to the second
};

std::size_t World::add(Object object) {
  object.velocity.resize(object.mesh.vertices.size());
  if (object.kind == Kind::body && object.rest.empty()) object.rest = object.mesh.vertices;
  object.id = scene_.add(object.mesh, {.self = object.kind != Kind::driven});
  objects_.emplace_back(std::move(object));
  return objects_.size() - 1;
}

void World::replace(std::size_t object, Object by) {
  by.id = objects_[object]->id;
  by.velocity.resize(by.mesh.vertices.size());
  if (by.kind == Kind::body && by.rest.empty()) by.rest = by.mesh.vertices;
  scene_.update(by.id, by.mesh);
  objects_[object] = std::move(by);
}

blum::TriangleMesh World::mesh() const {
  blum::TriangleMesh out;
  for (const auto& object : objects_) {
    if (!object) continue;
    const auto base = static_cast<std::uint32_t>(out.vertices.size());
    out.vertices.insert(out.vertices.end(), object->mesh.vertices.begin(), object->mesh.vertices.end());
    for (const auto& [a, b, c] : object->mesh.triangles) out.triangles.push_back({base + a, base + b, base + c});
  }
  return out;
}

double World::inverse_mass(std::size_t object, std::uint32_t particle) const {
  const Object& one = *objects_[object];
  const bool is_fixed = one.kind == Kind::driven || (!one.pinned.empty() && one.pinned[particle]);
  return is_fixed ? 0 : 1 / one.mass;
}

std::optional<std::size_t> World::number(blum::ObjectId id) const {
  for (std::size_t k = 0; k < objects_.size(); ++k) {
    if (objects_[k] && objects_[k]->id == id) return k;
  }
  return std::nullopt;
}

World::Positions World::predicted() const {
  Positions to(objects_.size());
  for (std::size_t k = 0; k < objects_.size(); ++k) {
    if (!objects_[k]) continue;
    const Object& object = *objects_[k];
    to[k] = object.mesh.vertices;
    for (std::uint32_t v = 0; v < to[k].size(); ++v) {
      if (inverse_mass(k, v) > 0) {
        to[k][v] += (object.velocity[v] + options_.gravity * options_.step) * options_.step;
      } else if (!object.goal.empty()) {
        to[k][v] = object.goal[v];
      }
    }
  }
  return to;
}

/// Compares bodies with themselves or not. Neighbouring triangles are always close, but are not contacts.
void World::compare_selves(bool all) {
  for (const auto& object : objects_) {
    if (object && object->kind != Kind::driven && !object->self) scene_.exclude(object->id, object->id, !all);
  }
}

/// Pairs that are close at the start of a step. Both triangles must stay on their sides.
std::vector<World::Contact> World::contacts(StepReport& report) {
  Stopwatch watch;
  compare_selves(false);
  const blum::ProximityPairs close = scene_.closer_than(2 * options_.thickness);
  compare_selves(true);
  report.close_seconds += watch.lap();
  report.close_pairs += close.pairs.size();
  std::vector<Contact> out;
  for (const blum::PrimitivePair& pair : close.pairs) {
    const Vec3d way = pair.between.second_point - pair.between.first_point;
    if (!(length(way) > 0)) continue;
    Contact contact;
    contact.object = {*number(pair.first_object), *number(pair.second_object)};
    contact.normal = way / length(way);
    const std::array<std::uint32_t, 2> primitive{pair.first, pair.second};
    const std::array<Vec3d, 2> point{pair.between.first_point, pair.between.second_point};
    for (std::size_t side = 0; side < 2; ++side) {
      const blum::TriangleMesh& mesh = objects_[contact.object[side]]->mesh;
      contact.corners[side] = mesh.triangles[primitive[side]];
      const auto& [a, b, c] = contact.corners[side];
      contact.weight[side] = weights(point[side], {mesh.vertices[a], mesh.vertices[b], mesh.vertices[c]});
    }
    out.push_back(contact);
  }
  return out;
}

void World::satisfy(const std::vector<Contact>& contacts, Positions& to) const {
  for (int round = 0; round < options_.iterations; ++round) {
    for (std::size_t k = 0; k < objects_.size(); ++k) {
      if (objects_[k]) pull_springs(k, to[k]);
    }
    for (const Contact& contact : contacts) push_apart(contact, to);
    for (std::size_t k = 0; k < objects_.size(); ++k) {
      if (objects_[k] && objects_[k]->kind == Kind::body) keep_shape(k, to[k]);
    }
  }
}

void World::pull_springs(std::size_t object, std::vector<Vec3d>& to) const {
  for (const auto& [a, b, rest, stiffness] : objects_[object]->springs) {
    const double wa = inverse_mass(object, a);
    const double wb = inverse_mass(object, b);
    const Vec3d way = to[b] - to[a];
    const double size = length(way);
    if (wa + wb == 0 || size == 0) continue;
    const Vec3d move = way * (stiffness * (size - rest) / (size * (wa + wb)));
    to[a] += move * wa;
    to[b] -= move * wb;
  }
}

void World::push_apart(const Contact& contact, Positions& to) const {
  std::array<Vec3d, 2> point{Vec3d{}, Vec3d{}};
  double sum = 0;
  for (std::size_t side = 0; side < 2; ++side) {
    for (std::size_t c = 0; c < 3; ++c) {
      const std::uint32_t v = contact.corners[side][c];
      const double weight = contact.weight[side][c];
      point[side] += to[contact.object[side]][v] * weight;
      sum += weight * weight * inverse_mass(contact.object[side], v);
    }
  }
  const double missing = options_.thickness - dot(contact.normal, point[1] - point[0]);
  if (missing <= 0 || sum == 0) return;
  for (std::size_t side = 0; side < 2; ++side) {
    const Vec3d move = contact.normal * ((side == 0 ? -missing : missing) / sum);
    for (std::size_t c = 0; c < 3; ++c) {
      const std::uint32_t v = contact.corners[side][c];
      to[contact.object[side]][v] += move * (contact.weight[side][c] * inverse_mass(contact.object[side], v));
    }
  }
}

void World::keep_shape(std::size_t object, std::vector<Vec3d>& to) const {
  constexpr double stiffness = 0.6;
  const std::vector<Vec3d>& rest = objects_[object]->rest;
  const Vec3d from = mean(rest);
  const Vec3d middle = mean(to);
  const blum::Mat3 turn = best_rotation(rest, to, from, middle);
  for (std::size_t v = 0; v < rest.size(); ++v) {
    to[v] += (turn * (rest[v] - from) + middle - to[v]) * stiffness;
  }
}

blum::SceneCollisions World::collisions(const Positions& to) const {
  std::vector<blum::ObjectMotion> motions;
  for (std::size_t k = 0; k < objects_.size(); ++k) {
    if (objects_[k]) motions.push_back({objects_[k]->id, to[k], {}});
  }
  return scene_.continuous(motions);
}

/// Shortens the ways of particles that would collide. After many rounds, particles that still collide do not move.
void World::shorten(Positions& to, StepReport& report) {
  constexpr int most_rounds = 30;
  Stopwatch watch;
  for (report.rounds = 0;; ++report.rounds) {
    const blum::SceneCollisions found = collisions(to);
    if (found.objects.empty()) break;
    if (report.rounds == 0) show(found, to, report);
    Shares shares(objects_.size());
    for (std::size_t k = 0; k < objects_.size(); ++k) shares[k].assign(to[k].size(), 1);
    for (const blum::ObjectCollisions& pair : found.objects) {
      limit(pair, report.rounds < most_rounds ? 0.8 : 0.0, shares);
    }
    for (std::size_t k = 0; k < objects_.size(); ++k) {
      if (objects_[k]) go_less_far(*objects_[k], shares[k], to[k]);
    }
  }
  report.impact_seconds += watch.lap();
}

/// Counts collisions, and records some of them.
void World::show(const blum::SceneCollisions& found, const Positions& to, StepReport& report) const {
  constexpr std::size_t most_shown = 500;
  for (const blum::ObjectCollisions& pair : found.objects) {
    report.impacts += pair.vertex_face.size() + pair.face_vertex.size() + pair.edge_edge.size();
    const std::size_t a = number(pair.first).value();
    for (const auto& one : pair.vertex_face) {
      if (report.shown.size() >= most_shown) return;
      report.shown.push_back({objects_[a]->mesh.vertices[one.vertex], to[a][one.vertex], one.time});
    }
  }
}

/// Limits the shares of colliding particles to a part of their way to contact.
void World::limit(const blum::ObjectCollisions& pair, double part, Shares& shares) const {
  const std::size_t a = number(pair.first).value();
  const std::size_t b = number(pair.second).value();
  const auto lower = [&](std::size_t k, std::uint32_t v, double time) {
    shares[k][v] = std::min(shares[k][v], part * time);
  };
  const auto vertex_face = [&](std::size_t of_vertex, std::size_t of_face, const blum::VertexFaceCollision& one) {
    lower(of_vertex, one.vertex, one.time);
    for (const std::uint32_t v : objects_[of_face]->mesh.triangles[one.face.value]) lower(of_face, v, one.time);
  };
  for (const auto& one : pair.vertex_face) vertex_face(a, b, one);
  for (const auto& one : pair.face_vertex) vertex_face(b, a, one);
  for (const auto& one : pair.edge_edge) {
    for (const std::uint32_t v : one.first) lower(a, v, one.time);
    for (const std::uint32_t v : one.second) lower(b, v, one.time);
  }
}

void World::go_less_far(const Object& object, const std::vector<double>& shares, std::vector<Vec3d>& to) {
  // A driven object is shortened as a whole.
  const bool is_driven = object.kind == Kind::driven;
  const double all = shares.empty() ? 1 : *std::min_element(shares.begin(), shares.end());
  for (std::size_t v = 0; v < to.size(); ++v) {
    const Vec3d& from = object.mesh.vertices[v];
    const double share = is_driven ? all : shares[v];
    if (share < 1) to[v] = from + (to[v] - from) * share;
  }
}

void World::accept(const Positions& to, const std::vector<Contact>& contacts, StepReport& report) {
  for (const blum::ObjectCollisions& pair : collisions(to).objects) {
    collisions_in_steps_ += pair.vertex_face.size() + pair.face_vertex.size() + pair.edge_edge.size();
  }
  std::vector<std::map<std::uint32_t, Vec3d>> touched(objects_.size());
  for (const Contact& contact : contacts) {
    for (std::size_t side = 0; side < 2; ++side) {
      for (const std::uint32_t v : contact.corners[side]) touched[contact.object[side]][v] = contact.normal;
    }
  }
  Stopwatch watch;
  for (std::size_t k = 0; k < objects_.size(); ++k) {
    if (!objects_[k]) continue;
    Object& object = *objects_[k];
    for (std::uint32_t v = 0; v < to[k].size(); ++v) {
      object.velocity[v] = (to[k][v] - object.mesh.vertices[v]) * (options_.damping / options_.step);
    }
    for (const auto& [v, normal] : touched[k]) {
      const Vec3d across = object.velocity[v] - normal * dot(normal, object.velocity[v]);
      object.velocity[v] -= across * options_.friction;
    }
    object.mesh.vertices = to[k];
    scene_.update(object.id, object.mesh.vertices);
  }
  report.hierarchy_seconds += watch.lap();
}

StepReport World::step() {
  StepReport report;
  const std::vector<Contact> close = contacts(report);
  Positions to = predicted();
  satisfy(close, to);
  shorten(to, report);
  accept(to, close, report);
  return report;
}

std::vector<Spring> springs_of(const blum::TriangleMesh& mesh, double bending) {
  std::map<std::array<std::uint32_t, 2>, std::vector<std::uint32_t>> across;
  for (const blum::Triangle& t : mesh.triangles) {
    for (std::size_t k = 0; k < 3; ++k) {
      const auto [a, b] = std::minmax(t[k], t[(k + 1) % 3]);
      across[{a, b}].push_back(t[(k + 2) % 3]);
    }
  }
  std::vector<Spring> out;
  const auto add = [&](std::uint32_t a, std::uint32_t b, double stiffness) {
    out.push_back({a, b, length(mesh.vertices[b] - mesh.vertices[a]), stiffness});
  };
  for (const auto& [edge, corners] : across) {
    add(edge[0], edge[1], 1);
    if (corners.size() == 2) add(corners[0], corners[1], bending);
  }
  return out;
}

blum::Mat3 best_rotation(const std::vector<Vec3d>& from, const std::vector<Vec3d>& to, const Vec3d& from_mean,
                         const Vec3d& to_mean) {
  std::array<Vec3d, 3> sums{};  // columns of the sum of products
  for (std::size_t k = 0; k < from.size(); ++k) {
    const Vec3d p = from[k] - from_mean;
    const Vec3d q = to[k] - to_mean;
    for (std::size_t axis = 0; axis < 3; ++axis) sums[axis] += q * p[axis];
  }
  blum::Mat3 turn;
  for (int round = 0; round < 50; ++round) {
    Vec3d torque;
    double sum = 0;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      torque += cross(turn.columns[axis], sums[axis]);
      sum += dot(turn.columns[axis], sums[axis]);
    }
    const Vec3d way = torque / (std::abs(sum) + 1e-12);
    const double angle = length(way);
    if (angle < 1e-10) break;
    const Vec3d axis = way / angle;
    for (Vec3d& column : turn.columns) {
      column = column * std::cos(angle) + cross(axis, column) * std::sin(angle) +
               axis * (dot(axis, column) * (1 - std::cos(angle)));
    }
  }
  return turn;
}

}  // namespace simulations
