#include <algorithm>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "blum/core/error.hpp"
#include "blum/core/parallel.hpp"
#include "blum/io/atomic_file.hpp"
#include "blum/io/mesh_io.hpp"
#include "common/files.hpp"
#include "common/options.hpp"
#include "common/progress.hpp"
#include "common/summary.hpp"
#include "proximity/queries.hpp"

namespace blum::cli {
namespace {

namespace fs = std::filesystem;

void check(const ProximityArguments& a) {
  if (!a.ends.empty()) throw UsageError("--frames and --to exclude each other: frames show one object");
  if (!a.self) throw UsageError("--frames shows one object, which can only meet itself; add --self");
  if (a.scene.size() < 2) throw UsageError("--frames needs at least two files");
  if (a.output) check_extension("--output", *a.output, {".json"});
}

Json pair_json(const std::string& kind, const Vec3d& first, const Vec3d& second, double distance) {
  return {{"kind", kind}, {"points", {to_json(first), to_json(second)}}, {"distance", distance}};
}

/// Results of one frame, and their durations.
struct Frame {
  Json pairs = Json::array();
  std::size_t count = 0;  ///< number of all pairs, including those beyond --limit
  std::optional<double> earliest;
  std::string skipped;  ///< reason why the step to the next frame was skipped; empty if it was not skipped
  std::vector<PhaseTime> phases;
  std::vector<Warning> warnings;

  void add(Json pair, std::size_t limit) {
    if (count++ < limit) pairs.push_back(std::move(pair));
  }
};

void add_result(const SceneFound& found, std::size_t limit, Frame& out) {
  const std::string kind(found.kind);
  for (const Penetration& part : found.parts) {
    out.add(pair_json(kind, part.deep_point, part.surface_point, part.depth), limit);
  }
  if (found.parts.empty()) {
    for (const PrimitivePair& pair : found.pairs.pairs) {
      const TriangleDistance& between = pair.between;
      out.add(pair_json(kind, between.first_point, between.second_point, between.distance), limit);
    }
  }
  const auto& phases = found.pairs.report.phases;
  out.phases.insert(out.phases.end(), phases.begin(), phases.end());
}

/// Adds the features that collide before the next frame. They are written as pairs: the path of one of their vertices
/// until the collision.
void add_result(const SceneCollisions& found, const TriangleMesh& from, std::span<const Vec3d> to, std::size_t limit,
                Frame& out) {
  const auto add = [&](std::uint32_t vertex, double time) {
    const Vec3d& start = from.vertices[vertex];
    const Vec3d end = start + (to[vertex] - start) * time;
    Json pair = pair_json("collision", start, end, length(end - start));
    pair["time"] = time;
    out.add(std::move(pair), limit);
  };
  out.earliest = found.earliest();
  out.warnings = start_warnings(found);
  for (const ObjectCollisions& pair : found.objects) {
    for (const auto& one : pair.vertex_face) add(one.vertex, one.time);
    for (const auto& one : pair.edge_edge) add(one.first[0], one.time);
  }
  out.phases.insert(out.phases.end(), found.phases.begin(), found.phases.end());
}

/// Runs a query for one object, one frame after the other.
class Sequence {
 public:
  Sequence(const ProximityArguments& a, const SceneQuery& query, const Context& context)
      : arguments_(a),
        query_(query),
        context_(context),
        impact_(a.impact.read()),
        weld_(parse_weld(a.weld)),
        limit_(read_limit(a)),
        scene_(a.culling.read()) {
    if (a.max_distance) asked_.max_distance = parse_non_negative("--max-distance", *a.max_distance);
    asked_.penetration = a.penetration.read();
  }

  Frame frame(std::size_t k) {
    Frame out;
    Stopwatch watch;
    move_to(k);
    out.phases.push_back({"boxes", watch.lap()});
    if (!query_.moves) {
      add_result(ask(query_, scene_, asked_, context_), limit_, out);
    } else if (k + 1 < arguments_.scene.size()) {
      ask_continuous(k, out);
    }
    return out;
  }

 private:
  void move_to(std::size_t k) {
    TriangleMesh next = next_ ? std::move(*next_) : read_mesh(arguments_.scene[k], {weld_});
    next_.reset();
    const bool is_same = difference(mesh_, next).empty();
    mesh_ = std::move(next);
    const std::string& file = arguments_.scene[k];
    if (scene_.size() == 0) {
      ObjectOptions options;
      options.self = true;
      options.name = file;
      object_ = scene_.add(mesh_, options, context_);
      return;
    }
    scene_.rename(object_, file);
    if (is_same) {
      scene_.update(object_, mesh_.vertices, context_);
    } else {
      scene_.update(object_, mesh_, context_);
    }
  }

  /// @throws FormatError if the mesh of the next frame is different, unless --skip-changed is given.
  void ask_continuous(std::size_t k, Frame& out) {
    const std::vector<std::string>& files = arguments_.scene;
    next_ = read_mesh(files[k + 1], {weld_});
    if (const std::string what = difference(mesh_, *next_); !what.empty()) {
      out.skipped = "'" + files[k + 1] + "': " + what + " '" + files[k] + "'";
      if (arguments_.skip_changed) return;
      throw FormatError(out.skipped +
                        ": frames of one motion need the same triangles and equal numbers of vertices; --skip-changed "
                        "skips steps between other frames");
    }
    ObjectMotion motion;
    motion.object = object_;
    motion.vertices = next_->vertices;
    add_result(arguments_.first ? first_of_step(motion) : scene_.continuous({&motion, 1}, impact_, context_), mesh_,
               next_->vertices, limit_, out);
  }

  /// Returns the first contact of a step, as the only collision.
  SceneCollisions first_of_step(const ObjectMotion& motion) {
    Stopwatch watch;
    const auto contact = scene_.first_contact({&motion, 1}, impact_, context_);
    SceneCollisions out = contact ? collisions_of(*contact) : SceneCollisions{};
    out.phases.push_back({"first contact", watch.lap()});
    return out;
  }

  const ProximityArguments& arguments_;
  const SceneQuery& query_;
  const Context& context_;
  ImpactOptions impact_;
  SceneQuestion asked_;
  std::optional<double> weld_;
  std::size_t limit_;
  ProximityScene scene_;
  ObjectId object_;
  TriangleMesh mesh_;
  std::optional<TriangleMesh> next_;
};

/// Results of all frames.
struct Answer {
  Json frames = Json::array();
  Json counts = Json::array();
  Json earliest = Json::array();
  Json skipped = Json::array();
  std::size_t pairs = 0;
  std::optional<std::size_t> first;  ///< first frame with collisions before the next frame
  double first_time = 0;
  std::size_t most = 0;  ///< largest number of pairs in a frame
  std::vector<PhaseTime> phases;
  std::vector<Warning> warnings;  ///< those of the first frame: pairs that meet later may still meet in the next frames

  void add(std::size_t k, Frame frame) {
    if (k == 0) warnings = std::move(frame.warnings);
    pairs += frame.count;
    most = std::max(most, frame.count);
    counts.push_back(frame.count);
    earliest.push_back(to_json(frame.earliest));
    if (frame.earliest && !first) {
      first = k;
      first_time = *frame.earliest;
    }
    Json facts{{"pairs", std::move(frame.pairs)}, {"stages", to_json(frame.phases)}};
    if (!frame.skipped.empty()) {
      facts["skipped"] = frame.skipped;
      skipped.push_back({{"frame", k}, {"reason", frame.skipped}});
    }
    frames.push_back(std::move(facts));
    phases.insert(phases.end(), frame.phases.begin(), frame.phases.end());
  }
};

std::string pairs_text(const ProximityArguments& a, const Answer& answer) {
  std::string text = plural(answer.pairs, "pair", "pairs");
  if (answer.first) {
    text += "; the first from '" + a.scene[*answer.first] + "' to '" + a.scene[*answer.first + 1] + "', at time " +
            rounded_text(answer.first_time);
  }
  if (!a.output) return text;
  if (const std::size_t limit = read_limit(a); answer.most > limit) {
    text += "; only the first " + count_text(limit) + " pairs of each frame were written (--limit)";
  }
  return text + "; view them with: blum view FRAMES --frames --pairs " + *a.output;
}

TextTable table_of(const ProximityArguments& a, const Answer& answer, const PhaseSummary& spent) {
  TextTable table;
  table.add("found", pairs_text(a, answer));
  table.add("frames", count_text(a.scene.size()));
  for (std::size_t k = 0; k < std::min(answer.skipped.size(), most_rows); ++k) {
    table.add("skipped", answer.skipped[k]["reason"].text());
  }
  if (answer.skipped.size() > most_rows) {
    table.add("...", plural(answer.skipped.size() - most_rows, "step", "steps") + " more: --json FILE lists all");
  }
  if (a.output) table.add("wrote", *a.output);
  spent.add_to(table);
  return table;
}

Json json_of(const ProximityArguments& a, const Answer& answer, const PhaseSummary& spent, int threads) {
  Json facts{{"query", a.query}, {"frames", a.scene.size()}, {"pairs", answer.counts}};
  if (a.query == "continuous") {
    facts["earliest"] = answer.earliest;
    facts["skipped"] = answer.skipped;
  }
  facts["seconds"] = spent.seconds;
  facts["total_seconds"] = spent.total;
  facts["peak_memory_bytes"] = peak_memory();
  facts["threads"] = threads;
  facts["warnings"] = to_json(answer.warnings);
  facts["limit"] = limit_json(a);
  facts["outputs"] = outputs_json(a);
  return answer_json("proximity", facts);
}

void write(const ProximityArguments& a, Answer& answer) {
  AtomicFile file(*a.output);
  file.write(Json{{"query", a.query}, {"files", a.scene}, {"frames", std::move(answer.frames)}}.dump() + "\n");
  file.commit();
}

}  // namespace

void run_frames(const ProximityArguments& a, const SceneQuery& query) {
  check(a);
  check(a.impact.read());
  check(a.penetration.read());
  check(a.culling.read());
  const int threads = parse_threads(a.threads);
  std::vector<fs::path> outputs = a.report.files();
  if (a.output) outputs.emplace_back(*a.output);
  check_outputs(outputs, {a.scene.begin(), a.scene.end()});
  Progress progress(!a.report.quiet);
  const Interrupt interrupt;
  Context context = make_context(threads, progress, interrupt);
  const auto show = std::exchange(context.progress, {});
  Sequence sequence(a, query, context);
  Answer answer;
  for (std::size_t k = 0; k < a.scene.size(); ++k) {
    throw_if_cancelled(context);
    answer.add(k, sequence.frame(k));
    if (show) show(static_cast<double>(k + 1) / static_cast<double>(a.scene.size()), "frames");
  }
  if (a.output) {
    Stopwatch watch;
    write(a, answer);
    answer.phases.push_back({"write", watch.lap()});
  }
  progress.clear();
  const PhaseSummary spent = summarize(answer.phases);
  report(a.report, json_of(a, answer, spent, thread_count(context)), table_of(a, answer, spent));
  if (!a.report.quiet) warn(answer.warnings);
}

}  // namespace blum::cli
