// Example: simulations without a missed collision, by the library's continuous check. See simulations --help.
#include <charconv>
#include <cmath>
#include <csignal>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <system_error>
#include <utility>
#include <vector>

#include "blum/core/error.hpp"
#include "blum/io/mesh_io.hpp"
#include "scenes.hpp"

namespace {

namespace fs = std::filesystem;
using simulations::Scene;
using simulations::StepReport;

constexpr double frame_seconds = 1.0 / 30;
constexpr int most_frames = 1000;

constexpr const char* help = R"(simulations cloth|bodies|breaking|large [FOLDER] [--frames N]

Runs N frames (1 to 1000; default 60, for large 12) of a simulation. Writes FOLDER/frame_000.ply and so on, and
FOLDER/pairs.json. `blum view FOLDER/frame_*.ply --frames --pairs FOLDER/pairs.json -o page.html` shows them. FOLDER is
the name of the simulation by default. Results go to FOLDER.part. They replace earlier results at the end, or when
Ctrl-C ends the run after the current frame. Without arguments, runs a few frames of each and writes nothing.

Continuous collision checks cover all pairs of objects, and each object that is not rigid with itself. A step is
shortened before objects meet. Exit status: 0 if no collision was missed, 2 for bad usage, 1 for any other failure.
)";

volatile std::sig_atomic_t is_stopped = 0;

/// Error of the command line, with exit status 2.
class UsageError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

struct Arguments {
  std::vector<std::string> words;
  std::optional<int> frames;
};

int frames_of(const std::string& text) {
  int frames = 0;
  const char* const end = text.data() + text.size();
  const auto [at, error] = std::from_chars(text.data(), end, frames);
  if (error != std::errc{} || at != end || frames < 1 || frames > most_frames) {
    throw UsageError("--frames '" + text + "': must be a whole number from 1 to " + std::to_string(most_frames));
  }
  return frames;
}

Arguments read(const std::vector<std::string>& given) {
  Arguments out;
  for (std::size_t k = 0; k < given.size(); ++k) {
    if (given[k] == "--frames") {
      if (k + 1 == given.size()) throw UsageError("--frames takes a number");
      out.frames = frames_of(given[++k]);
    } else if (given[k].starts_with("-")) {
      throw UsageError("there is no option " + given[k]);
    } else {
      out.words.push_back(given[k]);
    }
  }
  if (out.words.size() > 2) throw UsageError("'" + out.words[2] + "' was not expected: give only one folder");
  return out;
}

std::unique_ptr<Scene> make(const std::string& name) {
  if (name == "cloth") return simulations::make_cloth_scene();
  if (name == "bodies") return simulations::make_bowl_scene(10, 8);
  if (name == "breaking") return simulations::make_breaking_scene();
  if (name == "large") return simulations::make_bowl_scene(16, 40);
  return nullptr;
}

/// Results in a folder, which stay in a draft folder until they are complete.
class Results {
 public:
  /// @throws FileError if the folder cannot be made, before any work.
  explicit Results(fs::path folder) : folder_(std::move(folder)), draft_(folder_.string() + ".part") {
    guarded([&] {
      if (fs::exists(folder_) && !fs::is_directory(folder_)) {
        throw blum::FileError("'" + folder_.string() + "' is not a folder; name another one");
      }
      fs::create_directories(folder_);
      fs::remove_all(draft_);
      fs::create_directory(draft_);
    });
  }
  [[nodiscard]] const fs::path& draft() const { return draft_; }
  /// Replaces earlier results.
  void publish() const {
    guarded([&] {
      for (const fs::path& old : results_in(folder_)) fs::remove(old);
      for (const fs::path& file : results_in(draft_)) fs::rename(file, folder_ / file.filename());
      fs::remove(draft_);
    });
  }

 private:
  static std::vector<fs::path> results_in(const fs::path& folder) {
    std::vector<fs::path> out;
    for (const auto& entry : fs::directory_iterator(folder)) {
      const std::string name = entry.path().filename().string();
      const bool is_frame = name.starts_with("frame_") && name.ends_with(".ply");
      if (is_frame || name == "pairs.json") out.push_back(entry.path());
    }
    return out;
  }
  template <class Work>
  static void guarded(const Work& work) {
    try {
      work();
    } catch (const fs::filesystem_error& error) {
      throw blum::FileError("cannot write '" + error.path1().string() + "': " + error.code().message() +
                            "; name a writable folder");
    }
  }

  fs::path folder_;
  fs::path draft_;
};

/// Writes the pairs and times of frames that the viewer draws.
class Record {
 public:
  explicit Record(const fs::path& path) : file_(path) {
    file_.precision(9);
    file_ << "{\"frames\": [";
  }
  void add(const Scene& scene, const StepReport& sum) {
    file_ << (is_first_ ? "\n" : ",\n") << "{\"pairs\": [";
    is_first_ = false;
    bool is_next = false;
    for (const StepReport::Impact& impact : sum.shown) {
      tell(is_next, "collision", impact.first, impact.second, length(impact.first - impact.second), impact.time);
    }
    for (const blum::PrimitivePair& pair : scene.world.scene().separation(0.2).pairs) {
      tell(is_next, "closest", pair.between.first_point, pair.between.second_point, pair.between.distance, {});
    }
    file_ << "], \"stages\": {\"boxes\": " << sum.hierarchy_seconds << ", \"close pairs\": " << sum.close_seconds
          << ", \"continuous collisions\": " << sum.impact_seconds << "}}";
  }
  /// @throws FileError if the file is not written completely.
  void finish() {
    file_ << "\n]}\n";
    file_.close();
    if (!file_) throw blum::FileError("cannot write all of pairs.json; check the free disk space");
  }

 private:
  void tell(bool& is_next, const char* kind, const blum::Vec3d& a, const blum::Vec3d& b, double distance,
            std::optional<double> time) {
    file_ << (is_next ? ", " : "") << "{\"kind\": \"" << kind << "\", \"points\": [[" << a.x << ", " << a.y << ", "
          << a.z << "], [" << b.x << ", " << b.y << ", " << b.z << "]], \"distance\": " << distance;
    if (time) file_ << ", \"time\": " << *time;
    file_ << "}";
    is_next = true;
  }

  std::ofstream file_;
  bool is_first_ = true;
};

void add(const StepReport& step, StepReport& sum) {
  sum.hierarchy_seconds += step.hierarchy_seconds;
  sum.close_seconds += step.close_seconds;
  sum.impact_seconds += step.impact_seconds;
  sum.impacts += step.impacts;
  sum.close_pairs += step.close_pairs;
  sum.shown.insert(sum.shown.end(), step.shown.begin(), step.shown.end());
}

/// @return true if no collision was missed.
bool run(const std::string& name, int frames, const std::optional<fs::path>& folder) {
  const std::unique_ptr<Scene> scene = make(name);
  std::optional<Results> results;
  std::optional<Record> record;
  if (folder) {
    results.emplace(*folder);
    record.emplace(results->draft() / "pairs.json");
  }
  std::size_t prevented = 0;
  double time = 0;
  StepReport last;
  int frame = 0;
  for (; frame < frames && is_stopped == 0; ++frame) {
    StepReport sum;
    for (int step = 0; step < std::lround(frame_seconds / scene->step); ++step) {
      time += scene->step;
      scene->drive(time, last);
      last = scene->world.step();
      add(last, sum);
    }
    prevented += sum.impacts;
    if (!folder) continue;
    char file[32];
    std::snprintf(file, sizeof file, "frame_%03d.ply", frame);
    blum::write_mesh(results->draft() / file, scene->world.mesh());
    record->add(*scene, sum);
    std::cerr << name << " frame " << frame << ": " << sum.close_pairs << " close pairs, " << sum.impacts
              << " collisions prevented\n";
  }
  if (record) {
    record->finish();
    results->publish();
  }
  const std::size_t missed = scene->world.collisions_in_steps() + scene->world.scene().collisions().pairs.size();
  std::cout << name << ": " << frame << " frames, " << scene->world.mesh().triangles.size() << " triangles, "
            << prevented << " collisions prevented, " << missed << " missed\n";
  return missed == 0;
}

}  // namespace

int main(int argc, char** argv) try {
  const std::vector<std::string> given(argv + 1, argv + argc);
  for (const std::string& word : given) {
    if (word != "--help" && word != "-h") continue;
    std::cout << help;
    return 0;
  }
  const Arguments arguments = read(given);
  const std::vector<std::string>& words = arguments.words;
  if (words.empty()) {
    bool is_fine = true;
    for (const char* name : {"cloth", "bodies", "breaking"}) is_fine = run(name, 6, std::nullopt) && is_fine;
    return is_fine ? 0 : 1;
  }
  if (make(words[0]) == nullptr) {
    throw UsageError("there is no simulation '" + words[0] + "': it must be cloth, bodies, breaking or large");
  }
  std::signal(SIGINT, [](int) { is_stopped = 1; });
  constexpr int usual_frames = 60;
  constexpr int frames_of_large = 12;  // 500,000 triangles take minutes
  const int frames = arguments.frames.value_or(words[0] == "large" ? frames_of_large : usual_frames);
  return run(words[0], frames, fs::path(words.back())) ? 0 : 1;
} catch (const UsageError& error) {
  std::cerr << "simulations: error: " << error.what() << "; see simulations --help\n";
  return 2;
} catch (const blum::Error& error) {
  std::cerr << "simulations: error: " << error.what() << "\n";
  return 1;
} catch (const std::exception& error) {
  std::cerr << "simulations: error: " << error.what() << "\n";
  return 1;
}
