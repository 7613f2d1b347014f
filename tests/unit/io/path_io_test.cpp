// Proves that path files keep every number, and that wrong files are rejected with the place of the error.
#include "blum/io/path_io.hpp"

#include <gtest/gtest.h>

#include <cstddef>
#include <fstream>
#include <string>
#include <vector>

#include "blum/core/error.hpp"
#include "blum/core/random.hpp"
#include "unit/io/temporary_folder.hpp"

namespace blum {
namespace {

namespace fs = std::filesystem;

PathFile sample() {
  Random random(9);
  PathFile out;
  out.bodies = {{"robot \"1\".ply", 12, "0123abcd"}, {"arm.stl", 1ULL << 40, "ffffffff"}};
  out.obstacles = {{"../walls.obj", 3, "00000000"}};
  out.centres = {{0.1, -1e-300, 3}, {1e17, 1.0 / 3, 0}};
  for (int k = 0; k < 3; ++k) {
    std::vector<PoseNumbers>& waypoint = out.poses.emplace_back();
    for (int body = 0; body < 2; ++body) {
      PoseNumbers& pose = waypoint.emplace_back();
      for (double& number : pose) number = random.uniform(-1, 1);
    }
  }
  out.clearance = 0.1;
  out.intervals = {{0, 0, 0.3, 0.1}, {0, 0.3, 1, 0.2}, {1, 0, 1, 1e-5}};
  return out;
}

class PathFiles : public testing::Test {
 protected:
  [[nodiscard]] fs::path name(const char* file) const { return folder_.path() / file; }
  [[nodiscard]] fs::path with(const char* file, const std::string& text) const {
    std::ofstream(name(file), std::ios::binary) << text;
    return name(file);
  }
  /// Returns the message of the error that a file causes.
  [[nodiscard]] static std::string error_of(const fs::path& file) {
    try {
      static_cast<void>(read_path(file));
    } catch (const FormatError& error) {
      return error.what();
    }
    return "no error";
  }

 private:
  test::TemporaryFolder folder_;
};

TEST_F(PathFiles, KeepEverything) {
  const PathFile file = sample();
  write_path(name("a.json"), file);
  const PathFile again = read_path(name("a.json"));
  EXPECT_EQ(again.bodies, file.bodies);
  EXPECT_EQ(again.obstacles, file.obstacles);
  EXPECT_EQ(again.centres, file.centres);
  EXPECT_EQ(again.poses, file.poses);
  EXPECT_EQ(again.clearance, file.clearance);
  ASSERT_EQ(again.intervals.size(), file.intervals.size());
  for (std::size_t k = 0; k < file.intervals.size(); ++k) {
    EXPECT_EQ(again.intervals[k].edge, file.intervals[k].edge);
    EXPECT_EQ(again.intervals[k].from, file.intervals[k].from);
    EXPECT_EQ(again.intervals[k].to, file.intervals[k].to);
    EXPECT_EQ(again.intervals[k].clearance, file.intervals[k].clearance);
  }
}

TEST_F(PathFiles, DescribeMeshes) {
  const PathMesh mesh = describe_path_mesh(with("mesh.off", "123456789"), name("."));
  EXPECT_EQ(mesh.bytes, 9U);
  EXPECT_EQ(mesh.crc32, "cbf43926");  // the check value of CRC-32
  EXPECT_EQ(mesh.file, "mesh.off");
  EXPECT_THROW(static_cast<void>(describe_path_mesh(name("none.off"), name("."))), FileError);
}

TEST_F(PathFiles, ReadPosesOfOtherPrograms) {
  const PathFile file = read_path(with("a.csv", "x,y,z,qw,qx,qy,qz\r\n1,2,3,1,0,0,0\r\n\n# note\n 4, 5,+6e0,0,0,0,1"));
  ASSERT_EQ(file.poses.size(), 2U);
  EXPECT_EQ(file.poses[1][0], (PoseNumbers{4, 5, 6, 0, 0, 0, 1}));
  EXPECT_TRUE(file.bodies.empty());
  EXPECT_FALSE(file.clearance);
  EXPECT_NE(error_of(with("b.csv", "1,2,3,1,0,0,0\n1,2,3\n")).find("line 2: found 3 numbers"), std::string::npos);
  EXPECT_NE(error_of(with("c.csv", "1,2,3,1,0,0,0\nend\n")).find("line 2: found text"), std::string::npos);
  EXPECT_NE(error_of(with("d.csv", "x,y\n")).find("no rows"), std::string::npos);
}

TEST_F(PathFiles, AreRejectedIfTheyAreCut) {
  write_path(name("a.json"), sample());
  std::ifstream in(name("a.json"), std::ios::binary);
  const std::string whole((std::istreambuf_iterator<char>(in)), {});
  for (std::size_t size = 0; size + 2 < whole.size(); size += 7) {
    EXPECT_NE(error_of(with("cut.json", whole.substr(0, size))), "no error") << size;
  }
}

TEST_F(PathFiles, NameTheWrongMember) {
  write_path(name("a.json"), sample());
  std::ifstream in(name("a.json"), std::ios::binary);
  const std::string whole((std::istreambuf_iterator<char>(in)), {});
  const auto changed = [&](const std::string& from, const std::string& to) {
    std::string text = whole;
    text.replace(text.find(from), from.size(), to);
    return error_of(with("changed.json", text));
  };
  EXPECT_NE(changed("blum-path", "other").find("not a path file"), std::string::npos);
  EXPECT_NE(changed("\"version\": 1", "\"version\": 2").find("version"), std::string::npos);
  EXPECT_NE(changed("\"centres\"", "\"centers\"").find("\"centres\" is missing"), std::string::npos);
  EXPECT_NE(changed("\"clearance\": 0.1", "\"clearance\": null").find("not a number"), std::string::npos);
  EXPECT_NE(changed("[0, 0.3, 1, 0.2]", "[0, 0.3, 1]").find("lists of 4 numbers"), std::string::npos);
  EXPECT_NE(changed("[0, 0.3, 1, 0.2]", "[-1, 0.3, 1, 1]").find("not a number of a motion"), std::string::npos);
  EXPECT_NE(changed("\"bytes\": 12", "\"bytes\": -12").find("a mesh without"), std::string::npos);
  EXPECT_THROW(static_cast<void>(read_path(name("a.txt"))), InvalidOption);
  EXPECT_THROW(write_path(name("a.csv"), sample()), InvalidOption);
}

}  // namespace
}  // namespace blum
