#include <filesystem>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "blum/core/error.hpp"
#include "blum/core/parallel.hpp"
#include "blum/io/atomic_file.hpp"
#include "blum/io/mesh_io.hpp"
#include "files.hpp"
#include "options.hpp"
#include "progress.hpp"
#include "proximity_queries.hpp"
#include "summary.hpp"

namespace blum::cli {
namespace {

namespace fs = std::filesystem;

void check(const ProximityArguments& a) {
  if (!a.ends.empty()) throw UsageError("--frames are those of one object, which --to does not go with");
  if (!a.self) throw UsageError("--frames are those of one object, which has nothing to meet but itself: give --self");
  if (a.scene.size() < 2) throw UsageError("--frames takes at least two files");
  if (!a.output) throw UsageError("--frames tells its pairs in a file: give -o PAIRS.json");
  check_extension("--output", *a.output, {".json"});
}

Json pair_json(const char* kind, const Vec3d& first, const Vec3d& second, double distance) {
  return {{"kind", kind}, {"points", {to_json(first), to_json(second)}}, {"distance", distance}};
}

/// What a frame holds, and what that took.
struct Frame {
  Json pairs = Json::array();
  std::vector<PhaseTime> phases;
};

void tell(const ProximityPairs& found, const char* kind, Frame& out) {
  for (const PrimitivePair& pair : found.pairs) {
    const TriangleDistance& between = pair.between;
    out.pairs.push_back(pair_json(kind, between.first_point, between.second_point, between.distance));
  }
  out.phases.insert(out.phases.end(), found.report.phases.begin(), found.report.phases.end());
}

/// Features that meet on the way to the next frame, by the way of one of their vertices until they do.
void tell(const SceneCollisions& found, const TriangleMesh& from, std::span<const Vec3d> to, Frame& out) {
  const auto add = [&](std::uint32_t vertex, double time) {
    const Vec3d& start = from.vertices[vertex];
    const Vec3d end = start + (to[vertex] - start) * time;
    Json pair = pair_json("collision", start, end, length(end - start));
    pair["time"] = time;
    out.pairs.push_back(std::move(pair));
  };
  for (const ObjectCollisions& pair : found.objects) {
    for (const auto& one : pair.vertex_face) add(one.vertex, one.time);
    for (const auto& one : pair.edge_edge) add(one.first[0], one.time);
  }
  out.phases.insert(out.phases.end(), found.phases.begin(), found.phases.end());
}

/// One object, frame after frame.
class Sequence {
 public:
  Sequence(const ProximityArguments& a, const Context& context)
      : arguments_(a),
        context_(context),
        impact_(a.impact.read()),
        penetration_(a.penetration.read()),
        scene_(a.culling.read()) {
    if (a.within) within_ = parse_non_negative("--within", *a.within);
  }

  Frame frame(std::size_t k) {
    Frame out;
    Stopwatch watch;
    move_to(k);
    out.phases.push_back({"boxes", watch.lap()});
    const std::string& query = arguments_.query;
    const double most = within_.value_or(std::numeric_limits<double>::infinity());
    if (query == "continuous") {
      if (k + 1 < arguments_.scene.size()) ask_continuous(k, out);
    } else if (query == "penetration") {
      for (const ScenePenetration& part : all_penetrations(scene_, true, penetration_, context_, out.phases)) {
        out.pairs.push_back(pair_json("penetration", part.part.deep_point, part.part.surface_point, part.part.depth));
      }
    } else if (query == "collide") {
      const bool is_near = within_.value_or(0) > 0;
      tell(is_near ? scene_.closer_than(*within_, context_) : scene_.collisions(context_),
           is_near ? "closest" : "collision", out);
    } else {
      tell(query == "nbody" ? scene_.closest_primitives(most, context_) : scene_.separation(most, context_), "closest",
           out);
    }
    return out;
  }

 private:
  void move_to(std::size_t k) {
    TriangleMesh next = next_ ? std::move(*next_) : read_mesh(arguments_.scene[k]);
    next_.reset();
    const bool is_same = next.triangles == mesh_.triangles && next.segments == mesh_.segments &&
                         next.points == mesh_.points && next.vertices.size() == mesh_.vertices.size();
    mesh_ = std::move(next);
    if (scene_.size() == 0) {
      ObjectOptions options;
      options.self = true;
      object_ = scene_.add(mesh_, options, context_);
    } else if (is_same) {
      scene_.update(object_, mesh_.vertices, context_);
    } else {
      scene_.update(object_, mesh_, context_);
    }
  }

  /// Nothing is asked where the triangles change on the way.
  void ask_continuous(std::size_t k, Frame& out) {
    next_ = read_mesh(arguments_.scene[k + 1]);
    if (next_->triangles != mesh_.triangles || next_->vertices.size() != mesh_.vertices.size()) return;
    ObjectMotion motion;
    motion.object = object_;
    motion.vertices = next_->vertices;
    tell(scene_.continuous({&motion, 1}, impact_, context_), mesh_, next_->vertices, out);
  }

  const ProximityArguments& arguments_;
  const Context& context_;
  ImpactOptions impact_;
  PenetrationOptions penetration_;
  std::optional<double> within_;
  ProximityScene scene_;
  ObjectId object_;
  TriangleMesh mesh_;
  std::optional<TriangleMesh> next_;
};

Json stages_json(const std::vector<PhaseTime>& phases) {
  Json out = Json::object();
  for (const PhaseTime& one : phases) out[one.phase] = out.value(one.phase, 0.0) + one.seconds;
  return out;
}

}  // namespace

void run_frames(const ProximityArguments& a) {
  check(a);
  check(a.impact.read());
  check(a.penetration.read());
  check(a.culling.read());
  const int threads = parse_threads(a.threads);
  std::vector<fs::path> outputs = a.report.files();
  outputs.emplace_back(*a.output);
  check_outputs(outputs, {a.scene.begin(), a.scene.end()});
  Progress progress(!a.report.quiet);
  const Interrupt interrupt;
  Context context = make_context(threads, progress, interrupt);
  const auto show = std::exchange(context.progress, {});
  Sequence sequence(a, context);
  Json frames = Json::array();
  Json counts = Json::array();
  std::size_t pairs = 0;
  Stopwatch watch;
  for (std::size_t k = 0; k < a.scene.size(); ++k) {
    throw_if_cancelled(context);
    Frame frame = sequence.frame(k);
    pairs += frame.pairs.size();
    counts.push_back(frame.pairs.size());
    frames.push_back({{"pairs", std::move(frame.pairs)}, {"stages", stages_json(frame.phases)}});
    if (show) show(static_cast<double>(k + 1) / static_cast<double>(a.scene.size()), "frames");
  }
  AtomicFile file(*a.output);
  file.write(Json{{"query", a.query}, {"files", a.scene}, {"frames", std::move(frames)}}.dump() + "\n");
  file.commit();
  progress.clear();
  const double seconds = watch.lap();
  TextTable table;
  table.add("frames", count_text(a.scene.size()));
  table.add("pairs", count_text(pairs) + "; see them with: blum view FRAMES --frames --pairs " + *a.output);
  table.add("wrote", *a.output);
  table.add("time", rounded_text(seconds) + " s");
  report(a.report,
         answer_json("proximity", {{"query", a.query},
                                   {"frames", a.scene.size()},
                                   {"pairs", counts},
                                   {"total_seconds", seconds},
                                   {"peak_memory_bytes", peak_memory()},
                                   {"threads", thread_count(context)},
                                   {"outputs", {*a.output}}}),
         table.text());
}

}  // namespace blum::cli
