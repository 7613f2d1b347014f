// Proves that readers get every byte of a pipe. A pipe can be read only once, but its format is found from its first
// bytes. Formats that are read in parts refuse pipes.
#include <gtest/gtest.h>
#include <sys/stat.h>

#include <fstream>
#include <string>
#include <thread>

#include "blum/io/field_io.hpp"
#include "blum/io/file_content.hpp"
#include "blum/io/formats.hpp"
#include "blum/io/mesh_io.hpp"
#include "blum/shapes/generators.hpp"
#include "unit/io/temporary_folder.hpp"

namespace blum {
namespace {

using test::TemporaryFolder;

/// A named pipe into which a thread writes the content of a file, once. It must be read before it is destroyed.
class Pipe {
 public:
  Pipe(const std::filesystem::path& path, const std::filesystem::path& file) {
    EXPECT_EQ(::mkfifo(path.c_str(), 0600), 0);
    const std::string content = test::file_content(file);
    writer_ = std::thread([path, content] { std::ofstream(path, std::ios::binary) << content; });
  }
  Pipe(const Pipe&) = delete;
  Pipe& operator=(const Pipe&) = delete;
  ~Pipe() { writer_.join(); }

 private:
  std::thread writer_;
};

void expect_equal(const TriangleMesh& a, const TriangleMesh& b) {
  EXPECT_EQ(a.vertices, b.vertices);
  EXPECT_EQ(a.triangles, b.triangles);
}

/// The mesh is larger than the buffers of a pipe and of a stream, so a reader that opens it twice loses a part.
TEST(Pipes, AreReadToTheirEndByEveryMeshReader) {
  const TemporaryFolder folder;
  const TriangleMesh mesh = make_sphere({.frequency = 40});
  int tested = 0;
  for (const std::string& end : file_extensions(FileContent::mesh, FileAccess::write)) {
    if (!MeshFormat::by_name("m" + end)) continue;  // written only
    SCOPED_TRACE(end);
    const auto file = folder / ("m" + end);
    write_mesh(file, mesh);
    const MeshFile expected = read_mesh_file(file);
    for (const std::string& name : {"p" + end, "q" + end.substr(1)}) {
      SCOPED_TRACE(name);
      const auto path = folder / name;
      if (!MeshFormat::by_name(path) && !MeshFormat::by_head(test::file_content(file).substr(0, 4096))) continue;
      for (int time = 0; time < 2; ++time) {  // the second content of the same pipe is not the first one
        const auto own = time == 0 ? file : folder / ("n" + end);
        if (time == 1) write_mesh(own, make_sphere({.frequency = 30}));
        std::filesystem::remove(path);
        const Pipe pipe(path, own);
        EXPECT_EQ(content_of(path), FileContent::mesh);
        expect_equal(read_mesh_of_any_name(path).mesh, time == 0 ? expected.mesh : read_mesh_file(own).mesh);
        ++tested;
      }
    }
  }
  EXPECT_GE(tested, 12);
}

TEST(Pipes, AreRefusedByFormatsThatAreReadInParts) {
  const TemporaryFolder folder;
  const auto path = folder / "p.npz";
  ASSERT_EQ(::mkfifo(path.c_str(), 0600), 0);  // nobody writes: opening it would wait forever
  try {
    static_cast<void>(read_field(path));
    FAIL() << "a pipe was read in parts";
  } catch (const FileError& error) {
    EXPECT_NE(std::string(error.what()).find("it is a pipe"), std::string::npos) << error.what();
  }
}

}  // namespace
}  // namespace blum
