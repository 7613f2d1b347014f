// Blum: distance transforms of images on a device. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <type_traits>
#include <variant>

#include "blum/field/distance_transform.hpp"
#include "blum/grid/voxel_test.hpp"
#include "field/image_request.hpp"
#include "field/kernels/image_columns.hpp"
#include "field/kernels/image_rows.hpp"
#include "field/kernels/image_shape.hpp"

namespace blum::kernels {

/// How columns are cut into bands.
struct BandTuning {
  std::size_t threads = std::size_t{1} << 17U;  ///< that keep the device busy
  std::uint32_t fewest_rows = 32;               ///< of a band
};

/// Exact distance transforms of an image in a device's memory; see distance_transform for what they promise. Device is
/// CudaDevice, or EmulatedDevice in the tests. Nothing but selected_count() waits for the device.
///
/// Memory moved, in bytes per voxel: 4 (rows) + 16 (columns along y) + 16 (along z) + 8 (distances), at most, and 1/8
/// each for the mask; and one reading of the image. The memory of the distances is the passes' working memory.
///
/// The result is the CPU's, byte for byte: neither fuses products with sums.
template <class Device>
class ImageTransform {
 public:
  explicit ImageTransform(Device& device, const BandTuning& tuning = {}) : device_(device), tuning_(tuning) {}

  /// Device memory that a transform takes, beside 8 bytes per voxel for its result and the image itself.
  [[nodiscard]] static std::size_t scratch_bytes(const detail::ImageRequest& request, const BandTuning& tuning = {}) {
    const ImageShape shape(request);
    std::size_t words = shape.mask_words();
    std::size_t band_words = 0;
    for (const bool along_z : {false, true}) {
      const Bands bands = bands_of(shape, along_z, tuning);
      if (bands.count > 1) band_words = std::max(band_words, 2 * bands.count * bands.columns);
    }
    words += band_words;
    return words * sizeof(std::uint32_t) + sizeof(std::uint64_t);
  }

  /// @throws OutOfMemory.
  void set_request(const detail::ImageRequest& request) {
    request_ = request;
    shape_ = ImageShape(request);
    mask_.resize(shape_.mask_words());
    shape_.mask = mask_.data();
  }

  /// Makes the mask. @param values  one per voxel, in the device's memory. @throws InvalidOption (NaN threshold).
  template <class T>
  void select(const T* values, const LabelSelection& selection) {
    std::visit(
        [&](const auto& test) {
          using Body = SelectVoxels<T, std::decay_t<decltype(test)>>;
          const std::size_t words = shape_.mask_words();
          device_.run_blocks((words + Body::words_per_block - 1) / Body::words_per_block,
                             Body{values, test, shape_.size[0], shape_.words_per_row, words, mask_.data()});
        },
        detail::make_voxel_test<T>(selection));
  }
  /// For masks that come from elsewhere: rows of 32-bit words, the bits beyond a row clear.
  [[nodiscard]] std::uint32_t* mask() { return mask_.data(); }
  [[nodiscard]] std::size_t mask_words() const { return shape_.mask_words(); }

  [[nodiscard]] std::uint64_t selected_count() {
    count_.resize(1);
    device_.reduce(shape_.mask_words(), SelectedOfWord{mask_.data()}, std::uint64_t{0}, AddCounts{}, count_.data());
    std::uint64_t count = 0;
    device_.download(count_.data(), 1, &count);
    return count;
  }

  /// Writes one distance and one site per voxel. Some voxel must be selected, and in a signed transform not all: else
  /// distances are infinite, or the band's.
  void run(float* distance, std::uint32_t* site) {
    request_.integer ? run_with(IntegerCosts(request_), distance, site) : run_with(RealCosts(request_), distance, site);
  }

 private:
  struct Bands {
    std::size_t columns = 0;
    std::uint32_t rows = 0;  ///< of a band
    std::size_t count = 0;
  };

  [[nodiscard]] static Bands bands_of(const ImageShape& shape, bool along_z, const BandTuning& tuning) {
    const std::uint32_t length = shape.size[along_z ? 2 : 1];
    Bands bands;
    bands.columns = std::size_t{shape.size[0]} * shape.size[along_z ? 1 : 2];
    const std::size_t most = (length + tuning.fewest_rows - 1) / tuning.fewest_rows;
    const std::size_t wanted = std::clamp<std::size_t>(tuning.threads / bands.columns, 1, most);
    bands.rows = static_cast<std::uint32_t>((length + wanted - 1) / wanted);
    bands.count = (length + bands.rows - 1) / bands.rows;
    return bands;
  }

  template <class Costs>
  void run_with(const Costs& costs, float* distance, std::uint32_t* site) {
    device_.run_blocks((shape_.rows() + TransformRows::warps - 1) / TransformRows::warps, TransformRows{shape_, site});
    if (shape_.size[1] > 1) transform_columns<Costs, false>(costs, distance, site);
    if (shape_.size[2] > 1) transform_columns<Costs, true>(costs, distance, site);
    const float band = request_.has_band ? request_.band : std::numeric_limits<float>::infinity();
    device_.for_each(request_.voxel_count(), WriteDistances<Costs>{shape_, costs, band, site, distance});
  }

  template <class Costs, bool along_z>
  void transform_columns(const Costs& costs, float* distance, std::uint32_t* site) {
    const Bands bands = bands_of(shape_, along_z, tuning_);
    const bool is_banded = bands.count > 1;
    if (is_banded) {
      bottom_.resize(bands.count * bands.columns);
      change_.resize(bands.count * bands.columns);
    }
    const ColumnPass<Costs> pass{shape_,
                                 costs,
                                 shape_.size[along_z ? 2 : 1],
                                 along_z ? shape_.plane : shape_.size[0],
                                 along_z ? shape_.size[1] * shape_.words_per_row : shape_.words_per_row,
                                 static_cast<std::uint32_t>(bands.columns),
                                 bands.rows,
                                 static_cast<std::uint32_t>(bands.count),
                                 site,
                                 distance,
                                 bottom_.data(),
                                 change_.data()};
    const std::size_t threads = bands.count * bands.columns;
    device_.for_each(threads, BuildEnvelopes<Costs, along_z>{pass});
    if (!is_banded) {
      device_.for_each(threads, AssignSites<Costs, along_z, false>{pass});
      return;
    }
    device_.for_each(bands.columns, MergeBands<Costs, along_z>{pass});
    device_.for_each(threads, AssignSites<Costs, along_z, true>{pass});
  }

  template <class T>
  using Array = typename Device::template Array<T>;

  Device& device_;
  BandTuning tuning_;
  detail::ImageRequest request_;
  ImageShape shape_;
  Array<std::uint32_t> mask_;
  Array<std::uint32_t> bottom_, change_;  ///< see ColumnPass
  Array<std::uint64_t> count_;
};

}  // namespace blum::kernels
