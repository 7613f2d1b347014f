#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <string>
#include <vector>

#include "blum/core/parallel.hpp"
#include "blum/medial_axis/certificate.hpp"
#include "medial_axis/certificate/ball_union.hpp"
#include "medial_axis/certificate/solid.hpp"

namespace blum {
namespace {

using verifier::Ball;
using verifier::BallUnion;
using verifier::Place;
using verifier::Sample;
using verifier::Samples;
using verifier::Solid;

constexpr double tolerance_of_diagonal = 1e-6;
constexpr double rounding_of_diagonal = 1e-9;

// ---- Topology ----

BettiNumbers homology_of(const MedialComplex& axis, const Context& context) {
  std::vector<std::array<std::uint32_t, 2>> edges;
  std::vector<std::array<std::uint32_t, 3>> triangles;
  edges.reserve(axis.edges.size());
  triangles.reserve(axis.triangles.size());
  for (const MedialEdge& edge : axis.edges) edges.push_back(edge.vertices);
  for (const MedialTriangle& triangle : axis.triangles) triangles.push_back(triangle.vertices);
  return homology({axis.vertices.size(), edges, triangles}, context);
}

/// Six digits say enough of an error.
std::string rounded_text(double value) {
  std::array<char, 32> text{};
  const auto result = std::to_chars(text.data(), text.data() + text.size(), value, std::chars_format::general, 6);
  return {text.data(), result.ptr};
}

/// "1,234,567".
std::string count_text(std::uint64_t count) {
  std::string text = std::to_string(count);
  for (std::size_t at = text.size(); at > 3;) text.insert(at -= 3, ",");
  return text;
}

std::string counted(std::int64_t count, const char* thing) {
  return count_text(static_cast<std::uint64_t>(count)) + " " + thing + (count == 1 ? "" : "s");
}

void compare_topology(Certificate& certificate) {
  constexpr std::array<const char*, 3> things{"component", "tunnel", "void"};
  certificate.topology_holds = certificate.solid == certificate.axis;
  for (std::size_t k = 0; k < 3; ++k) {
    if (certificate.solid[k] == certificate.axis[k]) continue;
    certificate.mismatches.push_back("the solid has " + counted(certificate.solid[k], things[k]) + ", the axis " +
                                     count_text(static_cast<std::uint64_t>(certificate.axis[k])));
  }
}

// ---- Radii and footprints ----

bool is_finite(const MedialVertex& vertex) {
  return blum::is_finite(vertex.position) && std::isfinite(vertex.radius) && blum::is_finite(vertex.footprints[0]) &&
         blum::is_finite(vertex.footprints[1]);
}

/// Adds what one vertex is off by.
void look_at(const MedialVertex& vertex, const Place& place, const Solid& solid, AxisGeometry known,
             GeometryCheck& check) {
  check.radius_error = std::max(check.radius_error, std::abs(vertex.radius - place.distance));
  if (place.outside_by > check.tolerance) ++check.outside;
  check.outside_by = std::max(check.outside_by, place.outside_by);
  if (known != AxisGeometry::footprints) return;
  for (const Vec3d& foot : vertex.footprints) {
    check.footprint_off_surface = std::max(check.footprint_off_surface, solid.distance(foot, place.body));
    const double distance = length(vertex.position - foot);
    check.footprint_error = std::max(check.footprint_error, std::abs(distance - vertex.radius));
  }
}

void merge(GeometryCheck& all, const GeometryCheck& part) {
  all.vertices += part.vertices;
  all.not_finite += part.not_finite;
  all.outside += part.outside;
  all.radius_error = std::max(all.radius_error, part.radius_error);
  all.footprint_off_surface = std::max(all.footprint_off_surface, part.footprint_off_surface);
  all.footprint_error = std::max(all.footprint_error, part.footprint_error);
  all.outside_by = std::max(all.outside_by, part.outside_by);
}

/// Looks at every vertex, and tells where each lies.
GeometryCheck check_geometry(const MedialComplex& axis, const Solid& solid, AxisGeometry known,
                             std::vector<Place>& places, const Context& context) {
  constexpr std::size_t grain = 256;
  GeometryCheck all;
  all.tolerance = tolerance_of_diagonal * solid.diagonal();
  places.assign(axis.vertices.size(), {});
  std::vector<GeometryCheck> parts(axis.vertices.size() / grain + 1);
  parallel_for(context, axis.vertices.size(), grain, "checking radii", [&](const WorkRange& range) {
    GeometryCheck& part = parts[range.begin / grain];
    part.tolerance = all.tolerance;
    for (std::size_t v = range.begin; v < range.end; ++v) {
      const MedialVertex& vertex = axis.vertices[v];
      ++part.vertices;
      if (!is_finite(vertex)) {
        ++part.not_finite;
        continue;
      }
      places[v] = solid.locate(vertex.position);
      look_at(vertex, places[v], solid, known, part);
    }
  });
  for (const GeometryCheck& part : parts) merge(all, part);
  all.holds = all.not_finite == 0 && all.outside == 0 && all.radius_error <= all.tolerance &&
              all.footprint_off_surface <= all.tolerance && all.footprint_error <= all.tolerance;
  return all;
}

void explain_geometry(const GeometryCheck& check, std::vector<std::string>& mismatches) {
  const std::string allowed = " (allowed: " + rounded_text(check.tolerance) + ")";
  const auto add = [&](double error, const std::string& what) {
    if (!(error <= check.tolerance)) mismatches.push_back(what + rounded_text(error) + allowed);
  };
  const std::string of_vertices = "of the " + count_text(check.vertices) + " vertices of the axis ";
  if (check.not_finite > 0) {
    mismatches.push_back(of_vertices + count_text(check.not_finite) +
                         " have a coordinate, footprint or radius that is no finite number");
  }
  add(check.radius_error, "a radius differs from the exact distance to the surface by ");
  add(check.footprint_off_surface, "a footprint lies off the surface by ");
  add(check.footprint_error, "the distance to a footprint differs from the radius by ");
  if (check.outside > 0) {
    mismatches.push_back(of_vertices + count_text(check.outside) + " lie outside of the solid, by up to " +
                         rounded_text(check.outside_by) + allowed);
  }
}

// ---- The union of balls ----

/// A ball around a vertex, and the body that it should fill.
struct OwnedBall {
  Ball ball;
  std::uint32_t body = 0;
};

/// The length of the median edge; of an axis without edges, a part of the solid.
double default_step(const MedialComplex& axis, double diagonal) {
  constexpr double parts_of_diagonal = 256;
  std::vector<double> squares;
  const auto add = [&](std::uint32_t a, std::uint32_t b) {
    const double squared = squared_length(axis.vertices[a].position - axis.vertices[b].position);
    if (squared > 0 && std::isfinite(squared)) squares.push_back(squared);
  };
  for (const MedialEdge& edge : axis.edges) add(edge.vertices[0], edge.vertices[1]);
  for (const MedialTriangle& triangle : axis.triangles) add(triangle.vertices[0], triangle.vertices[1]);
  if (squares.empty()) return diagonal / parts_of_diagonal;
  const auto middle = squares.begin() + static_cast<std::ptrdiff_t>(squares.size() / 2);
  std::nth_element(squares.begin(), middle, squares.end());
  return std::max(std::sqrt(*middle), rounding_of_diagonal * diagonal);
}

/// Fills what the samples of the surface tell.
void measure_surface(const std::vector<Sample>& samples, const BallUnion& balls, BallUnionCheck& check,
                     const Context& context) {
  struct Part {
    double largest = 0, moment = 0, area = 0;
  };
  constexpr std::size_t grain = 512;
  std::vector<Part> parts(samples.size() / grain + 1);
  parallel_for(context, samples.size(), grain, "surface to balls", [&](const WorkRange& range) {
    Part& part = parts[range.begin / grain];
    std::uint32_t closest = 0;
    for (std::size_t s = range.begin; s < range.end; ++s) {
      const double gap = std::max(balls.gap(samples[s].point, closest), 0.0);
      part.largest = std::max(part.largest, gap);
      part.moment += gap * samples[s].area;
      part.area += samples[s].area;
    }
  });
  Part all;
  for (const Part& part : parts) {
    all.largest = std::max(all.largest, part.largest);
    all.moment += part.moment;
    all.area += part.area;
  }
  check.solid_to_balls = all.largest;
  check.mean_solid_to_balls = all.area > 0 ? all.moment / all.area : 0;
}

constexpr std::size_t directions_per_ball = 32;
constexpr std::size_t most_directions = 500'000;

/// Directions spread evenly along a spiral from pole to pole.
std::array<Vec3d, directions_per_ball> directions() {
  std::array<Vec3d, directions_per_ball> result;
  for (std::size_t k = 0; k < directions_per_ball; ++k) {
    const double z = 1 - (2 * static_cast<double>(k) + 1) / directions_per_ball;
    const double angle = 2 * std::numbers::pi * static_cast<double>(k) / std::numbers::phi;
    const double out = std::sqrt(1 - z * z);
    result[k] = {out * std::cos(angle), out * std::sin(angle), z};
  }
  return result;
}

/// How far points of balls that are in no other ball are from the surface.
double balls_to_surface(const std::vector<OwnedBall>& owned, const BallUnion& balls, const Solid& solid,
                        const Context& context) {
  constexpr std::size_t grain = 64;
  const double margin = rounding_of_diagonal * solid.diagonal();
  // Of very many balls only every so many-th is looked at: neighbours are alike.
  const std::size_t every = owned.size() * directions_per_ball / most_directions + 1;
  const std::size_t count = (owned.size() + every - 1) / every;
  const auto ways = directions();
  std::vector<double> parts(count / grain + 1, 0);
  parallel_for(context, count, grain, "balls to surface", [&](const WorkRange& range) {
    for (std::size_t b = range.begin; b < range.end; ++b) {
      const auto& [ball, body] = owned[b * every];
      if (ball.radius <= margin) continue;
      for (const Vec3d& way : ways) {
        const Vec3d p = ball.centre + way * ball.radius;
        if (balls.holds(p, margin)) continue;
        parts[range.begin / grain] = std::max(parts[range.begin / grain], solid.distance(p, body));
      }
    }
  });
  return *std::max_element(parts.begin(), parts.end());
}

BallUnionCheck check_balls(const MedialComplex& axis, const Solid& solid, const std::vector<Place>& places,
                           const Context& context) {
  BallUnionCheck check;
  std::vector<OwnedBall> owned;
  std::vector<Ball> balls;
  for (std::size_t v = 0; v < axis.vertices.size(); ++v) {
    const MedialVertex& vertex = axis.vertices[v];
    if (!is_finite(vertex) || vertex.radius < 0) continue;
    owned.push_back({{vertex.position, vertex.radius}, places[v].body});
    balls.push_back(owned.back().ball);
    const double room = places[v].outside_by > 0 ? -places[v].outside_by : places[v].distance;
    check.balls_beyond_solid = std::max(check.balls_beyond_solid, vertex.radius - room);
  }
  if (balls.empty()) {
    check.solid_to_balls = check.mean_solid_to_balls = solid.diagonal();
    return check;
  }
  const BallUnion all(balls, context);
  const Samples samples = solid.samples(default_step(axis, solid.diagonal()), context);
  check.step = samples.step;
  measure_surface(samples.list, all, check, context);
  check.balls_to_surface = balls_to_surface(owned, all, solid, context);
  return check;
}

// ---- All of it ----

/// Solids of any size are looked at as if they were about 1 large, for the fourth powers of lengths to be numbers. The
/// factor is a power of two, which changes no digit, and 1 unless the size is extreme.
double factor_for(double size) {
  constexpr int extreme = 100;
  const int exponent = size > 0 && std::isfinite(size) ? std::ilogb(size) : 0;
  return std::abs(exponent) < extreme ? 1 : std::ldexp(1.0, -exponent);
}

MedialComplex scaled(MedialComplex axis, double factor) {
  for (MedialVertex& vertex : axis.vertices) {
    vertex.position *= factor;
    vertex.radius *= factor;
    for (Vec3d& foot : vertex.footprints) foot *= factor;
  }
  return axis;
}

/// A mesh and its vertices, which are its own.
struct ScaledMesh {
  std::vector<Vec3d> vertices;
  MeshView view;

  ScaledMesh(const MeshView& mesh, double factor) : vertices(mesh.vertices.begin(), mesh.vertices.end()), view(mesh) {
    for (Vec3d& v : vertices) v *= factor;
    view.vertices = vertices;
  }
};

void scale_back(Certificate& certificate, double factor) {
  GeometryCheck& geometry = certificate.geometry;
  BallUnionCheck& balls = certificate.balls;
  for (double* value : {&geometry.radius_error, &geometry.footprint_off_surface, &geometry.footprint_error,
                        &geometry.outside_by, &geometry.tolerance, &balls.solid_to_balls, &balls.mean_solid_to_balls,
                        &balls.balls_beyond_solid, &balls.balls_to_surface, &balls.step}) {
    *value /= factor;
  }
}

Certificate certify_against(const MedialComplex& axis, const verifier::KnownSolid& solid, double factor,
                            AxisGeometry known, const Context& context) {
  Certificate certificate;
  certificate.checked = known;
  certificate.solid = solid.betti;
  certificate.axis = homology_of(axis, context);
  compare_topology(certificate);
  if (known == AxisGeometry::none) return certificate;
  std::vector<Place> places;
  certificate.geometry = check_geometry(axis, *solid.solid, known, places, context);
  certificate.balls = check_balls(axis, *solid.solid, places, context);
  scale_back(certificate, factor);
  explain_geometry(certificate.geometry, certificate.mismatches);
  return certificate;
}

}  // namespace

Certificate certify(const MedialComplex& axis, const MeshView& mesh, AxisGeometry known, const Context& context) {
  validate(mesh);
  const double factor = factor_for(bounds(mesh).diagonal());
  if (factor == 1) {
    return certify_against(axis, verifier::solid_of_mesh(mesh, context), factor, known, context);
  }
  const ScaledMesh own(mesh, factor);
  return certify_against(scaled(axis, factor), verifier::solid_of_mesh(own.view, context), factor, known, context);
}

Certificate certify(const MedialComplex& axis, const VoxelSet& voxels, const GridSpec& grid, const MeshView* surface,
                    AxisGeometry known, const Context& context) {
  validate(grid);
  if (grid.size != voxels.size()) throw InvalidOption("the grid of a certificate is not that of its voxels");
  if (voxels.count() == 0) throw InvalidOption("there are no voxels, and so no solid to check an axis against");
  if (surface != nullptr) validate(*surface);
  const double factor = factor_for(length(grid.spacing));
  GridSpec own_grid = grid;
  own_grid.origin *= factor;
  own_grid.spacing *= factor;
  const ScaledMesh own(surface == nullptr ? MeshView{} : *surface, factor);
  const verifier::KnownSolid solid =
      verifier::solid_of_voxels(voxels, own_grid, surface == nullptr ? nullptr : &own.view, context);
  Certificate certificate = certify_against(factor == 1 ? axis : scaled(axis, factor), solid, factor, known, context);
  certificate.against = surface == nullptr ? SolidRule::voxels : SolidRule::winding;
  return certificate;
}

}  // namespace blum
