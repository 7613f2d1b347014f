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
#include "field/kernels/image_shape.hpp"

namespace blum::kernels {

/// Computes the mask of an image, 32 words per warp. Reads the image once; writes 1/8 byte per voxel.
template <class T, class Test>
struct SelectVoxels {
  static constexpr std::uint32_t threads = 256;
  static constexpr std::uint32_t blocks_per_processor = 8;
  static constexpr std::size_t words_per_block = threads;
  struct Shared {};

  const T* values;
  Test test;
  std::uint32_t size_x;
  std::uint32_t words_per_row;
  std::size_t words;
  std::uint32_t* mask;

  template <class Block>
  BLUM_HD void operator()(const Block& block, Shared&, std::size_t index) const {
    block.each_warp([&](const typename Block::Warp& warp) {
      const std::size_t first = index * words_per_block + std::size_t{warp.index()} * warp_size;
      typename Block::Warp::template Lanes<std::uint32_t> mine;
      for (std::uint32_t k = 0; k < warp_size && first + k < words; ++k) {
        const auto word = static_cast<std::uint32_t>(first + k);  // below 2^31
        const std::size_t row = word / words_per_row;
        const std::uint32_t x = word % words_per_row * warp_size;
        const std::uint32_t bits =
            warp.ballot([&](std::uint32_t lane) { return x + lane < size_x && test(values[row * size_x + x + lane]); });
        warp.each([&](std::uint32_t lane) {
          if (lane == k) mine[lane] = bits;
        });
      }
      warp.each([&](std::uint32_t lane) {
        if (first + lane < words) mask[first + lane] = mine[lane];
      });
    });
  }
};

struct SelectedOfWord {
  const std::uint32_t* mask;
  BLUM_HD std::uint64_t operator()(std::size_t word) const { return count_bits(mask[word]); }
};
struct AddCounts {
  BLUM_HD std::uint64_t operator()(std::uint64_t a, std::uint64_t b) const { return a + b; }
};

/// x pass: finds the closest target of each voxel in its row, and writes its linear index. If two targets are equally
/// close, the left one wins. Targets are voxels of the other kind; in an unsigned transform they are the selected
/// voxels. One warp processes a row. Reads 1/8 byte per voxel (1/4 in rows longer than 1024), writes 4.
struct TransformRows {
  static constexpr std::uint32_t threads = 256;
  static constexpr std::uint32_t blocks_per_processor = 6;
  static constexpr std::uint32_t warps = threads / warp_size;
  struct Shared {};

  ImageShape shape;
  std::uint32_t* site;

  template <class Block>
  BLUM_HD void operator()(const Block& block, Shared&, std::size_t index) const {
    block.each_warp([&](const typename Block::Warp& warp) {
      const std::size_t row = index * warps + warp.index();
      if (row >= shape.rows()) return;
      transform(warp, shape.mask + row * shape.words_per_row, static_cast<std::uint32_t>(row) * shape.size[0]);
    });
  }

 private:
  // Positions of missing targets. In unsigned arithmetic they are further away than any voxel, because rows are shorter
  // than 2^31.
  static constexpr std::uint32_t no_left = 0x80000000U;
  static constexpr std::uint32_t no_right = 0xffffffffU;

  /// Returns one word of a row's mask, with bits set for the voxels of one kind.
  [[nodiscard]] BLUM_HD std::uint32_t bits(const std::uint32_t* words, std::uint32_t word, bool selected) const {
    if (word >= shape.words_per_row) return 0;
    if (selected) return words[word];
    const std::uint32_t rest = shape.size[0] - word * warp_size;
    return ~words[word] & (rest >= warp_size ? ~0U : (1U << rest) - 1);
  }

  /// Returns the x of the first voxel of a kind in the given word or after it.
  template <class Warp>
  [[nodiscard]] BLUM_HD std::uint32_t find(const Warp& warp, const std::uint32_t* words, std::uint32_t word,
                                           bool selected) const {
    for (; word < shape.words_per_row; word += warp_size) {
      const std::uint32_t found =
          warp.ballot([&](std::uint32_t lane) { return bits(words, word + lane, selected) != 0; });
      if (found == 0) continue;
      const std::uint32_t at = word + lowest_bit(found);
      return at * warp_size + lowest_bit(bits(words, at, selected));
    }
    return no_right;
  }

  /// Voxels of one kind near the word that a warp processes.
  template <class Warp>
  struct Kind {
    typename Warp::template Lanes<std::uint32_t> word;  ///< 32 words, one per lane.
    std::uint32_t present = 0;                          ///< Bit k is set if word k contains a voxel of the kind.
    std::uint32_t bits = 0;                             ///< The word that the warp processes.
    std::uint32_t left = no_left;                       ///< Last voxel of the kind before that word.
    std::uint32_t right = no_right;                     ///< First voxel of the kind after that word.
    std::uint32_t beyond = 0;                           ///< First voxel of the kind after all 32 words.

    BLUM_HD void go_to(const Warp& warp, std::uint32_t first, std::uint32_t k) {
      bits = warp.broadcast(word, k);
      const std::uint32_t later = present & ~((2U << k) - 1);
      right = beyond;
      if (later == 0) return;
      const std::uint32_t at = lowest_bit(later);
      right = (first + at) * warp_size + lowest_bit(warp.broadcast(word, at));
    }
    BLUM_HD void leave(std::uint32_t x) {
      if (bits != 0) left = x + highest_bit(bits);
    }
  };

  template <class Warp>
  BLUM_HD void load(const Warp& warp, const std::uint32_t* words, std::uint32_t first, bool selected,
                    Kind<Warp>& kind) const {
    kind.present = warp.ballot([&](std::uint32_t lane) {
      kind.word[lane] = bits(words, first + lane, selected);
      return kind.word[lane] != 0;
    });
    const std::uint32_t after = first + warp_size;
    if (kind.beyond < after * warp_size) kind.beyond = find(warp, words, after, selected);
  }

  template <class Warp>
  BLUM_HD void transform(const Warp& warp, const std::uint32_t* words, std::uint32_t base) const {
    Kind<Warp> selected;
    Kind<Warp> other;
    for (std::uint32_t first = 0; first < shape.words_per_row; first += warp_size) {
      load(warp, words, first, true, selected);
      if (shape.is_signed) load(warp, words, first, false, other);
      const std::uint32_t count = smaller(warp_size, shape.words_per_row - first);
      for (std::uint32_t k = 0; k < count; ++k) {
        const std::uint32_t x0 = (first + k) * warp_size;
        selected.go_to(warp, first, k);
        if (shape.is_signed) other.go_to(warp, first, k);
        warp.each([&](std::uint32_t lane) {
          if (x0 + lane >= shape.size[0]) return;
          const bool is_inside = shape.is_signed && ((selected.bits >> lane) & 1U) != 0;
          const std::uint32_t x = is_inside ? nearest(other, x0, lane) : nearest(selected, x0, lane);
          site[std::size_t{base} + x0 + lane] = x == no_voxel ? no_voxel : base + x;
        });
        selected.leave(x0);
        if (shape.is_signed) other.leave(x0);
      }
    }
  }

  template <class Warp>
  [[nodiscard]] BLUM_HD static std::uint32_t nearest(const Kind<Warp>& kind, std::uint32_t x0, std::uint32_t lane) {
    const std::uint32_t up_to = kind.bits & (~0U >> (31 - lane));
    const std::uint32_t from = kind.bits & (~0U << lane);
    const std::uint32_t left = up_to != 0 ? x0 + highest_bit(up_to) : kind.left;
    const std::uint32_t right = from != 0 ? x0 + lowest_bit(from) : kind.right;
    const std::uint32_t to_left = x0 + lane - left;
    const std::uint32_t to_right = right - (x0 + lane);
    if (smaller(to_left, to_right) >= no_left) return no_voxel;
    return to_right < to_left ? right : left;
  }
};

/// Computes the distances from the sites that the passes found, and applies the band. Reads 4 bytes per voxel, writes 4
/// (8 beyond the band). Computing distances at the end moves less memory than storing distances in each pass would. The
/// passes can therefore use the memory of the distances as working memory.
template <class Costs>
struct WriteDistances {
  ImageShape shape;
  Costs costs;
  float band;  ///< infinite if the request has no band
  std::uint32_t* site;
  float* distance;

  BLUM_HD void operator()(std::size_t index) const {
    const std::uint32_t from = site[index];
    const Voxel at = shape.voxel(static_cast<std::uint32_t>(index));
    float result = std::numeric_limits<float>::infinity();
    if (from != no_voxel) {
      const Voxel to = shape.voxel(from);
      const auto in_plane = Costs::sum(costs.square(0, offset(at.x, to.x)), costs.square(1, offset(at.y, to.y)));
      result = costs.distance(Costs::sum(in_plane, costs.square(2, offset(at.z, to.z))));
    }
    if (result > band) {
      result = band;
      site[index] = no_voxel;
    }
    distance[index] = shape.is_signed && shape.is_selected(at) ? -result : result;
  }
};

/// Rules that decide into how many bands columns are divided.
struct BandTuning {
  std::size_t threads = std::size_t{1} << 17U;  ///< number of threads that keeps the device busy
  std::uint32_t fewest_rows = 32;               ///< smallest number of rows of a band
};

/// Exact distance transforms of an image in a device's memory; distance_transform() describes the result. Device is
/// CudaDevice, or EmulatedDevice in the tests. Only selected_count() waits for the device.
///
/// Memory read and written, at most, in bytes per voxel: 4 (rows) + 16 (columns along y) + 16 (along z) + 8
/// (distances). Each access to the mask adds 1/8. The image is read once. The passes use the memory of the distances as
/// working memory.
///
/// The result is byte for byte that of the CPU, because neither the CPU nor the device fuses multiplications with
/// additions.
template <class Device>
class ImageTransform {
 public:
  explicit ImageTransform(Device& device, const BandTuning& tuning = {}) : device_(device), tuning_(tuning) {}

  /// Returns the bytes of device memory that a transform needs in addition to the image and its result (8 bytes per
  /// voxel).
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

  /// Sets the request and allocates the mask.
  /// @throws OutOfMemory.
  void set_request(const detail::ImageRequest& request) {
    request_ = request;
    shape_ = ImageShape(request);
    mask_.resize(shape_.mask_words());
    shape_.mask = mask_.data();
  }

  /// Computes the mask of selected voxels.
  /// @param values  one per voxel, in the device's memory.
  /// @throws InvalidOption if the threshold is NaN.
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
  /// Returns the mask, for callers that fill it themselves. The mask consists of rows of 32-bit words; bits beyond a
  /// row's end must be 0.
  [[nodiscard]] std::uint32_t* mask() { return mask_.data(); }
  [[nodiscard]] std::size_t mask_words() const { return shape_.mask_words(); }

  [[nodiscard]] std::uint64_t selected_count() {
    count_.resize(1);
    device_.reduce(shape_.mask_words(), SelectedOfWord{mask_.data()}, std::uint64_t{0}, AddCounts{}, count_.data());
    std::uint64_t count = 0;
    device_.download(count_.data(), 1, &count);
    return count;
  }

  /// Writes one distance and one site per voxel. At least one voxel must be selected. In a signed transform, at least
  /// one voxel must be unselected, too. Otherwise, the distances are infinite, or equal to the band.
  void run(float* distance, std::uint32_t* site) {
    request_.integer ? run_with(IntegerCosts(request_), distance, site) : run_with(RealCosts(request_), distance, site);
  }

 private:
  struct Bands {
    std::size_t columns = 0;
    std::uint32_t rows = 0;  ///< rows per band
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
