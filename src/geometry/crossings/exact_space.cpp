#include "geometry/crossings/exact_space.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <stdexcept>
#include <utility>

#include "blum/geometry/orient2d.hpp"
#include "blum/geometry/orient3d.hpp"

namespace blum::detail {
namespace {

constexpr double half_ulp = 0x1p-53;
constexpr int mantissa_bits = 53;

std::array<std::uint64_t, 3> key_of(const Vec3d& p) {
  const auto bits = [](double x) { return std::bit_cast<std::uint64_t>(x == 0 ? 0.0 : x); };
  return {bits(p.x), bits(p.y), bits(p.z)};
}

/// Projects a point along an axis by dropping that coordinate. Orientations are then as seen against the axis.
std::array<double, 2> flat(const Vec3d& p, std::size_t axis) {
  return {p[(axis + 1) % 3], p[(axis + 2) % 3]};
}

std::array<ExactInteger, 3> cross_product(const std::array<ExactInteger, 3>& u, const std::array<ExactInteger, 3>& v) {
  return {u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]};
}

ExactInteger dot_product(const std::array<ExactInteger, 3>& u, const std::array<ExactInteger, 3>& v) {
  return u[0] * v[0] + u[1] * v[1] + u[2] * v[2];
}

}  // namespace

std::size_t ExactSpace::PlaceHash::operator()(const std::array<std::uint64_t, 3>& key) const {
  std::uint64_t hash = 0;
  for (const std::uint64_t part : key) {
    hash = (hash ^ part) * 0x9e3779b97f4a7c15U;
    hash ^= hash >> 29;
  }
  return hash;
}

ExactSpace::ExactSpace(std::span<const Vec3d> vertices, std::span<const PointId> used) : vertices_(vertices) {
  int lowest = 0;
  for (const PointId v : used) {
    for (std::size_t a = 0; a < 3; ++a) {
      if (vertices[v][a] == 0) continue;
      int exponent = 0;
      const auto mantissa = static_cast<std::int64_t>(std::ldexp(std::frexp(vertices[v][a], &exponent), mantissa_bits));
      lowest = std::min(lowest, exponent - mantissa_bits + std::countr_zero(static_cast<std::uint64_t>(mantissa)));
    }
    at_place_.try_emplace(key_of(vertices[v]), v);
  }
  shift_ = -lowest;
  if (shift_ > most_bits) throw std::range_error("coordinates are too many orders of magnitude apart");
}

ExactInteger ExactSpace::whole(double coordinate) const {
  if (coordinate == 0) return {};
  int exponent = 0;
  const auto mantissa = static_cast<std::int64_t>(std::ldexp(std::frexp(coordinate, &exponent), mantissa_bits));
  const int up = exponent - mantissa_bits + shift_;
  const ExactInteger value = mantissa;
  return up >= 0 ? value << static_cast<std::size_t>(up) : value >> static_cast<std::size_t>(-up);
}

const ExactSpace::Exact& ExactSpace::exact(PointId p) const {
  if (!is_vertex(p)) return made_[p - vertices_.size()].exact;
  const auto [at, is_new] = of_vertex_.try_emplace(p);
  if (is_new) {
    for (std::size_t a = 0; a < 3; ++a) at->second.at[a] = whole(vertices_[p][a]);
    at->second.weight = 1;
  }
  return at->second;
}

int ExactSpace::compare(PointId a, PointId b, std::size_t axis) const {
  // Compares rounded coordinates first: rounding preserves order.
  const double x = rounded(a)[axis];
  const double y = rounded(b)[axis];
  if (x != y) return x < y ? -1 : 1;
  if (a == b || (is_vertex(a) && is_vertex(b))) return 0;
  const Exact& p = exact(a);
  const Exact& q = exact(b);
  return (p.at[axis] * q.weight - q.at[axis] * p.weight).sign();
}

int ExactSpace::compare(PointId a, PointId b) const {
  for (std::size_t axis = 0; axis < 3; ++axis) {
    if (const int order = compare(a, b, axis); order != 0) return order;
  }
  return 0;
}

std::optional<int> ExactSpace::filtered_side(const Cut& cut, const Vec3d& p) const {
  const Vec3d& a = vertices_[cut.corners[0]];
  const Vec3d u = vertices_[cut.corners[1]] - a;
  const Vec3d v = vertices_[cut.corners[2]] - a;
  const Vec3d w = p - a;
  double value = 0;
  double error = 0;
  for (std::size_t i = 0; i < 3; ++i) {
    const double left = u[(i + 1) % 3] * v[(i + 2) % 3];
    const double right = u[(i + 2) % 3] * v[(i + 1) % 3];
    const double size = std::abs(left) + std::abs(right);
    value += (left - right) * w[i];
    error += size * (orient3d_rounding * std::abs(w[i]) + 4 * half_ulp * std::abs(p[i]));
  }
  if (std::abs(value) > error) return value > 0 ? 1 : -1;
  return std::nullopt;
}

int ExactSpace::side(const Cut& cut, PointId p) const {
  if (cut.axis >= 0) return turn(static_cast<std::size_t>(cut.axis), cut.corners[0], cut.corners[1], p);
  if (is_vertex(p)) {
    return orient3d(vertices_[cut.corners[0]], vertices_[cut.corners[1]], vertices_[cut.corners[2]], vertices_[p]);
  }
  if (const std::optional<int> found = filtered_side(cut, rounded(p))) return *found;
  return height(plane(cut), exact(p)).sign();
}

std::optional<int> ExactSpace::filtered_turn(std::size_t axis, PointId a, PointId b, PointId c) const {
  const std::array<double, 2> p = flat(rounded(a), axis);
  const std::array<double, 2> q = flat(rounded(b), axis);
  const std::array<double, 2> r = flat(rounded(c), axis);
  std::array<double, 2> off{};  // bound on the error of a difference of rounded coordinates
  for (std::size_t k = 0; k < 2; ++k) {
    off[k] = 8 * half_ulp * std::max({std::abs(p[k]), std::abs(q[k]), std::abs(r[k])});
  }
  const double ux = q[0] - p[0];
  const double uy = q[1] - p[1];
  const double vx = r[0] - p[0];
  const double vy = r[1] - p[1];
  const double value = ux * vy - uy * vx;
  const double error = (std::abs(ux) + std::abs(vx) + off[0]) * off[1] +
                       (std::abs(uy) + std::abs(vy) + off[1]) * off[0] +
                       8 * half_ulp * (std::abs(ux * vy) + std::abs(uy * vx));
  if (std::abs(value) > error) return value > 0 ? 1 : -1;
  return std::nullopt;
}

int ExactSpace::turn(std::size_t axis, PointId a, PointId b, PointId c) const {
  if (is_vertex(a) && is_vertex(b) && is_vertex(c)) {
    return orient2d(flat(vertices_[a], axis), flat(vertices_[b], axis), flat(vertices_[c], axis));
  }
  if (const std::optional<int> found = filtered_turn(axis, a, b, c)) return *found;
  const std::size_t i = (axis + 1) % 3;
  const std::size_t j = (axis + 2) % 3;
  const Exact& p = exact(a);
  const Exact& q = exact(b);
  const Exact& r = exact(c);
  const ExactInteger value = p.at[i] * (q.at[j] * r.weight - r.at[j] * q.weight) -
                             p.at[j] * (q.at[i] * r.weight - r.at[i] * q.weight) +
                             p.weight * (q.at[i] * r.at[j] - q.at[j] * r.at[i]);
  return value.sign();
}

ExactSpace::Plane ExactSpace::plane(const Cut& cut) const {
  const auto minus = [&](PointId p, PointId q) {
    std::array<ExactInteger, 3> out;
    for (std::size_t a = 0; a < 3; ++a) out[a] = exact(p).at[a] - exact(q).at[a];
    return out;
  };
  const std::array<ExactInteger, 3> along = minus(cut.corners[1], cut.corners[0]);
  Plane out;
  if (cut.axis >= 0) {
    const auto axis = static_cast<std::size_t>(cut.axis);
    out.normal[(axis + 1) % 3] = -along[(axis + 2) % 3];
    out.normal[(axis + 2) % 3] = along[(axis + 1) % 3];
  } else {
    out.normal = cross_product(along, minus(cut.corners[2], cut.corners[0]));
  }
  out.offset = -dot_product(out.normal, exact(cut.corners[0]).at);
  return out;
}

ExactInteger ExactSpace::height(const Plane& plane, const Exact& p) {
  return dot_product(plane.normal, p.at) + plane.offset * p.weight;
}

PointId ExactSpace::add(Exact exact) {
  if (exact.weight.sign() < 0) {
    exact.weight = -exact.weight;
    for (ExactInteger& x : exact.at) x = -x;
  }
  std::size_t twos = exact.weight.twos();
  for (const ExactInteger& x : exact.at) twos = x.sign() == 0 ? twos : std::min(twos, x.twos());
  if (twos > 0) {
    exact.weight = exact.weight >> twos;
    for (ExactInteger& x : exact.at) x = x >> twos;
  }
  Vec3d rounded;
  for (std::size_t a = 0; a < 3; ++a) {
    rounded[a] = ExactInteger::rounded_ratio(exact.at[a], exact.weight, -shift_);
  }
  const auto id = static_cast<PointId>(size());
  const auto [place, is_new] = at_place_.try_emplace(key_of(rounded), id);
  std::optional<PointId> next;
  if (!is_new) {
    const auto is_equal = [&](const Exact& other) {
      for (std::size_t a = 0; a < 3; ++a) {
        if (!(other.at[a] * exact.weight == exact.at[a] * other.weight)) return false;
      }
      return true;
    };
    for (std::optional<PointId> at = place->second; at;
         at = is_vertex(*at) ? std::nullopt : made_[*at - vertices_.size()].next) {
      if (is_equal(this->exact(*at))) return *at;
    }
    // A vertex has no `next`, so it stays last in its list.
    next = place->second;
    place->second = id;
  }
  made_.push_back({std::move(exact), rounded, next});
  return id;
}

PointId ExactSpace::meet(PointId from, PointId to, const Cut& cut) {
  const Plane through = plane(cut);
  const Exact& p = exact(from);
  const Exact& q = exact(to);
  const ExactInteger hp = height(through, p);
  const ExactInteger hq = height(through, q);
  Exact out;
  for (std::size_t a = 0; a < 3; ++a) out.at[a] = p.at[a] * hq - q.at[a] * hp;
  out.weight = hq - hp;
  return add(std::move(out));
}

PointId ExactSpace::meet(const Cut& a, const Cut& b, const Cut& c) {
  const Plane p = plane(a);
  const Plane q = plane(b);
  const Plane r = plane(c);
  const std::array<ExactInteger, 3> qr = cross_product(q.normal, r.normal);
  const std::array<ExactInteger, 3> rp = cross_product(r.normal, p.normal);
  const std::array<ExactInteger, 3> pq = cross_product(p.normal, q.normal);
  Exact out;
  for (std::size_t k = 0; k < 3; ++k) out.at[k] = -(p.offset * qr[k] + q.offset * rp[k] + r.offset * pq[k]);
  out.weight = dot_product(p.normal, qr);
  return add(std::move(out));
}

std::array<PointId, 3> ExactSpace::corners_around(std::size_t axis) {
  // All coordinates have a magnitude of at most 2.
  constexpr std::array<std::array<int, 2>, 3> places{{{-8, -8}, {24, -8}, {-8, 24}}};
  std::array<PointId, 3> out{};
  for (std::size_t k = 0; k < 3; ++k) {
    Exact exact;
    Vec3d rounded{0, 0, 0};
    for (std::size_t d = 0; d < 2; ++d) {
      const std::size_t along = (axis + 1 + d) % 3;
      exact.at[along] = ExactInteger(places[k][d]) << static_cast<std::size_t>(shift_);
      rounded[along] = places[k][d];
    }
    exact.weight = 1;
    out[k] = static_cast<PointId>(size());
    made_.push_back({std::move(exact), rounded, std::nullopt});
  }
  return out;
}

}  // namespace blum::detail
