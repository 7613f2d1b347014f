// Proves that the table of formats agrees with readers and writers, and that written files are recognized by name and
// first bytes. Drafts replace files or are removed.
#include "blum/io/formats.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <sstream>

#include "blum/io/complex_io.hpp"
#include "blum/io/draft.hpp"
#include "blum/io/field_io.hpp"
#include "blum/io/file_content.hpp"
#include "blum/io/image_io.hpp"
#include "blum/io/medial_io.hpp"
#include "blum/io/point_io.hpp"
#include "unit/io/temporary_folder.hpp"

namespace blum {
namespace {

using test::file_content;
using test::TemporaryFolder;

const TriangleMesh triangle{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 2}}, {}, {}};

TEST(Formats, MeshesAreKnownByNameAndContent) {
  const TemporaryFolder folder;
  for (const std::string& end : file_extensions(FileContent::mesh, FileAccess::write)) {
    const auto path = folder / ("m" + end);
    write_mesh(path, triangle);
    if (end == ".glb") {  // written only; no reader accepts it
      EXPECT_FALSE(MeshFormat::by_name(path).has_value());
      EXPECT_THROW((void)content_of(path), FileError);
      EXPECT_THROW((void)read_mesh(path), FileError);
      EXPECT_THROW((void)read_mesh(std::span<const std::byte>(), MeshFormat("GLB")), InvalidOption);
      continue;
    }
    EXPECT_EQ(content_of(path), FileContent::mesh) << end;
    const auto by_name = MeshFormat::by_name(path);
    ASSERT_TRUE(by_name.has_value());
    EXPECT_EQ(by_name, MeshFormat::by_name("M" + end));
    if (end == ".stl") continue;  // binary files have no signature
    const auto nameless = folder / ("m" + end.substr(1));
    std::filesystem::copy_file(path, nameless);
    EXPECT_EQ(content_of(nameless), FileContent::mesh) << end;
    EXPECT_EQ(read_mesh_of_any_name(nameless).mesh.triangles, triangle.triangles) << end;
  }
  EXPECT_TRUE(extension_list(FileContent::mesh, FileAccess::read).starts_with(".obj .off .stl .ply"));
  EXPECT_FALSE(MeshFormat::by_name("a.nrrd").has_value());
}

TEST(Formats, ImagesAndFieldsAreDistinguished) {
  const TemporaryFolder folder;
  VoxelImage image;
  image.grid.size = {2, 2, 2};
  image.values = std::vector<std::uint8_t>(8, 1);
  for (const std::string& end : file_extensions(FileContent::image, FileAccess::write)) {
    const auto path = folder / ("i" + end);
    write_image(path, image.view());
    EXPECT_EQ(content_of(path), FileContent::image) << end;
    EXPECT_FALSE(may_hold_field(path));
    std::filesystem::copy_file(path, folder / ("i" + end.substr(1)));
    EXPECT_EQ(read_image_of_any_name(folder / ("i" + end.substr(1))).image.values, image.values) << end;
  }
  EXPECT_EQ(image_format_name(folder / "inrrd"), "NRRD");
  Field field;
  field.grid.size = {2, 2, 2};
  field.distance = Buffer<float>(8);
  for (std::size_t i = 0; i < 8; ++i) field.distance[i] = 1;
  for (const std::string& end : file_extensions(FileContent::field, FileAccess::write)) {
    const auto path = folder / ("f" + end);
    write_field(path, field);
    EXPECT_EQ(content_of(path), FileContent::field) << end;
    EXPECT_TRUE(may_hold_field(path) && !holds_complex(path)) << end;
  }
  EXPECT_EQ(files_of_field("a/b.nrrd"), (std::vector<std::filesystem::path>{"a/b.nrrd", "a/b.site.nrrd"}));
  EXPECT_EQ(files_of_field("a/b.nrrd", false).size(), 1U);
  EXPECT_EQ(files_of_field("b.npz").size(), 1U);
}

TEST(Formats, ComplexesAreWrittenAndKnown) {
  const TemporaryFolder folder;
  Complex complex;
  complex.positions = triangle.vertices;
  complex.triangles = triangle.triangles;
  complex.vertex_columns = Columns(3);
  complex.edge_columns = Columns(0);
  complex.triangle_columns = Columns(1);
  for (const std::string& end : file_extensions(FileContent::complex, FileAccess::write)) {
    if (end == ".ma") {  // for complexes whose vertices have a radius
      EXPECT_THROW(write_complex(folder / "c.ma", complex), InvalidOption);
      Complex balls = complex;
      balls.vertex_columns.add({"radius", 1, std::vector<double>{1, 2, 3}});
      write_complex(folder / "c.ma", balls);
      const Complex back = read_complex(folder / "c.ma").complex;
      EXPECT_EQ(back.triangles, complex.triangles);
      EXPECT_EQ(back.edges.size(), 3U);
      EXPECT_TRUE(holds_complex(folder / "c.ma"));
      balls.triangle_columns.add({"kind", 1, std::vector<std::int32_t>{7}});
      EXPECT_THROW(write_complex(folder / "c.ma", balls), InvalidOption);
      write_complex(folder / "c.ma", balls, {}, {.allow_loss = true});
      continue;
    }
    const auto path = folder / ("c" + end);
    write_complex(path, complex);
    if (end == ".glb") {
      EXPECT_FALSE(holds_complex(path));
      EXPECT_THROW((void)read_complex(path), InvalidOption);
      EXPECT_THROW((void)read_complex(std::span<const std::byte>(), ComplexFormat("glb")), InvalidOption);
      continue;
    }
    EXPECT_EQ(read_complex(path).complex.triangles, complex.triangles);
    EXPECT_EQ(holds_complex(path), end == ".vtp" || end == ".npz") << end;
  }
}

TEST(Formats, HaveOneNameAndExtensionEach) {
  for (const FileFormat& format : file_formats()) {
    EXPECT_FALSE(format.extensions.empty() && format.written.empty()) << format.name;
    for (const FileFormat& other : file_formats()) {
      if (&other == &format || other.content != format.content) continue;
      EXPECT_NE(other.name, format.name);
      for (const std::vector<std::string>& ends : {other.extensions, other.written}) {
        for (const std::string& end : ends) {
          EXPECT_EQ(std::ranges::count(format.extensions, end) + std::ranges::count(format.written, end), 0) << end;
        }
      }
    }
    if (format.extensions.empty()) continue;  // written only
    for (const std::string& end : format.written) EXPECT_EQ(std::ranges::count(format.extensions, end), 1) << end;
  }
  EXPECT_EQ(ImageFormat("nifti"), ImageFormat::of("a.hdr.gz"));
  EXPECT_THROW((void)ImageFormat::of("a.nii", FileAccess::write), InvalidOption);
  EXPECT_THROW((void)ImageFormat::of("a.nhdr", FileAccess::write), InvalidOption);
  EXPECT_THROW((void)FieldFormat::of("a.ply"), InvalidOption);
  EXPECT_EQ(MeshFormat::of("a.glb", FileAccess::write), MeshFormat("GLB"));
  EXPECT_THROW((void)MeshFormat::of("a.glb", FileAccess::both), InvalidOption);
  EXPECT_THROW((void)MeshFormat::of("a.glb"), InvalidOption);
  EXPECT_EQ(file_extensions(FileContent::image, FileAccess::both), (std::vector<std::string>{".nrrd", ".npy"}));
}

TEST(Formats, RowsGraphsAndMapsAreWrittenByName) {
  const auto written = [](FileContent content) { return extension_list(content, FileAccess::write); };
  EXPECT_EQ(written(FileContent::points), ".npz .ply .vtp .csv");
  EXPECT_EQ(written(FileContent::pairs), ".npz .csv .json .vtp");
  EXPECT_EQ(written(FileContent::collisions), ".npz .csv .json .vtp");
  EXPECT_EQ(written(FileContent::surface_map), ".npz .png .glb .ply .vtp");
  EXPECT_EQ(written(FileContent::graph), ".json .graphml");
  EXPECT_EQ(written(FileContent::centreline), ".json .csv .swc .vtp .ply .npz");
  EXPECT_EQ(written(FileContent::extended_axis), ".vtp .ply .obj .npz .stl");
  EXPECT_EQ(cloud_extensions(), (std::vector<std::string>{".npy", ".npz", ".csv", ".xyz", ".txt"}));
  EXPECT_EQ(extensions_with_radii(), (std::vector<std::string>{".vtp", ".ply", ".ma", ".npz"}));
  EXPECT_TRUE(may_hold_columns("a.PLY") && !may_hold_columns("a.obj") && !may_hold_columns("a.glb"));
  EXPECT_TRUE(may_hold_further("a.npz") && !may_hold_further("a.vtp"));
  try {
    (void)GraphFormat::of("a.txt", FileAccess::write, "graphs of medial axes");
    FAIL() << "has no known format";
  } catch (const InvalidOption& error) {
    EXPECT_STREQ(error.what(),
                 "'a.txt': graphs of medial axes are written to .json, .graphml files; use one of these extensions");
  }
}

TEST(Formats, NamesOfSeveralExtensions) {
  EXPECT_EQ(file_extension("a/B.NII.GZ"), ".nii.gz");
  EXPECT_EQ(file_extension("b.vol.gz"), ".gz");
  EXPECT_EQ(file_extension("b"), "");
  const TemporaryFolder folder;
  std::ofstream(folder / "what") << "nothing known";
  try {
    (void)content_of(folder / "what");
    FAIL() << "has no known format";
  } catch (const FileError& error) {
    for (const char* read : {".off", ".nii", ".vti", ".vtp", ".ma"}) {
      EXPECT_NE(std::string(error.what()).find(read), std::string::npos) << read;
    }
  }
  EXPECT_THROW((void)content_of(folder / "none.ply"), FileError);
  EXPECT_THROW((void)content_of(folder.path()), FileError);
}

TEST(Drafts, ReplaceTheFileOrAreRemoved) {
  const TemporaryFolder folder;
  const auto path = folder / "out.txt";
  std::ofstream(path) << "old";
  {
    const Draft draft(path);
    EXPECT_EQ(draft.path().extension(), ".txt");
    std::ofstream(draft.path()) << "new";
    EXPECT_EQ(file_content(path), "old");
  }
  EXPECT_EQ(folder.entries(), 1);
  Draft draft(path);
  std::ofstream(draft.path()) << "new";
  Draft moved(std::move(draft));
  moved.keep();
  EXPECT_EQ(file_content(path), "new");
  EXPECT_EQ(folder.entries(), 1);
  EXPECT_THROW(Draft(folder / "absent" / "a"), FileError);
}

TEST(Drafts, HaveTheExtensionOfTheLinkNotOfItsTarget) {
  const TemporaryFolder folder;
  std::ofstream(folder / "run.dat") << "old";
  std::filesystem::create_symlink("run.dat", folder / "latest.txt");
  Draft draft(folder / "latest.txt");
  EXPECT_EQ(draft.path().extension(), ".txt");
  std::ofstream(draft.path()) << "new";
  draft.keep();
  EXPECT_TRUE(std::filesystem::is_symlink(folder / "latest.txt"));
  EXPECT_EQ(file_content(folder / "run.dat"), "new");
}

}  // namespace
}  // namespace blum
