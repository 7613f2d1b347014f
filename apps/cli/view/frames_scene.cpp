#include "view/frames_scene.hpp"

#include <algorithm>
#include <cmath>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "blum/core/error.hpp"
#include "blum/io/file_content.hpp"
#include "common/files.hpp"
#include "view/pairs_file.hpp"
#include "view/scene_parts.hpp"

namespace blum::cli {
namespace {

namespace fs = std::filesystem;

// Vertices of all frames together: 480 MB, in the browser's memory, too.
constexpr std::size_t most_vertices = 40'000'000;

struct Frame {
  std::string name;
  std::vector<Vec3d> vertices;
  std::size_t mesh = 0;  ///< index of the frame's triangles in Frames::meshes
};

struct Frames {
  std::vector<Frame> frames;
  std::vector<std::vector<Triangle>> meshes;
  Box3 box;
  std::size_t vertices = 0;   ///< number of vertices in all frames
  std::size_t triangles = 0;  ///< number of triangles in all meshes
  std::size_t left_out = 0;   ///< number of free segments and points, which are not shown
};

TriangleMesh read_frame(const fs::path& path, std::optional<double> weld) {
  if (holds_complex(path) || input_kind(path) != InputKind::mesh) {
    throw FileError("'" + path.string() + "' is not a mesh; --frames needs meshes");
  }
  TriangleMesh mesh = read_mesh_of_any_name(path, {weld}).mesh;
  try {
    validate(mesh);
  } catch (const InvalidMesh& error) {
    throw FileError("'" + path.string() + "': " + error.what());
  }
  if (mesh.triangles.empty())
    throw FileError("'" + path.string() + "' has no triangles; --frames needs meshes with triangles");
  return mesh;
}

void check_sizes(const Frames& all, const fs::path& path) {
  const auto check = [&](std::size_t count, std::size_t most, const char* what) {
    if (count <= most) return;
    throw FileError("with '" + path.string() + "' the frames have " + count_text(count) + " " + what +
                    ", but the viewer shows at most " + count_text(most) + "; show fewer frames or coarser meshes");
  };
  check(all.vertices, most_vertices, "vertices");
  check(all.triangles, most_triangles_shown, "triangles (counted once if frames share them)");
}

void add_frame(const fs::path& path, std::optional<double> weld, Frames& all) {
  TriangleMesh mesh = read_frame(path, weld);
  for (const Triangle& triangle : mesh.triangles) {
    for (const std::uint32_t v : triangle) all.box.extend(mesh.vertices[v]);
  }
  all.vertices += mesh.vertices.size();
  all.left_out += mesh.segments.size() + mesh.points.size();
  if (all.meshes.empty() || all.meshes.back() != mesh.triangles) {
    all.triangles += mesh.triangles.size();
    all.meshes.push_back(std::move(mesh.triangles));
  }
  check_sizes(all, path);
  all.frames.push_back({path.filename().string(), std::move(mesh.vertices), all.meshes.size() - 1});
}

/// Returns a number like "1,234", or a range like "12 to 1,234" if frames differ.
template <class CountOf>
std::string counts_text(const Frames& all, CountOf count_of) {
  std::size_t least = count_of(all.frames.front());
  std::size_t most = least;
  for (const Frame& frame : all.frames) {
    least = std::min(least, count_of(frame));
    most = std::max(most, count_of(frame));
  }
  return (least == most ? "" : count_text(least) + " to ") + count_text(most);
}

Json facts_of(const Frames& all, const FramePairs& pairs) {
  Json facts = Json::array(
      {fact("frames", count_text(all.frames.size())),
       fact("vertices", counts_text(all, [](const Frame& frame) { return frame.vertices.size(); })),
       fact("triangles", counts_text(all, [&](const Frame& frame) { return all.meshes[frame.mesh].size(); })),
       fact("meshes", all.meshes.size() == 1 ? "one, which moves" : count_text(all.meshes.size()))});
  if (all.left_out > 0) facts.push_back(fact("not shown", count_text(all.left_out) + " free segments and points"));
  for (std::size_t kind = 0; kind < pair_kinds.size(); ++kind) {
    const auto count = std::count(pairs.kinds.begin(), pairs.kinds.end(), kind);
    if (count == 0) continue;
    const std::string label = "pairs: " + std::string(pair_kinds[kind]);
    facts.push_back(fact(label.c_str(), count_text(static_cast<std::uint64_t>(count))));
  }
  return facts;
}

Json pairs_json(SceneBlob& blob, const FramePairs& pairs, const Vec3d& origin) {
  const auto [least, most] = std::minmax_element(pairs.distances.begin(), pairs.distances.end());
  return {{"kind_names", Json(std::vector<std::string_view>(pair_kinds.begin(), pair_kinds.end()))},
          {"first", blob.add(pairs.first)},
          {"kinds", blob.add(pairs.kinds)},
          {"points", add_places(blob, pairs.points, origin)},
          {"distances", blob.add(pairs.distances)},
          {"times", blob.add(pairs.times)},
          {"range", pairs.distances.empty() ? Json(nullptr) : Json::array({*least, *most})}};
}

Json item_of(SceneBlob& blob, Frames& all, const FramePairs& pairs) {
  const Vec3d origin = all.box.center();
  Json item = {{"kind", "frames"}, {"units", "mesh units"}};
  item["name"] = all.frames.front().name + " to " + all.frames.back().name;
  item["origin"] = to_json(origin);
  item["bounds"] = to_json(all.box);
  check_extent(item, "the scene of " + item["name"].text());
  item["facts"] = facts_of(all, pairs);
  Json& meshes = item["meshes"] = Json::array();
  for (const std::vector<Triangle>& triangles : all.meshes) meshes.push_back(add_cells(blob, triangles));
  Json& frames = item["frames"] = Json::array();
  for (Frame& frame : all.frames) {
    // Moved here, so that the memory is freed after this frame.
    const std::vector<Vec3d> vertices = std::move(frame.vertices);
    frames.push_back({{"name", frame.name}, {"mesh", frame.mesh}, {"positions", add_places(blob, vertices, origin)}});
  }
  if (!pairs.kinds.empty()) item["pairs"] = pairs_json(blob, pairs, origin);
  if (!pairs.stages.empty()) item["stages"] = {{"names", pairs.stages}, {"seconds", blob.add(pairs.seconds)}};
  return item;
}

}  // namespace

Scene make_frames_scene(const std::vector<fs::path>& frames, const std::optional<fs::path>& pairs,
                        std::optional<double> weld, bool compresses, const Context& context) {
  // Pairs are read first, because their errors are found fastest.
  const FramePairs close = pairs ? read_frame_pairs(*pairs, frames.size()) : FramePairs{};
  Frames all;
  for (const fs::path& path : frames) {
    throw_if_cancelled(context);
    add_frame(path, weld, all);
  }
  Scene scene{{}, SceneBlob(compresses), {}};
  Json items = Json::array({item_of(scene.blob, all, close)});
  scene.header = scene_header(scene.blob, std::move(items));
  return scene;
}

}  // namespace blum::cli
