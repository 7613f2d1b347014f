#include "blum/io/formats.hpp"

#include <algorithm>
#include <array>

#include "io/text_scan.hpp"

namespace blum {
namespace {

using Words = std::span<const std::string_view>;

// Whether a file begins as one of a format.

bool begins_as_ply(std::string_view head) {
  return head.starts_with("ply\n") || head.starts_with("ply\r");
}
bool begins_as_off(std::string_view head) {
  return head.starts_with("OFF") || head.starts_with("COFF") || head.starts_with("NOFF");
}
bool begins_as_stl(std::string_view head) {
  return head.starts_with("solid ") && head.find("facet") != std::string_view::npos;
}
bool begins_as_obj(std::string_view head) {
  return head.starts_with("v ") || head.find("\nv ") != std::string_view::npos;
}
bool begins_as_nrrd(std::string_view head) {
  return head.starts_with("NRRD000");
}
bool begins_as_npy(std::string_view head) {
  return head.starts_with("\x93NUMPY");
}
bool begins_as_nifti(std::string_view head) {
  return head.size() >= 348 && (head.substr(344, 3) == "n+1" || head.substr(4, 3) == "n+2");
}
bool begins_as_vol(std::string_view head) {
  return head.starts_with("X: ") || head.starts_with("Center-X:");
}

constexpr std::array<std::string_view, 1> obj{".obj"}, off{".off"}, stl{".stl"}, ply{".ply"}, nrrd{".nrrd"},
    npy{".npy"}, vol{".vol"}, npz{".npz"}, vti{".vti"}, vtp{".vtp"}, ma{".ma"};
constexpr std::array<std::string_view, 2> nrrds{".nrrd", ".nhdr"};
constexpr std::array<std::string_view, 6> nifti{".nii", ".nii.gz", ".hdr", ".hdr.gz", ".img", ".img.gz"};

constexpr FileContent mesh = FileContent::mesh, image = FileContent::image, field = FileContent::field,
                      complex = FileContent::complex;

const std::array formats{
    FileFormat{mesh, "OBJ", obj, obj, "triangles, polygons, segments, points; double precision", "Blender, MeshLab",
               begins_as_obj},
    FileFormat{mesh, "OFF", off, off, "triangles, polygons; double precision", "MeshLab, CGAL", begins_as_off},
    FileFormat{mesh, "STL", stl, stl, "triangles without shared vertices; single precision", "CAD, slicers",
               begins_as_stl},
    FileFormat{mesh, "PLY", ply, ply, "triangles, polygons, segments; double precision", "MeshLab, Blender, ParaView",
               begins_as_ply},
    FileFormat{image, "NRRD", nrrds, nrrd, "scalars of any type, spacing, axes, space", "3D Slicer, ITK",
               begins_as_nrrd},
    FileFormat{image, "NIfTI", nifti, {}, "scalars of any type, spacing, axes", "3D Slicer, ITK, FSL", begins_as_nifti},
    FileFormat{image, "NPY", npy, npy, "scalars of any type, [z, y, x]; no spacing", "NumPy", begins_as_npy},
    FileFormat{image, "Vol", vol, {}, "bytes; no spacing", "DGtal", begins_as_vol},
    FileFormat{field, "NRRD", nrrd, nrrd, "distances; sites in a second file, NAME.site.nrrd", "3D Slicer, ITK"},
    FileFormat{field, "NPZ", npz, npz, "distances, sites, vertices of sites", "NumPy"},
    FileFormat{field, "VTI", vti, vti, "distances, sites", "ParaView, VTK"},
    FileFormat{complex, "VTP", vtp, vtp, "all columns, metadata", "ParaView, VTK, 3D Slicer"},
    FileFormat{complex, "PLY", ply, ply, "all columns, metadata", "MeshLab, trimesh"},
    FileFormat{complex, "OBJ", obj, obj, "positions, edges, triangles; no columns", "Blender, MeshLab"},
    FileFormat{complex, "MA", ma, ma, "positions, radii, edges, triangles of medial axes", "Q-MAT"},
    FileFormat{complex, "NPZ", npz, npz, "all columns, metadata, further complexes", "NumPy"},
};

/// The place among those of one content of the first format that fits.
template <class Fits>
std::optional<std::size_t> find(FileContent content, Fits fits) {
  std::size_t place = 0;
  for (const FileFormat& format : formats) {
    if (format.content != content) continue;
    if (fits(format)) return place;
    ++place;
  }
  return std::nullopt;
}

}  // namespace

std::string_view to_string(FileContent content) {
  constexpr std::array<std::string_view, 4> names{"mesh", "image", "field", "complex"};
  return names[static_cast<std::size_t>(content)];
}

std::span<const FileFormat> file_formats() {
  return formats;
}

std::string file_extension(const std::filesystem::path& path) {
  std::string last = volume_io::lower_case(path.extension().string());
  if (last != ".gz") return last;
  const std::string inner = volume_io::lower_case(path.stem().extension().string());
  return inner == ".nii" || inner == ".hdr" || inner == ".img" ? inner + last : last;
}

std::optional<std::size_t> format_by_name(FileContent content, const std::filesystem::path& path) {
  const std::string extension = file_extension(path);
  return find(content, [&](const FileFormat& format) {
    return std::find(format.extensions.begin(), format.extensions.end(), extension) != format.extensions.end();
  });
}

std::optional<std::size_t> format_by_head(FileContent content, std::string_view head) {
  // PLY and OFF files may have lines that look like those of OBJ.
  const auto found =
      find(content, [&](const FileFormat& f) { return f.begins != nullptr && f.name != "OBJ" && f.begins(head); });
  if (found) return found;
  return find(content, [&](const FileFormat& format) { return format.begins != nullptr && format.begins(head); });
}

std::string_view format_name(FileContent content, std::size_t place) {
  for (const FileFormat& format : formats) {
    if (format.content == content && place-- == 0) return format.name;
  }
  return "unknown";
}

std::vector<std::string> file_extensions(FileContent content, FileAccess access) {
  std::vector<std::string> out;
  for (const FileFormat& format : formats) {
    if (format.content != content) continue;
    const Words words = access == FileAccess::read ? format.extensions : format.written;
    out.insert(out.end(), words.begin(), words.end());
  }
  return out;
}

std::string extension_list(FileContent content, FileAccess access, std::string_view between) {
  std::string out;
  for (const std::string& extension : file_extensions(content, access)) {
    if (!out.empty()) out += between;
    out += extension;
  }
  return out;
}

}  // namespace blum
