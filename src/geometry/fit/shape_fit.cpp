#include "geometry/fit/shape_fit.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <utility>

namespace blum::detail {
namespace {

using Matrix = std::array<std::array<double, 3>, 3>;

void add_outer(Matrix& to, const Vec3d& v, double weight) {
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t k = 0; k < 3; ++k) to[i][k] += weight * v[i] * v[k];
  }
}

/// Sets the element (p, q) of a symmetric matrix to 0 by a rotation, and applies the rotation to the columns of `turn`.
void rotate(Matrix& m, Matrix& turn, std::size_t p, std::size_t q) {
  if (m[p][q] == 0) return;
  const double ratio = (m[q][q] - m[p][p]) / (2 * m[p][q]);
  const double t = (ratio >= 0 ? 1.0 : -1.0) / (std::abs(ratio) + std::hypot(ratio, 1.0));
  const double c = 1 / std::hypot(t, 1.0);
  const double s = t * c;
  for (std::size_t k = 0; k < 3; ++k) {
    const double a = m[k][p], b = m[k][q];
    m[k][p] = c * a - s * b;
    m[k][q] = s * a + c * b;
  }
  for (std::size_t k = 0; k < 3; ++k) {
    const double a = m[p][k], b = m[q][k];
    m[p][k] = c * a - s * b;
    m[q][k] = s * a + c * b;
  }
  for (std::size_t k = 0; k < 3; ++k) {
    const double a = turn[k][p], b = turn[k][q];
    turn[k][p] = c * a - s * b;
    turn[k][q] = s * a + c * b;
  }
}

/// Returns the unit eigenvector of the smallest eigenvalue of a symmetric matrix, by Jacobi's method.
Vec3d least_direction(Matrix m) {
  Matrix turn{{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};
  for (int sweep = 0; sweep < 12; ++sweep) {
    rotate(m, turn, 0, 1);
    rotate(m, turn, 0, 2);
    rotate(m, turn, 1, 2);
  }
  std::size_t least = 0;
  for (std::size_t k = 1; k < 3; ++k) {
    if (m[k][k] < m[least][least]) least = k;
  }
  const Vec3d out{turn[0][least], turn[1][least], turn[2][least]};
  return out / length(out);
}

/// Returns two unit vectors that are orthogonal to an axis and to each other.
std::array<Vec3d, 2> across(const Vec3d& axis) {
  const Vec3d a{std::abs(axis.x), std::abs(axis.y), std::abs(axis.z)};
  Vec3d other{1, 0, 0};
  if (a.y <= a.x && a.y <= a.z)
    other = {0, 1, 0};
  else if (a.z <= a.x)
    other = {0, 0, 1};
  const Vec3d u = cross(axis, other) / length(cross(axis, other));
  return {u, cross(axis, u)};
}

constexpr std::size_t most = 6;
using Row = std::array<double, most>;

/// Solves the normal equations of a least-squares problem with up to six unknowns, by Cholesky's method.
class NormalEquations {
 public:
  explicit NormalEquations(std::size_t size) : size_(size) {}

  void add(const Row& row, double value) {
    for (std::size_t i = 0; i < size_; ++i) {
      right_[i] += row[i] * value;
      for (std::size_t k = 0; k <= i; ++k) left_[i][k] += row[i] * row[k];
    }
  }
  /// Returns the solution; nullopt if the unknowns are not determined.
  std::optional<Row> solve() {
    for (std::size_t i = 0; i < size_; ++i) {
      const double whole = left_[i][i];
      for (std::size_t k = 0; k <= i; ++k) {
        double sum = left_[i][k];
        for (std::size_t j = 0; j < k; ++j) sum -= left_[i][j] * left_[k][j];
        if (k < i) {
          left_[i][k] = sum / left_[k][k];
        } else {
          if (!(sum > 1e-13 * whole)) return std::nullopt;
          left_[i][i] = std::sqrt(sum);
        }
      }
    }
    Row out = right_;
    for (std::size_t i = 0; i < size_; ++i) {
      for (std::size_t k = 0; k < i; ++k) out[i] -= left_[i][k] * out[k];
      out[i] /= left_[i][i];
    }
    for (std::size_t i = size_; i-- > 0;) {
      for (std::size_t k = i + 1; k < size_; ++k) out[i] -= left_[k][i] * out[k];
      out[i] /= left_[i][i];
    }
    return out;
  }

 private:
  std::size_t size_;
  std::array<Row, most> left_{};
  Row right_{};
};

Vec3d mean_of(std::span<const Vec3d> points) {
  Vec3d sum;
  for (const Vec3d& p : points) sum += p;
  return sum / static_cast<double>(points.size());
}

ShapeModel fit_plane(std::span<const Vec3d> points, const Vec3d& normal) {
  ShapeModel out;
  out.point = mean_of(points);
  Matrix spread{};
  for (const Vec3d& p : points) add_outer(spread, p - out.point, 1);
  out.axis = least_direction(spread);
  if (dot(out.axis, normal) < 0) out.axis = -out.axis;
  return out;
}

/// Means of positions, and of directions e, weighted. For points c + r e, the radius r follows from their covariance.
struct RadialStart {
  double weight = 0, product = 0, square = 0;
  Vec3d place, direction;

  void add(const Vec3d& p, const Vec3d& e, double w) {
    weight += w;
    place += w * p;
    direction += w * e;
    product += w * dot(p, e);
    square += w * squared_length(e);
  }
  /// Returns the radius, which is negative if the directions point to the centre.
  [[nodiscard]] std::optional<double> radius() const {
    const double spread = square - squared_length(direction) / weight;
    if (!(spread > 1e-12 * square)) return std::nullopt;
    return (product - dot(place, direction) / weight) / spread;
  }
  [[nodiscard]] Vec3d centre(double radius) const { return (place - radius * direction) / weight; }
};

std::optional<ShapeModel> start_of_sphere(std::span<const FacePlace> faces) {
  RadialStart sums;
  for (const FacePlace& face : faces) sums.add(face.middle, face.normal, face.weight);
  const std::optional<double> radius = sums.radius();
  if (!radius) return std::nullopt;
  ShapeModel out;
  out.kind = SurfaceKind::sphere;
  out.radius = std::abs(*radius);
  out.side = *radius < 0 ? -1 : 1;
  out.point = sums.centre(*radius);
  return out;
}

/// Returns the direction with which all normals make nearly the same angle. For cylinders this is a right angle.
Vec3d axis_of(std::span<const FacePlace> faces, bool is_right) {
  Vec3d mean;
  double weight = 0;
  for (const FacePlace& face : faces) {
    mean += face.weight * face.normal;
    weight += face.weight;
  }
  mean = is_right ? Vec3d{} : mean / weight;
  Matrix spread{};
  for (const FacePlace& face : faces) add_outer(spread, face.normal - mean, face.weight);
  return least_direction(spread);
}

/// Returns a cylinder, or a cone, whose normals are those of the faces. Points are c + t a + (r + t g) e for the axis a
/// and the directions e of normals across the axis. The growth g follows from the angle between normals and axis.
std::optional<ShapeModel> start_around_axis(SurfaceKind kind, std::span<const FacePlace> faces) {
  ShapeModel out;
  out.kind = kind;
  out.axis = axis_of(faces, kind == SurfaceKind::cylinder);
  double along = 0, weight = 0;
  for (const FacePlace& face : faces) {
    along += face.weight * dot(face.normal, out.axis);
    weight += face.weight;
  }
  along = kind == SurfaceKind::cone ? along / weight : 0;
  if (kind == SurfaceKind::cone && !(std::abs(along) > 1e-6 && std::abs(along) < 1 - 1e-6)) return std::nullopt;
  const double growth = -along / std::sqrt(1 - along * along);
  const Vec3d origin = faces.front().middle;
  RadialStart sums;
  for (const FacePlace& face : faces) {
    const Vec3d e = face.normal - dot(face.normal, out.axis) * out.axis;
    const double size = length(e);
    if (!(size > 0)) return std::nullopt;
    const Vec3d way = face.middle - origin;
    const double t = dot(way, out.axis);
    sums.add(way - t * out.axis - (growth * t / size) * e, e / size, face.weight);
  }
  const std::optional<double> radius = sums.radius();
  if (!radius) return std::nullopt;
  out.radius = std::abs(*radius);
  out.side = *radius < 0 ? -1 : 1;
  out.slope = out.side * std::atan(growth);
  out.point = origin + sums.centre(*radius);
  return out;
}

/// Points on an axis have no direction across it. Points closer to the axis of a cone than this share of the radius
/// count as the apex.
constexpr double apex_share = 1e-3;

bool is_apex(const ShapeModel& model, const Vec3d& p) {
  if (model.kind != SurfaceKind::cone) return false;
  const Vec3d way = p - model.point;
  return length(way - dot(way, model.axis) * model.axis) < apex_share * model.radius;
}

/// Adds the equations of an apex to those of a cone: the vertex is on the axis, where the radius is 0.
void add_apex(const ShapeModel& model, const std::array<Vec3d, 2>& plane, const Vec3d& p, NormalEquations& equations) {
  const Vec3d way = p - model.point;
  const double t = dot(way, model.axis), c = std::cos(model.slope), s = std::sin(model.slope);
  equations.add({-c, 0, -t * c, 0, 0, 0}, -c * dot(way, plane[0]));
  equations.add({0, -c, 0, -t * c, 0, 0}, -c * dot(way, plane[1]));
  equations.add({0, 0, 0, 0, -c, model.radius * s - t * c}, model.radius * c + t * s);
}

/// One row of the linear problem: derivatives of the distance of a point by the parameters.
Row row_of(const ShapeModel& model, const std::array<Vec3d, 2>& plane, const Vec3d& p) {
  const Vec3d way = p - model.point;
  if (model.kind == SurfaceKind::sphere) {
    const Vec3d e = way / length(way);
    return {-e.x, -e.y, -e.z, -1};
  }
  const double t = dot(way, model.axis);
  const Vec3d q = way - t * model.axis;
  const double size = length(q);
  const std::array<double, 2> e{dot(q, plane[0]) / size, dot(q, plane[1]) / size};
  const double c = std::cos(model.slope), s = std::sin(model.slope);
  const double tilt = -t * c - size * s;
  return {-e[0] * c, -e[1] * c, e[0] * tilt, e[1] * tilt, -c, -(size - model.radius) * s - t * c};
}

void move(ShapeModel& model, const std::array<Vec3d, 2>& plane, const Row& step) {
  if (model.kind == SurfaceKind::sphere) {
    model.point += Vec3d{step[0], step[1], step[2]};
    model.radius += step[3];
    return;
  }
  model.point += step[0] * plane[0] + step[1] * plane[1];
  model.axis += step[2] * plane[0] + step[3] * plane[1];
  model.axis = model.axis / length(model.axis);
  model.radius += step[4];
  if (model.kind == SurfaceKind::cone) model.slope += step[5];
}

/// Moves a shape's point along the axis to the point closest to `beside`.
void slide(ShapeModel& model, const Vec3d& beside) {
  if (model.kind != SurfaceKind::cylinder && model.kind != SurfaceKind::cone) return;
  const double t = dot(beside - model.point, model.axis);
  model.point += t * model.axis;
  model.radius += t * std::tan(model.slope);
}

}  // namespace

int parameters_of(SurfaceKind kind) {
  if (kind == SurfaceKind::plane) return 3;
  return kind == SurfaceKind::sphere ? 4 : kind == SurfaceKind::cylinder ? 5 : 6;
}

double ShapeModel::distance(const Vec3d& p) const {
  const Vec3d way = p - point;
  if (kind == SurfaceKind::plane) return dot(way, axis);
  if (kind == SurfaceKind::sphere) return length(way) - radius;
  const double t = dot(way, axis);
  const double out = length(way - t * axis) - radius;
  return kind == SurfaceKind::cylinder ? out : out * std::cos(slope) - t * std::sin(slope);
}

Vec3d ShapeModel::normal(const Vec3d& p) const {
  if (kind == SurfaceKind::plane) return axis;
  Vec3d way = p - point;
  if (kind != SurfaceKind::sphere) way -= dot(way, axis) * axis;
  const double size = length(way);
  if (!(size > (kind == SurfaceKind::cone ? apex_share : 1e-9) * radius)) return {};
  const Vec3d e = (side / size) * way;
  return kind == SurfaceKind::cone ? std::cos(slope) * e - (side * std::sin(slope)) * axis : e;
}

std::optional<ShapeModel> refit_shape(const ShapeModel& near, std::span<const Vec3d> points, double tolerance,
                                      double precision) {
  if (near.kind == SurfaceKind::plane) return fit_plane(points, near.axis);
  ShapeModel out = near;
  const Vec3d middle = mean_of(points);
  const auto count = static_cast<std::size_t>(parameters_of(near.kind));
  constexpr int most_steps = 15, steps_to_converge = 7;
  double before = 0;
  for (int k = 0; k < most_steps; ++k) {
    slide(out, middle);
    const std::array<Vec3d, 2> plane = near.kind == SurfaceKind::sphere ? std::array<Vec3d, 2>{} : across(out.axis);
    NormalEquations equations(count);
    double farthest = 0;
    for (const Vec3d& p : points) {
      const double distance = out.distance(p);
      farthest = std::max(farthest, std::abs(distance));
      if (is_apex(out, p)) {
        add_apex(out, plane, p, equations);
        continue;
      }
      const Row row = row_of(out, plane, p);
      if (std::isfinite(row[0])) equations.add(row, -distance);
    }
    // Converging steps square the error. Steps towards a bad fit soon stop reducing the error.
    if (k > 1 && farthest > 10 * tolerance && (farthest > 0.5 * before || k > steps_to_converge)) return std::nullopt;
    before = farthest;
    const std::optional<Row> step = equations.solve();
    if (!step) return std::nullopt;
    move(out, plane, *step);
    double size = 0;
    for (std::size_t i = 0; i < count; ++i) size = std::max(size, std::abs((*step)[i]));
    if (!(size < 1e3) || !(out.radius > 0) || !(std::abs(out.slope) < std::numbers::pi / 2)) return std::nullopt;
    if (size < std::max(1e-15, precision)) break;
  }
  slide(out, middle);
  return out;
}

std::optional<ShapeModel> fit_shape(SurfaceKind kind, std::span<const Vec3d> points, std::span<const FacePlace> faces,
                                    double tolerance) {
  if (points.size() < static_cast<std::size_t>(parameters_of(kind)) || faces.empty()) return std::nullopt;
  if (kind == SurfaceKind::plane) {
    Vec3d normal;
    for (const FacePlace& face : faces) normal += face.weight * face.normal;
    return fit_plane(points, normal);
  }
  const std::optional<ShapeModel> start =
      kind == SurfaceKind::sphere ? start_of_sphere(faces) : start_around_axis(kind, faces);
  if (!start || !(start->radius > 0) || !(start->radius < 1e4)) return std::nullopt;
  return refit_shape(*start, points, tolerance, 1e-3 * tolerance);
}

}  // namespace blum::detail
