#include "planning/path_check.hpp"

#include <utility>

#include "blum/certificate/path_certificate.hpp"
#include "blum/io/mesh_io.hpp"
#include "blum/io/path_io.hpp"
#include "common/described.hpp"
#include "common/files.hpp"
#include "common/options.hpp"

namespace blum::cli {
namespace {

namespace fs = std::filesystem;

/// Meshes of a path, and their files.
struct PathMeshes {
  std::vector<TriangleMesh> bodies, obstacles;
  std::vector<std::string> mismatches;  ///< files that differ from those that the path file states
};

/// Reads a mesh that a path file names, and compares it with the stated size and checksum.
TriangleMesh stated_mesh(const fs::path& path, const PathMesh& stated, std::vector<std::string>& mismatches) {
  const fs::path folder = path.parent_path();
  const fs::path file = fs::path(stated.file).is_absolute() ? fs::path(stated.file) : folder / stated.file;
  const PathMesh found = describe_path_mesh(file, folder);
  if (found.bytes != stated.bytes || found.crc32 != stated.crc32) {
    mismatches.push_back("'" + file.string() + "' is not the mesh of the path: it has " + std::to_string(found.bytes) +
                         " bytes and the checksum " + found.crc32 + ", but the path file states " +
                         std::to_string(stated.bytes) + " and " + stated.crc32);
  }
  return read_mesh(file);
}

PathMeshes meshes_of(const PathCheck& check, const PathFile& file) {
  PathMeshes out;
  const std::size_t bodies = file.poses.front().size();
  if (check.meshes.empty()) {
    if (file.bodies.empty()) {
      throw UsageError("'" + check.path.string() +
                       "' does not name the meshes; give the body and the obstacles after it");
    }
    for (const PathMesh& mesh : file.bodies) out.bodies.push_back(stated_mesh(check.path, mesh, out.mismatches));
    for (const PathMesh& mesh : file.obstacles) out.obstacles.push_back(stated_mesh(check.path, mesh, out.mismatches));
    return out;
  }
  if (check.meshes.size() < bodies) {
    throw UsageError("the path moves " + std::to_string(bodies) + " bodies, but only " +
                     std::to_string(check.meshes.size()) + " meshes are given; give the bodies, then the obstacles");
  }
  for (std::size_t k = 0; k < check.meshes.size(); ++k) {
    (k < bodies ? out.bodies : out.obstacles).push_back(read_mesh(check.meshes[k]));
  }
  return out;
}

StatedPath stated_path(const PathFile& file, const PathMeshes& meshes, const std::optional<double>& clearance) {
  StatedPath out{.centres = file.centres, .poses = file.poses, .clearance = 0, .intervals = {}};
  if (out.centres.empty()) {
    for (const TriangleMesh& body : meshes.bodies) out.centres.push_back(bounds(body).center());
  }
  out.clearance = clearance.value_or(file.clearance.value_or(0));
  // The stated proof belongs to the stated clearance.
  if (clearance) return out;
  for (const PathInterval& one : file.intervals) out.intervals.push_back({one.edge, one.from, one.to, one.clearance});
  return out;
}

}  // namespace

bool is_path_file(const fs::path& path) {
  return PathFormat::by_name(path).has_value();
}

void check_path(const PathCheck& check, Progress& progress, const Context& context) {
  std::vector<fs::path> inputs = check.meshes;
  inputs.push_back(check.path);
  check_outputs(check.report.files(), inputs);
  const PathFile file = read_path(check.path);
  const PathMeshes meshes = meshes_of(check, file);
  const StatedPath stated = stated_path(file, meshes, check.clearance);
  const std::vector<MeshView> bodies(meshes.bodies.begin(), meshes.bodies.end());
  const std::vector<MeshView> obstacles(meshes.obstacles.begin(), meshes.obstacles.end());
  PathCertificate certificate = verify_path(bodies, obstacles, stated, context);
  certificate.mismatches.insert(certificate.mismatches.begin(), meshes.mismatches.begin(), meshes.mismatches.end());
  certificate.holds = certificate.mismatches.empty();
  progress.clear();
  TextTable table;
  table.add("path", std::string(certificate.holds ? "certified: " : "NOT certified: ") +
                        plural(certificate.edges, "motion", "motions") + " of " +
                        plural(bodies.size(), "body", "bodies") + ", clearance " + rounded_text(certificate.clearance));
  table.detail("tests", count_text(certificate.tests) + " times at which distances were compared");
  Json facts = {{"input", {{"file", check.path.string()}, {"bodies", bodies.size()}, {"obstacles", obstacles.size()}}},
                {"path", to_json(certificate)}};
  report(check.report, answer_json("verify", facts), table);
  if (!certificate.holds) throw NotCertified(certificate.mismatches);
}

}  // namespace blum::cli
