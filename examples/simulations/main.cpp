// Simulations that end with no missed collision, by the library's own continuous check:
//
//   simulations cloth|bodies|breaking|large [FOLDER] [--frames N]
//
// writes FOLDER/frame_000.ply and so on, and FOLDER/pairs.json, which `blum view FOLDER/frame_*.ply --frames --pairs
// FOLDER/pairs.json -o page.html` shows. Without arguments it runs a few frames of each, and writes nothing.
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "blum/core/error.hpp"
#include "blum/io/mesh_io.hpp"
#include "scenes.hpp"

namespace {

namespace fs = std::filesystem;
using simulations::Scene;
using simulations::StepReport;

constexpr double frame_seconds = 1.0 / 30;

std::unique_ptr<Scene> make(const std::string& name) {
  if (name == "cloth") return simulations::make_cloth_scene();
  if (name == "bodies") return simulations::make_bowl_scene(10, 8);
  if (name == "breaking") return simulations::make_breaking_scene();
  if (name == "large") return simulations::make_bowl_scene(16, 40);
  return nullptr;
}

/// What the viewer draws and charts of a frame.
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
  void finish() { file_ << "\n]}\n"; }

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

/// @return whether no step passed anything through anything.
bool run(const std::string& name, int frames, const std::optional<fs::path>& folder) {
  const std::unique_ptr<Scene> scene = make(name);
  std::optional<Record> record;
  if (folder) {
    fs::create_directories(*folder);
    record.emplace(*folder / "pairs.json");
  }
  std::size_t prevented = 0;
  double time = 0;
  StepReport last;
  for (int frame = 0; frame < frames; ++frame) {
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
    blum::write_mesh(*folder / file, scene->world.mesh());
    record->add(*scene, sum);
    std::cerr << name << " frame " << frame << ": " << sum.close_pairs << " close pairs, " << sum.impacts
              << " collisions prevented\n";
  }
  if (record) record->finish();
  const std::size_t missed = scene->world.collisions_in_steps() + scene->world.scene().collisions().pairs.size();
  std::cout << name << ": " << frames << " frames, " << scene->world.mesh().triangles.size() << " triangles, "
            << prevented << " collisions prevented, " << missed << " missed\n";
  return missed == 0;
}

}  // namespace

int main(int argc, char** argv) try {
  std::vector<std::string> words(argv + 1, argv + argc);
  int frames = 60;
  for (std::size_t k = 0; k + 1 < words.size(); ++k) {
    if (words[k] != "--frames") continue;
    frames = std::stoi(words[k + 1]);
    words.erase(words.begin() + static_cast<std::ptrdiff_t>(k), words.begin() + static_cast<std::ptrdiff_t>(k) + 2);
    break;
  }
  if (words.empty()) {
    bool is_fine = true;
    for (const char* name : {"cloth", "bodies", "breaking"}) is_fine = run(name, 6, std::nullopt) && is_fine;
    return is_fine ? 0 : 1;
  }
  if (words.size() > 2 || make(words[0]) == nullptr) {
    std::cerr << "simulations cloth|bodies|breaking|large [FOLDER] [--frames N]\n";
    return 2;
  }
  return run(words[0], frames, words.size() == 2 ? fs::path(words[1]) : fs::path(words[0])) ? 0 : 1;
} catch (const blum::Error& error) {
  std::cerr << error.what() << "\n";
  return 1;
}
