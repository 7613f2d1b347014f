// Embree point queries. The user callback computes the closest point on a triangle.
#include "peers/bundles.hpp"

#ifdef BLUM_BENCH_EMBREE
#include <embree3/rtcore.h>

#include <memory>
#include <stdexcept>

#include "blum/core/parallel.hpp"

namespace blum::bench {
namespace {

struct Corners {
  Vec3f a, b, c;
};

/// Squared distance from p to a closed triangle (Ericson, Real-Time Collision Detection, 5.1.5).
inline float squared_distance(const Vec3f& p, const Corners& t) {
  const Vec3f ab = t.b - t.a;
  const Vec3f ac = t.c - t.a;
  const Vec3f ap = p - t.a;
  const float d1 = dot(ab, ap);
  const float d2 = dot(ac, ap);
  if (d1 <= 0 && d2 <= 0) return squared_length(ap);
  const Vec3f bp = p - t.b;
  const float d3 = dot(ab, bp);
  const float d4 = dot(ac, bp);
  if (d3 >= 0 && d4 <= d3) return squared_length(bp);
  const float vc = d1 * d4 - d3 * d2;
  if (vc <= 0 && d1 >= 0 && d3 <= 0) return squared_length(ap - ab * (d1 / (d1 - d3)));
  const Vec3f cp = p - t.c;
  const float d5 = dot(ab, cp);
  const float d6 = dot(ac, cp);
  if (d6 >= 0 && d5 <= d6) return squared_length(cp);
  const float vb = d5 * d2 - d1 * d6;
  if (vb <= 0 && d2 >= 0 && d6 <= 0) return squared_length(ap - ac * (d2 / (d2 - d6)));
  const float va = d3 * d6 - d5 * d4;
  if (va <= 0 && d4 - d3 >= 0 && d5 - d6 >= 0) {
    const float w = (d4 - d3) / ((d4 - d3) + (d5 - d6));
    return squared_length(bp - (t.c - t.b) * w);
  }
  const float scale = 1 / (va + vb + vc);
  return squared_length(ap - ab * (vb * scale) - ac * (vc * scale));
}

struct Search {
  const Corners* triangles = nullptr;
  Vec3f point{};
  float squared = 0;
  unsigned triangle = 0;
};

bool closer(RTCPointQueryFunctionArguments* args) {
  auto& search = *static_cast<Search*>(args->userPtr);
  const float squared = squared_distance(search.point, search.triangles[args->primID]);
  if (squared >= search.squared) return false;
  search.squared = squared;
  search.triangle = args->primID;
  args->query->radius = std::sqrt(squared);
  return true;
}

struct Scene {
  RTCDevice device = nullptr;
  RTCScene scene = nullptr;
  std::vector<Corners> corners;
  Scene() = default;
  Scene(const Scene&) = delete;
  Scene& operator=(const Scene&) = delete;
  ~Scene() {
    if (scene != nullptr) rtcReleaseScene(scene);
    if (device != nullptr) rtcReleaseDevice(device);
  }

  /// Builds the scene. Coordinates become float32 relative to `centre`.
  void build(const MeshView& mesh, const Vec3d& centre, int threads) {
    device = rtcNewDevice(("threads=" + std::to_string(threads)).c_str());
    if (device == nullptr) throw std::runtime_error("Embree gives no device");
    scene = rtcNewScene(device);
    const RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE);
    auto* points = static_cast<float*>(rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3,
                                                               3 * sizeof(float), mesh.vertices.size()));
    const auto local = [&](std::uint32_t vertex) {
      const Vec3d p = mesh.vertices[vertex] - centre;
      return Vec3f{static_cast<float>(p.x), static_cast<float>(p.y), static_cast<float>(p.z)};
    };
    for (std::uint32_t v = 0; v < mesh.vertices.size(); ++v) {
      const Vec3f p = local(v);
      points[3 * v] = p.x;
      points[3 * v + 1] = p.y;
      points[3 * v + 2] = p.z;
    }
    auto* indices = static_cast<Triangle*>(rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3,
                                                                   sizeof(Triangle), mesh.triangles.size()));
    std::copy(mesh.triangles.begin(), mesh.triangles.end(), indices);
    corners.reserve(mesh.triangles.size());
    for (const Triangle& t : mesh.triangles) corners.push_back({local(t[0]), local(t[1]), local(t[2])});
    rtcSetGeometryPointQueryFunction(geometry, closer);
    rtcCommitGeometry(geometry);
    rtcAttachGeometry(scene, geometry);
    rtcReleaseGeometry(geometry);
    rtcCommitScene(scene);
  }

  /// Starts from the distance to search.triangle. Writes the result to search.squared and search.triangle.
  void closest(Search& search) const {
    search.squared = squared_distance(search.point, search.triangles[search.triangle]);
    RTCPointQueryContext context;
    rtcInitPointQueryContext(&context);
    RTCPointQuery query{};
    query.x = search.point.x;
    query.y = search.point.y;
    query.z = search.point.z;
    query.radius = std::sqrt(search.squared);
    rtcPointQuery(scene, &query, &context, nullptr, &search);
  }
};

}  // namespace

std::optional<PeerField> embree_field(const MeshView& mesh, const GridSpec& grid, const Context& context) {
  PeerField result = empty_result(grid);
  const Vec3d centre = bounds(grid).center();
  Scene scene;
  run_peer(
      result, context, [&] { scene.build(mesh, centre, thread_count(context)); },
      [&](const Bundles& bundles, std::size_t bundle, Field& field) {
        Search search{.triangles = scene.corners.data()};
        bundles.visit(bundle, [&](std::size_t node, const Vec3d& position) {
          const Vec3d p = position - centre;
          search.point = {static_cast<float>(p.x), static_cast<float>(p.y), static_cast<float>(p.z)};
          scene.closest(search);
          field.distance[node] = std::sqrt(search.squared);
          field.site[node] = SiteId(search.triangle);
        });
      });
  return result;
}

std::optional<PeerPoints> embree_points(const MeshView& mesh, std::span<const Vec3d> points, const Context& context,
                                        bool is_hinted) {
  const Vec3d centre = bounds(mesh).center();
  Scene scene;
  scene.build(mesh, centre, thread_count(context));
  PeerPoints out;
  out.distance.resize(points.size());
  out.times = time_runs([&] {
    parallel_for(context, points.size(), 512, "", [&](const WorkRange& range) {
      Search search{.triangles = scene.corners.data()};
      for (std::size_t i = range.begin; i < range.end; ++i) {
        const Vec3d p = points[i] - centre;
        if (!is_hinted) search = {.triangles = scene.corners.data()};
        search.point = {static_cast<float>(p.x), static_cast<float>(p.y), static_cast<float>(p.z)};
        scene.closest(search);
        out.distance[i] = std::sqrt(search.squared);
      }
    });
  });
  return out;
}

}  // namespace blum::bench

#else

namespace blum::bench {

std::optional<PeerField> embree_field(const MeshView&, const GridSpec&, const Context&) {
  return std::nullopt;
}

std::optional<PeerPoints> embree_points(const MeshView&, std::span<const Vec3d>, const Context&, bool) {
  return std::nullopt;
}

}  // namespace blum::bench

#endif
