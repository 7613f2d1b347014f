#include <algorithm>
#include <cmath>
#include <numeric>

#include "blum/core/error.hpp"
#include "blum/core/random.hpp"
#include "blum/shapes/generators.hpp"
#include "shapes/generator_parts.hpp"

namespace blum {
namespace {

using detail::pi;
using detail::require;
using detail::require_at_least;
using detail::require_positive;
using detail::require_triangle_count;
using detail::Ring;

/// Returns a circle around `center` in the plane of two orthonormal vectors, counter-clockwise around their cross
/// product, first x second.
Ring ring_around(const Vec3d& center, const Vec3d& first, const Vec3d& second, double radius, int sides) {
  Ring ring;
  for (const auto& [x, y] : detail::circle(0, 0, radius, sides)) ring.points.push_back(center + first * x + second * y);
  return ring;
}

/// Returns a torus around the origin whose ring lies in the plane of two orthonormal vectors.
TriangleMesh torus_in_plane(const TorusOptions& options, const Vec3d& first, const Vec3d& second) {
  std::vector<Ring> rings;
  for (const auto& [x, y] : detail::circle(0, 0, 1, options.ring_segments)) {
    const Vec3d outwards = first * x + second * y;
    const Vec3d along = second * x - first * y;
    rings.push_back(ring_around(outwards * options.ring_radius, outwards, cross(along, outwards), options.tube_radius,
                                options.tube_segments));
  }
  return detail::closed_loft(rings);
}

/// A point of a torus knot, its unit tangent, and the normal of the torus there.
struct KnotFrame {
  Vec3d position, tangent, normal;
};

KnotFrame knot_frame(const TorusKnotOptions& options, double turn) {
  const double around = 2 * pi * options.p * turn;
  const double wind = 2 * pi * options.q * turn;
  const Vec3d radial{std::cos(around), std::sin(around), 0};
  const Vec3d forward{-std::sin(around), std::cos(around), 0};
  const double distance = options.ring_radius + options.wind_radius * std::cos(wind);
  const Vec3d normal = radial * std::cos(wind) + Vec3d{0, 0, std::sin(wind)};
  const Vec3d winding = radial * -std::sin(wind) + Vec3d{0, 0, std::cos(wind)};
  const Vec3d velocity = forward * (options.p * distance) + winding * (options.q * options.wind_radius);
  return {radial * distance + Vec3d{0, 0, options.wind_radius * std::sin(wind)}, velocity / length(velocity), normal};
}

/// Returns the largest radius at which a tube around a closed curve does not touch itself, computed from samples. This
/// radius is the least radius of a circle that is tangent to the curve at one sample and contains another sample
/// (Gonzalez, Maddocks 1999).
double curve_thickness(const std::vector<KnotFrame>& curve) {
  double thickness = HUGE_VAL;
  for (const KnotFrame& a : curve) {
    for (const KnotFrame& b : curve) {
      const Vec3d difference = b.position - a.position;
      const double off_tangent = length(cross(difference, a.tangent));
      if (off_tangent > 0) thickness = std::min(thickness, squared_length(difference) / (2 * off_tangent));
    }
  }
  return thickness;
}

std::vector<KnotFrame> sample_knot(const TorusKnotOptions& options, int count) {
  std::vector<KnotFrame> curve;
  for (int s = 0; s < count; ++s) curve.push_back(knot_frame(options, static_cast<double>(s) / count));
  return curve;
}

double smoothstep(double from, double to, double x) {
  const double t = std::clamp((x - from) / (to - from), 0.0, 1.0);
  return t * t * (3 - 2 * t);
}

/// Cross-sections of a spoon, from the tip of the bowl (x = 0) to the end of the handle.
class SpoonSections {
 public:
  explicit SpoonSections(const SpoonOptions& options) : options_(options), bowl_half_length_(0.17 * options.length) {}

  [[nodiscard]] double half_width(double x) const {
    const double bowl = 0.5 * options_.bowl_width * std::sqrt(std::max(0.0, 1 - bowl_x(x) * bowl_x(x)));
    const double widening = 0.75 + 0.25 * smoothstep(0.4 * options_.length, options_.length, x);
    const double handle =
        0.5 * options_.handle_width * widening * smoothstep(bowl_half_length_, 2 * bowl_half_length_, x);
    return std::cbrt(bowl * bowl * bowl + handle * handle * handle) * rounding(x);
  }
  [[nodiscard]] double half_thickness(double x) const {
    return 0.5 * options_.thickness * rounding(x) * std::sqrt(std::min(1.0, x / (0.25 * bowl_half_length_)));
  }
  [[nodiscard]] double middle(double x, double y) const {
    const double across = 2 * y / options_.bowl_width;
    const double inside = std::max(0.0, 1 - bowl_x(x) * bowl_x(x) - across * across);
    const double along = x / options_.length;
    return -options_.bowl_depth * inside * (2 - inside) + 0.12 * options_.length * along * along * (1.6 - along);
  }

 private:
  [[nodiscard]] double bowl_x(double x) const { return x / bowl_half_length_ - 1; }
  /// Returns a factor that is 1, except near the end of the handle, where it decreases to 0 like the width of an
  /// ellipse.
  [[nodiscard]] double rounding(double x) const {
    const double left = (options_.length - x) / (0.5 * options_.handle_width);
    return left >= 1 ? 1 : std::sqrt(std::max(0.0, 1 - (1 - left) * (1 - left)));
  }

  const SpoonOptions& options_;
  double bowl_half_length_;
};

/// A bump in a direction: its height, and its sharpness, which is larger for narrower bumps.
struct Lobe {
  Vec3d direction;
  double height = 0;
  double sharpness = 0;
};

const std::vector<Lobe>& organic_lobes() {
  static const std::vector<Lobe> lobes = {
      {{0.75, 0, 0.66}, 0.55, 9},     {{0.55, 0.22, 0.8}, 0.75, 90},   {{0.55, -0.22, 0.8}, 0.75, 90},
      {{-0.98, 0, -0.2}, 0.3, 40},    {{0.7, 0.45, -0.55}, 0.35, 25},  {{0.7, -0.45, -0.55}, 0.35, 25},
      {{-0.35, 0.7, -0.62}, 0.4, 10}, {{-0.35, -0.7, -0.62}, 0.4, 10}, {{-0.6, 0, 0.3}, 0.2, 3},
  };
  return lobes;
}

/// A sum of 36 random plane waves.
class Skin {
 public:
  Skin(double amplitude, std::uint64_t seed) {
    Random random(seed);
    for (int wave = 0; wave < 36; ++wave) {
      const double frequency = 6 * std::pow(1.08, wave);
      Vec3d direction = random.in_ball();
      while (squared_length(direction) < 1e-4) direction = random.in_ball();
      waves_.push_back({direction * (frequency / length(direction)), 2 * pi * random.uniform(),
                        amplitude * std::pow(frequency / 6, -0.6)});
    }
  }
  [[nodiscard]] double height(const Vec3d& p) const {
    double sum = 0;
    for (const Wave& wave : waves_) sum += wave.amplitude * std::sin(dot(wave.vector, p) + wave.phase);
    return sum;
  }

 private:
  struct Wave {
    Vec3d vector;
    double phase = 0;
    double amplitude = 0;
  };
  std::vector<Wave> waves_;
};

/// Removes triangles around a vertex. Each of `rings` steps removes all triangles that touch the vertices reached so
/// far.
void cut_hole(TriangleMesh& mesh, std::uint32_t center, int rings) {
  std::vector<bool> inside(mesh.vertices.size(), false);
  inside[center] = true;
  for (int ring = 0; ring < rings; ++ring) {
    std::vector<Triangle> kept;
    std::vector<std::uint32_t> reached;
    for (const Triangle& t : mesh.triangles) {
      const bool touches = inside[t[0]] || inside[t[1]] || inside[t[2]];
      if (touches) {
        reached.insert(reached.end(), t.begin(), t.end());
      } else {
        kept.push_back(t);
      }
    }
    for (const std::uint32_t v : reached) inside[v] = true;
    mesh.triangles = std::move(kept);
  }
}

}  // namespace

TriangleMesh make_ellipsoid(const EllipsoidOptions& options) {
  for (std::size_t axis = 0; axis < 3; ++axis) require_positive(options.radii[axis], "each radius");
  TriangleMesh mesh = detail::geodesic(options.frequency);
  for (Vec3d& p : mesh.vertices) p = {p.x * options.radii.x, p.y * options.radii.y, p.z * options.radii.z};
  return mesh;
}

TriangleMesh make_sphere(const SphereOptions& options) {
  require_positive(options.radius, "radius");
  return make_ellipsoid({{options.radius, options.radius, options.radius}, options.frequency});
}

TriangleMesh make_uv_sphere(const UvSphereOptions& options) {
  require_positive(options.radius, "radius");
  require_at_least(options.longitudes, 3, "longitudes");
  require_at_least(options.latitudes, 2, "latitudes");
  require_triangle_count(2.0 * options.longitudes * options.latitudes);
  std::vector<std::array<double, 2>> profile;
  for (int band = 1; band < options.latitudes; ++band) {
    const double angle = pi * band / options.latitudes;
    profile.push_back({options.radius * std::sin(angle), -options.radius * std::cos(angle)});
  }
  return detail::revolve(profile, -options.radius, options.radius, options.longitudes);
}

TriangleMesh make_cylinder(const CylinderOptions& options) {
  require_positive(options.radius, "radius");
  require_positive(options.height, "height");
  require_at_least(options.sides, 3, "sides");
  require_at_least(options.stacks, 1, "stacks");
  require_triangle_count(2.0 * options.sides * (options.stacks + 1.0));
  std::vector<std::array<double, 2>> profile;
  for (int level = 0; level <= options.stacks; ++level) {
    profile.push_back({options.radius, options.height * (static_cast<double>(level) / options.stacks - 0.5)});
  }
  return detail::revolve(profile, -0.5 * options.height, 0.5 * options.height, options.sides);
}

TriangleMesh make_torus(const TorusOptions& options) {
  require_positive(options.tube_radius, "tube_radius");
  require_positive(options.ring_radius, "ring_radius");
  require(options.tube_radius < options.ring_radius, "tube_radius", "below ring_radius, or the torus cuts itself",
          options.tube_radius);
  require_at_least(options.ring_segments, 3, "ring_segments");
  require_at_least(options.tube_segments, 3, "tube_segments");
  require_triangle_count(2.0 * options.ring_segments * options.tube_segments);
  return torus_in_plane(options, {1, 0, 0}, {0, 1, 0});
}

TriangleMesh make_torus_knot(const TorusKnotOptions& options) {
  require(options.p >= 1 && options.p <= 20, "p", "1 to 20", options.p);
  require(options.q >= 1 && options.q <= 20, "q", "1 to 20", options.q);
  require(std::gcd(options.p, options.q) == 1, "the common factor of p and q", "1", std::gcd(options.p, options.q));
  require_positive(options.ring_radius, "ring_radius");
  require_positive(options.wind_radius, "wind_radius");
  require_positive(options.tube_radius, "tube_radius");
  require(options.wind_radius < options.ring_radius, "wind_radius", "below ring_radius", options.wind_radius);
  require_at_least(options.curve_segments, 16 * std::max(options.p, options.q), "curve_segments (16 a turn)");
  require_at_least(options.tube_segments, 3, "tube_segments");
  require_triangle_count(2.0 * options.curve_segments * options.tube_segments);
  const double thickness = curve_thickness(sample_knot(options, 64 * std::max(options.p, options.q)));
  require(options.tube_radius < 0.95 * thickness, "tube_radius",
          ("below " + std::to_string(0.95 * thickness) + ", or the knot touches itself").c_str(), options.tube_radius);
  std::vector<Ring> rings;
  for (const KnotFrame& frame : sample_knot(options, options.curve_segments)) {
    rings.push_back(ring_around(frame.position, frame.normal, cross(frame.tangent, frame.normal), options.tube_radius,
                                options.tube_segments));
  }
  return detail::closed_loft(rings);
}

TriangleMesh make_linked_tori(const LinkedToriOptions& options) {
  require(options.count >= 1 && options.count <= 1000, "count", "1 to 1000", options.count);
  require_positive(options.ring_radius, "ring_radius");
  require_positive(options.tube_radius, "tube_radius");
  require(options.tube_radius < options.ring_radius / 3, "tube_radius", "below ring_radius / 3, or links touch",
          options.tube_radius);
  require_at_least(options.ring_segments, 8, "ring_segments");
  require_at_least(options.tube_segments, 3, "tube_segments");
  require_triangle_count(2.0 * options.count * options.ring_segments * options.tube_segments);
  const TorusOptions link{options.ring_radius, options.tube_radius, options.ring_segments, options.tube_segments};
  const TriangleMesh flat = torus_in_plane(link, {1, 0, 0}, {0, 1, 0});
  const TriangleMesh upright = torus_in_plane(link, {1, 0, 0}, {0, 0, 1});
  // R is the ring radius, r the tube radius. The gap between the centre lines is 2 R - step for adjacent links, and 2
  // step - 2 R for every other link. For this step, both are above 2 r.
  const double step = 1.5 * options.ring_radius - 0.5 * options.tube_radius;
  TriangleMesh mesh;
  for (int i = 0; i < options.count; ++i) {
    append(mesh, i % 2 == 0 ? flat : upright, {step * (i - 0.5 * (options.count - 1)), 0, 0});
  }
  return mesh;
}

TriangleMesh make_ridged_rod(const RidgedRodOptions& options) {
  require_positive(options.length, "length");
  require_positive(options.radius, "radius");
  require(options.ridge_height >= 0 && options.ridge_height < options.radius, "ridge_height", "0 to below radius",
          options.ridge_height);
  require_at_least(options.ridges, 0, "ridges");
  require_at_least(options.sides, 3, "sides");
  require_at_least(options.segments_per_ridge, 4, "segments_per_ridge");
  const double band_count = std::max(1.0, static_cast<double>(options.ridges) * options.segments_per_ridge);
  require_triangle_count(2.0 * options.sides * (band_count + 1));
  const int bands = static_cast<int>(band_count);
  std::vector<std::array<double, 2>> profile;
  for (int band = 0; band <= bands; ++band) {
    const double along = static_cast<double>(band) / bands;
    const double wave = options.ridges == 0 ? 0 : -std::cos(2 * pi * options.ridges * along);
    profile.push_back({options.radius + options.ridge_height * wave, options.length * (along - 0.5)});
  }
  return detail::revolve(profile, -0.5 * options.length, 0.5 * options.length, options.sides);
}

TriangleMesh make_spoon(const SpoonOptions& options) {
  require_positive(options.length, "length");
  require_positive(options.bowl_width, "bowl_width");
  require_positive(options.bowl_depth, "bowl_depth");
  require_positive(options.handle_width, "handle_width");
  require_positive(options.thickness, "thickness");
  require(options.bowl_width <= options.length / 3, "bowl_width", "at most length / 3", options.bowl_width);
  require(options.bowl_depth <= options.bowl_width, "bowl_depth", "at most bowl_width", options.bowl_depth);
  require(options.handle_width <= options.bowl_width, "handle_width", "at most bowl_width", options.handle_width);
  require(options.thickness <= options.handle_width, "thickness", "at most handle_width", options.thickness);
  require_at_least(options.stations, 16, "stations");
  require(options.sides >= 8 && options.sides % 2 == 0, "sides", "even and at least 8", options.sides);
  require_triangle_count(2.0 * options.stations * options.sides);
  const SpoonSections sections(options);
  const auto unit = detail::circle(0, 0, 1, options.sides);
  std::vector<Ring> rings;
  for (int s = 1; s < options.stations; ++s) {
    // Cross-sections are closer together at both ends, where the outline is round.
    const double along = static_cast<double>(s) / options.stations;
    const double x = options.length * 0.5 * (along + 0.5 - 0.5 * std::cos(pi * along));
    Ring& ring = rings.emplace_back();
    for (const auto& [across, up] : unit) {
      const double y = across * sections.half_width(x);
      ring.points.push_back({x - 0.5 * options.length, y, sections.middle(x, y) + up * sections.half_thickness(x)});
    }
  }
  return detail::loft({-0.5 * options.length, 0, sections.middle(0, 0)}, rings,
                      {0.5 * options.length, 0, sections.middle(options.length, 0)});
}

TriangleMesh make_organic(const OrganicOptions& options) {
  require_positive(options.radius, "radius");
  require(options.detail >= 0 && options.detail <= 0.05, "detail", "0 to 0.05", options.detail);
  require(options.holes >= 0 && options.holes <= 12, "holes", "0 to 12", options.holes);
  if (options.holes > 0) require_at_least(options.frequency, 8, "frequency (with holes)");
  TriangleMesh mesh = detail::geodesic(options.frequency);
  const Skin skin(options.detail, options.seed);
  // The first twelve vertices are the corners of the icosahedron. Adjacent ones are `frequency` edges apart, so that
  // holes do not meet.
  for (int hole = 0; hole < options.holes; ++hole) {
    cut_hole(mesh, static_cast<std::uint32_t>(hole), 1 + options.frequency * (1 + hole % 3) / 12);
  }
  for (Vec3d& p : mesh.vertices) {
    double radius = 0.8 + skin.height(p);
    for (const Lobe& lobe : organic_lobes()) {
      radius += lobe.height * std::exp(lobe.sharpness * (dot(p, lobe.direction) / length(lobe.direction) - 1));
    }
    p = p * (options.radius * std::max(0.2, radius));
  }
  return mesh;
}

}  // namespace blum
