// Proves that readers get every byte of a pipe. A pipe can be read only once, but its format is found from its first
// bytes.
#include <gtest/gtest.h>
#include <sys/stat.h>

#include <algorithm>
#include <cstdint>
#include <fstream>
#include <string>
#include <thread>
#include <vector>

#include "blum/field/field.hpp"
#include "blum/io/field_io.hpp"
#include "blum/io/file_content.hpp"
#include "blum/io/formats.hpp"
#include "blum/io/image_io.hpp"
#include "blum/io/mesh_io.hpp"
#include "blum/io/point_io.hpp"
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
  EXPECT_GE(tested, 16);
}

VoxelImage test_image() {
  VoxelImage image;
  image.grid.size = {40, 50, 60};
  std::vector<std::uint8_t> values(image.grid.node_count());
  for (std::size_t i = 0; i < values.size(); ++i) values[i] = static_cast<std::uint8_t>(i * i % 251);
  image.values = values;
  return image;
}

/// Images are larger than the buffer of a pipe, and are read in parts.
TEST(Pipes, AreReadOnceByEveryImageReader) {
  const TemporaryFolder folder;
  const VoxelImage image = test_image();
  for (const std::string& end : file_extensions(FileContent::image, FileAccess::write)) {
    SCOPED_TRACE(end);
    const auto file = folder / ("i" + end);
    write_image(file, image.view());
    for (const std::string& name : {"p" + end, "q" + end.substr(1)}) {
      const auto path = folder / name;
      const Pipe pipe(path, file);
      EXPECT_EQ(content_of(path), FileContent::image);
      const ImageFile read = read_image_of_any_name(path);
      EXPECT_EQ(read.image.values, image.values);
      ASSERT_TRUE(read.format);
      EXPECT_EQ(read.format->name(), image_format_name(file));
    }
  }
}

TEST(Pipes, AreReadOnceByEveryFieldReader) {
  const TemporaryFolder folder;
  const TriangleMesh mesh = make_sphere({.frequency = 4});
  const Field field = distance_field(mesh, grid_around(bounds(mesh), 24));
  for (const std::string& end : file_extensions(FileContent::field, FileAccess::write)) {
    SCOPED_TRACE(end);
    const auto file = folder / ("f" + end);
    write_field(file, field);
    for (const std::string& name : {"p" + end, "q" + end.substr(1)}) {
      const auto path = folder / name;
      if (!FieldFormat::by_name(path) && end != ".nrrd") continue;  // only NRRD is known by its first bytes
      const Pipe pipe(path, file);
      EXPECT_EQ(content_of(path), FileContent::field);
      EXPECT_FALSE(holds_complex(path));
      const Field read = read_field(path);
      EXPECT_TRUE(std::ranges::equal(read.distance.span(), field.distance.span()));
    }
  }
}

TEST(Pipes, AreReadOnceByEveryPointReader) {
  const TemporaryFolder folder;
  const auto rows = folder / "rows.csv";
  std::ofstream(rows) << "x,y,z\n1,2,3\n4,5,6\n";
  const std::vector<Vec3d> expected{{1, 2, 3}, {4, 5, 6}};
  for (const char* const name : {"p.csv", "p.xyz", "p"}) {
    const Pipe pipe(folder / name, rows);
    EXPECT_EQ(read_points(folder / name), expected) << name;
  }
}

TEST(Pipes, AreRefusedAsOneOfSeveralFiles) {
  const TemporaryFolder folder;
  const auto path = folder / "data.raw";
  ASSERT_EQ(::mkfifo(path.c_str(), 0600), 0);  // nobody writes: opening it would wait forever
  std::ofstream(folder / "i.nhdr") << "NRRD0004\ntype: uint8\ndimension: 3\nsizes: 2 2 2\nencoding: raw\n"
                                      "data file: data.raw\n\n";
  try {
    static_cast<void>(read_image(folder / "i.nhdr"));
    FAIL() << "a pipe was read as one of several files";
  } catch (const FileError& error) {
    EXPECT_NE(std::string(error.what()).find("it is a pipe"), std::string::npos) << error.what();
  }
}

}  // namespace
}  // namespace blum
