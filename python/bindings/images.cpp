#include "images.hpp"

#include <nanobind/stl/array.h>
#include <nanobind/stl/optional.h>
#include <nanobind/stl/pair.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>

#include <optional>
#include <span>
#include <type_traits>
#include <utility>

#include "arrays.hpp"
#include "bindings.hpp"
#include "blum/core/parallel.hpp"
#include "blum/field/distance_transform.hpp"
#include "blum/field/image_reference.hpp"
#include "blum/field/smooth_surface.hpp"
#include "blum/grid/image_values.hpp"
#include "blum/grid/selected_voxels.hpp"
#include "blum/grid/voxel_topology.hpp"
#include "call.hpp"
#include "structs.hpp"

namespace blum::python {
namespace {

template <std::size_t index = 0>
VoxelImageView::Values values_of(const ValuesIn& array) {
  if constexpr (index == std::variant_size_v<VoxelImageView::Values>) {
    throw nb::type_error("values of this type cannot be used as an image");
  } else {
    using Span = std::variant_alternative_t<index, VoxelImageView::Values>;
    using Value = std::remove_const_t<typename Span::element_type>;
    if (array.dtype() == nb::dtype<Value>()) {
      return Span(static_cast<const Value*>(array.data()), array.size());
    }
    return values_of<index + 1>(array);
  }
}

void bind_transforms(nb::module_& m) {
  bind_options<DistanceTransformOptions>(m);
  bind_options<SmoothSurfaceOptions>(m);
  bind_struct<ImageValues>(m);
  bind_struct<VoxelTopology>(m);
  m.def(
      "distance_transforms",
      [](const ImageArrays& image, const std::vector<std::int64_t>& labels, const nb::dict& given, int threads,
         const std::string& device, nb::object progress) {
        const auto options = options_from<DistanceTransformOptions>(given);
        std::vector<LabelSelection> selections;
        for (const std::int64_t label : labels) selections.push_back(LabelSelection::of_label(label));
        if (labels.empty()) selections.push_back(options.selection);
        std::vector<Field> fields =
            run({threads, std::move(progress), parse_device(device)},
                [&](const Context& context) { return distance_transforms(image.view, selections, options, context); });
        nb::list out;
        for (Field& field : fields) out.append(nb::cast(std::move(field)));
        return out;
      },
      nb::arg("image"), nb::arg("labels"), nb::arg("options"), nb::arg("threads"), nb::arg("device"),
      nb::arg("progress").none());
  m.def(
      "image_values",
      [](const ImageArrays& image, std::size_t most_labels, int threads, nb::object progress) {
        return result_of(run({threads, std::move(progress)},
                             [&](const Context& context) { return image_values(image.view, most_labels, context); }));
      },
      nb::arg("image"), nb::arg("most_labels"), nb::arg("threads"), nb::arg("progress").none());
  m.def(
      "rounded_labels",
      [](const ImageArrays& image, const std::vector<std::int64_t>& labels) -> nb::object {
        auto rounded =
            run({0, nb::none()}, [&](const Context& context) { return rounded_labels(image.view, labels, context); });
        if (!rounded) return nb::none();
        VoxelImage made{image.view.grid, std::move(rounded->values), image.view.space};
        return nb::make_tuple(image_of(std::move(made)), to_python(std::vector{std::move(rounded->warning)}));
      },
      nb::arg("image"), nb::arg("labels"));
  m.def(
      "selected_voxels",
      [](const ImageArrays& image, std::optional<std::int64_t> label, std::optional<double> threshold, int threads,
         nb::object progress) {
        const LabelSelection selection = LabelSelection::of(label, threshold);
        return mask_of(run({threads, std::move(progress)},
                           [&](const Context& context) { return selected_voxels(image.view, selection, context); }));
      },
      nb::arg("image"), nb::arg("label").none(), nb::arg("threshold").none(), nb::arg("threads"),
      nb::arg("progress").none());
  m.def(
      "smooth_surface",
      [](const ImageArrays& image, std::optional<std::int64_t> label, std::optional<double> threshold,
         const nb::dict& options, int threads, nb::object progress) {
        const LabelSelection selection = LabelSelection::of(label, threshold);
        const auto chosen = options_from<SmoothSurfaceOptions>(options);
        SmoothSurface out = run({threads, std::move(progress)}, [&](const Context& context) {
          return smooth_surface(image.view, selection, chosen, context);
        });
        return nb::make_tuple(arrays_of(std::move(out.mesh)), out.largest_move);
      },
      nb::arg("image"), nb::arg("label").none(), nb::arg("threshold").none(), nb::arg("options"), nb::arg("threads"),
      nb::arg("progress").none());
  m.def(
      "voxel_topology",
      [](const MaskIn& mask, int threads, nb::object progress) {
        return result_of(run({threads, std::move(progress)},
                             [&](const Context& context) { return voxel_topology(voxel_set(mask), context); }));
      },
      nb::arg("mask").noconvert(), nb::arg("threads"), nb::arg("progress").none());
  m.def(
      "reference_nearest_voxel",
      [](const MaskIn& targets, const GridSpec& grid, const IndicesIn& voxels, int threads, nb::object progress) {
        const std::vector<std::uint8_t> wanted(targets.data(), targets.data() + targets.size());
        const auto asked = rows<std::uint32_t>(voxels);
        std::vector<double> squared(asked.size());
        std::vector<std::int32_t> sites(asked.size());
        run_call({threads, std::move(progress)}, [&](const Context& context) {
          parallel_for(context, asked.size(), 1, "brute force", [&](const WorkRange& range) {
            for (std::size_t v = range.begin; v < range.end; ++v) {
              const reference::NearestVoxel nearest = reference::nearest_voxel(grid, wanted, asked[v]);
              squared[v] = nearest.squared;
              sites[v] = nearest.site.to_file();
            }
          });
        });
        return nb::make_tuple(handed_over<double>(std::move(squared)), handed_over<std::int32_t>(std::move(sites)));
      },
      nb::arg("targets").noconvert(), nb::arg("grid"), nb::arg("voxels").noconvert(), nb::arg("threads"),
      nb::arg("progress").none());
}

}  // namespace

ImageArrays image_arrays(ValuesIn values, const GridSpec& grid, std::string space) {
  VoxelImageView view{grid, values_of(values), std::move(space)};
  validate(view);
  return {std::move(values), std::move(view)};
}

nb::tuple image_of(VoxelImage image) {
  nb::object values = std::visit(
      [&]<class T>(std::vector<T>& entries) { return nb::cast(grid_handed_over(std::move(entries), image.grid.size)); },
      image.values);
  return nb::make_tuple(std::move(values), image.grid, image.space);
}

VoxelSet voxel_set(const MaskIn& mask) {
  VoxelSet out({static_cast<std::int64_t>(mask.shape(2)), static_cast<std::int64_t>(mask.shape(1)),
                static_cast<std::int64_t>(mask.shape(0))});
  const std::uint8_t* at = mask.data();
  for (std::int64_t k = 0; k < out.size()[2]; ++k) {
    for (std::int64_t j = 0; j < out.size()[1]; ++j) {
      for (std::int64_t i = 0; i < out.size()[0]; ++i, ++at) {
        if (*at != 0) out.insert(i, j, k);
      }
    }
  }
  return out;
}

Out<std::uint8_t> mask_of(const VoxelSet& voxels) {
  const auto& size = voxels.size();
  std::vector<std::uint8_t> mask(static_cast<std::size_t>(size[0] * size[1] * size[2]));
  std::uint8_t* at = mask.data();
  for (std::int64_t k = 0; k < size[2]; ++k) {
    for (std::int64_t j = 0; j < size[1]; ++j) {
      const std::span<const std::uint64_t> row = voxels.row(j, k);
      const auto length = static_cast<std::size_t>(size[0]);
      for (std::size_t i = 0; i < length; ++i, ++at) *at = static_cast<std::uint8_t>(row[i / 64] >> (i % 64) & 1U);
    }
  }
  return grid_handed_over(std::move(mask), size);
}

void bind_images(nb::module_& m) {
  nb::class_<ImageArrays>(m, "ImageArrays")
      .def(
          "__init__",
          [](ImageArrays* self, ValuesIn values, const GridSpec& grid, std::string space) {
            new (self) ImageArrays(image_arrays(std::move(values), grid, std::move(space)));
          },
          nb::arg("values").noconvert(), nb::arg("grid"), nb::arg("space"));
  bind_transforms(m);
}

}  // namespace blum::python
