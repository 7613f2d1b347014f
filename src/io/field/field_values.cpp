#include "blum/core/error.hpp"
#include "io/field/field_files.hpp"

namespace blum::volume_io {
namespace {

[[noreturn]] void fail_site(const std::string& name, std::size_t index) {
  throw FormatError(name + ": the site id of node " + std::to_string(index) + " is neither an index nor -1");
}

}  // namespace

Buffer<float> read_distances(ScalarType type, std::uint64_t count, const ReadValues& read) {
  if (type == ScalarType::f32) {
    Buffer<float> out(count);
    read(std::as_writable_bytes(out.span()));
    return out;
  }
  VoxelImage::Values values = make_values(type, count);
  read(as_bytes(values));
  return to_float(values);
}

Buffer<SiteId> read_sites(ScalarType type, std::uint64_t count, const ReadValues& read, const std::string& name) {
  if (type != ScalarType::i32) {
    VoxelImage::Values values = make_values(type, count);
    read(as_bytes(values));
    return to_sites(values, name);
  }
  Buffer<SiteId> out(count);
  read(std::as_writable_bytes(out.span()));
  for (std::size_t i = 0; i < out.size(); ++i) {
    if (out[i].has_value() && out[i].value > max_id_count) fail_site(name, i);
  }
  return out;
}

Buffer<SiteId> to_sites(const VoxelImage::Values& values, const std::string& name) {
  Buffer<SiteId> out(std::visit([](const auto& v) { return v.size(); }, values));
  std::visit(
      [&]<class T>(const std::vector<T>& v) {
        if constexpr (std::is_floating_point_v<T>) {
          throw FormatError(name + ": site ids must be whole numbers, but these are floating-point");
        } else {
          for (std::size_t i = 0; i < v.size(); ++i) {
            if (!std::in_range<std::int32_t>(v[i]) || std::cmp_less(v[i], -1)) fail_site(name, i);
            out[i] = SiteId(static_cast<std::uint32_t>(v[i]));
          }
        }
      },
      values);
  return out;
}

}  // namespace blum::volume_io
