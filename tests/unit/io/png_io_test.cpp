// Proves that PNG files hold the given pixels, in memory and on disk, and that invalid pictures are refused.
#include "blum/io/png_io.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numeric>
#include <string>

#include "blum/io/color_bar.hpp"
#include "blum/io/color_scale.hpp"
#include "unit/io/png_bytes.hpp"
#include "unit/io/temporary_folder.hpp"

namespace blum {
namespace {

using test::read_png;
using test::TemporaryFolder;

std::vector<std::uint8_t> counted(std::size_t count) {
  std::vector<std::uint8_t> bytes(count);
  std::iota(bytes.begin(), bytes.end(), std::uint8_t{0});
  return bytes;
}

TEST(PngIo, HoldsPixelsWithAndWithoutOpacity) {
  for (const PngChannels channels : {PngChannels::rgb, PngChannels::rgba}) {
    const auto count = static_cast<std::size_t>(channels);
    const std::vector<std::uint8_t> bytes = counted(5 * 3 * count);
    const test::ReadPng png = read_png(encode_png({bytes, 5, 3, channels}));
    ASSERT_EQ(png.width, 5U);
    ASSERT_EQ(png.height, 3U);
    EXPECT_EQ(png.has_alpha, channels == PngChannels::rgba);
    for (std::size_t i = 0; i < 15; ++i) {
      const std::array<int, 4> pixel = png.at(i % 5, i / 5);
      for (std::size_t c = 0; c < count; ++c) EXPECT_EQ(pixel[c], bytes[i * count + c]) << i;
      EXPECT_TRUE(count == 4 || pixel[3] == 255);
    }
  }
}

TEST(PngIo, FilesAreTheBytesOfMemory) {
  const TemporaryFolder folder;
  Picture picture(4, 2, {0.5F, 2.0F, -1.0F});
  picture.at(3, 1) = {1, 0, 0};
  write_png(folder / "a.png", picture);
  const std::vector<std::byte> bytes = encode_png(picture);
  EXPECT_EQ(test::file_content(folder / "a.png"),
            std::string(reinterpret_cast<const char*>(bytes.data()), bytes.size()));
  const test::ReadPng png = read_png(bytes);
  EXPECT_EQ(png.at(0, 0), (std::array{128, 255, 0, 255}));  // values beyond 0 to 1 are clamped
  EXPECT_EQ(png.at(3, 1), (std::array{255, 0, 0, 255}));
  EXPECT_THROW(write_png(folder / "absent" / "a.png", picture), FileError);
  EXPECT_EQ(folder.entries(), 1);
}

TEST(PngIo, RefusesInvalidPictures) {
  const std::vector<std::uint8_t> bytes = counted(12);
  EXPECT_NO_THROW((void)encode_png({bytes, 2, 2, PngChannels::rgb}));
  EXPECT_THROW((void)encode_png({bytes, 2, 2, PngChannels::rgba}), InvalidOption);
  EXPECT_THROW((void)encode_png({bytes, 4, 2, PngChannels::rgb}), InvalidOption);
  EXPECT_THROW((void)encode_png({{}, 0, 2, PngChannels::rgb}), InvalidOption);
  EXPECT_THROW((void)encode_png({bytes, 1000001, 1, PngChannels::rgb}), InvalidOption);
}

double lightness(const Color& color) {
  return 0.2126 * color.r + 0.7152 * color.g + 0.0722 * color.b;
}

TEST(ColorScale, RunsFromLightToDark) {
  const ColorScale scale = ColorScale::sequential(2, 6);
  EXPECT_EQ(scale.place(2), 0);
  EXPECT_EQ(scale.place(3), 0.25);
  EXPECT_EQ(scale.place(9), 1);
  EXPECT_EQ(scale.place(-9), 0);
  double before = 2;
  for (double value = 2; value <= 6; value += 0.5) {
    EXPECT_LT(lightness(scale.color(value)), before);
    before = lightness(scale.color(value));
  }
  for (const double value : {HUGE_VAL, -HUGE_VAL, std::nan("")}) {
    EXPECT_EQ(byte_of(scale.color(value).r), byte_of(nothing_color.r));
  }
  EXPECT_EQ(ColorScale::sequential(3, 3).place(3), 0);  // a range of one value
}

TEST(ColorScale, ChangesColoursContinuously) {
  constexpr int steps = 2000;
  // The sides of the diverging scale begin with two light colours, so that zero stays visible.
  for (const double side : {1.0, -1.0}) {
    for (Color (*const color_of)(double) : {sequential_color, diverging_color}) {
      Color last = color_of(side / steps);
      for (int i = 2; i <= steps; ++i) {
        const Color next = color_of(side * i / steps);
        const float jump = std::max({std::abs(next.r - last.r), std::abs(next.g - last.g), std::abs(next.b - last.b)});
        ASSERT_LT(jump, 0.02F) << i;  // five levels of 255
        last = next;
      }
    }
  }
}

TEST(ColorScale, DivergesAtZero) {
  const ColorScale scale = ColorScale::diverging(-1, 2);
  EXPECT_EQ(scale.place(0), 0);
  EXPECT_EQ(scale.place(1), 0.5);
  EXPECT_EQ(scale.place(-1), -1);
  EXPECT_GT(scale.color(2).b, scale.color(2).r);    // blue outside
  EXPECT_GT(scale.color(-1).r, scale.color(-1).b);  // orange inside
  // A side is stretched by a factor of at most four.
  EXPECT_EQ(ColorScale::diverging(-0.01, 2).place(-0.25), -0.5);
}

TEST(ColorBar, HasTheColoursOfItsValuesAndRoomForItsNumbers) {
  const ColorScale scale = ColorScale::sequential(0, 10);
  const ColorBar bar{0, 10, round_step(10, 16), "mm", [&](double value, double) { return scale.color(value); }};
  const int width = width_of(bar, 100);
  Picture picture(width + 10, 140, paper_color);
  draw(picture, bar, 5, 0, 100);
  const auto is = [&](int x, int y, const Color& color) {
    const Color there = picture.at(x, y);
    return byte_of(there.r) == byte_of(color.r) && byte_of(there.g) == byte_of(color.g);
  };
  for (const int y : {0, 40, 99}) EXPECT_TRUE(is(15, 24 + y, scale.color(10 - (y + 0.5) / 10))) << y;
  int ink = 0;  // of numbers, right of the bar
  for (int y = 0; y < 140; ++y) {
    for (int x = 36; x < width + 10; ++x) {
      if (picture.at(x, y).r >= 0.5F) continue;
      ++ink;
      EXPECT_LE(x, 5 + width);
    }
  }
  EXPECT_GT(ink, 100);
  EXPECT_EQ(round_step(10, 5), 2);
  EXPECT_EQ(round_step(0.04, 4), 0.01);
}

}  // namespace
}  // namespace blum
