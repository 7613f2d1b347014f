// Proves that tables have the same rows in all formats, with stored or computed values, and checks their texts.
#include "io/table/table_files.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cstdint>
#include <filesystem>
#include <limits>
#include <span>
#include <stop_token>
#include <string>
#include <variant>
#include <vector>

#include "blum/core/error.hpp"
#include "blum/io/centreline_io.hpp"
#include "io/archive/numpy.hpp"
#include "io/bytes/byte_source.hpp"
#include "unit/io/temporary_folder.hpp"

namespace blum {
namespace {

using tables::column_of;
using tables::made_column;
using tables::Table;

class TableFiles : public testing::Test {
 protected:
  TableFiles() {
    const auto pairs = [](std::size_t row, std::span<std::int32_t> out) {
      for (std::size_t k = 0; k < 4; ++k) out[k] = static_cast<std::int32_t>(10 * row + k);
    };
    tables_.push_back({2,
                       {column_of("place", places_, {"x", "y", "z"}), made_column<std::int32_t>("pair", {2, 2}, pairs),
                        column_of(lengths_)}});
    tables_.push_back({3, {column_of("index", {}, std::span<const std::uint32_t>(indices_))}});
  }

  const std::vector<Vec3d> places_{{1, 2.5, -0.0}, {1e300, 0.1, 3}};
  const Column lengths_{"length", 1, std::vector<float>{0.1F, std::numeric_limits<float>::infinity()}};
  const std::vector<std::uint32_t> indices_{7, 8, 9};
  std::vector<Table> tables_;
  test::TemporaryFolder folder_;
};

template <class T>
std::vector<T> array_of(volume_io::NpzReader& npz, const std::string& name, const std::vector<std::uint64_t>& shape) {
  return npz.read(name, [&](volume_io::ByteStream& stream, const volume_io::NpyHeader& header) {
    EXPECT_EQ(header.shape, shape) << name;
    return std::get<std::vector<T>>(read_npy_values(stream, header));
  });
}

TEST_F(TableFiles, AreArrays) {
  tables::write_npz(folder_ / "t.npz", tables_, {{"content", "test"}}, {});
  const volume_io::FileSource source(folder_ / "t.npz");
  volume_io::NpzReader npz(source);
  EXPECT_EQ(array_of<double>(npz, "place", {2, 3}), (std::vector<double>{1, 2.5, -0.0, 1e300, 0.1, 3}));
  EXPECT_EQ(array_of<std::int32_t>(npz, "pair", {2, 2, 2}), (std::vector{0, 1, 2, 3, 10, 11, 12, 13}));
  EXPECT_EQ(array_of<float>(npz, "length", {2})[0], 0.1F);
  EXPECT_EQ(array_of<std::int32_t>(npz, "index", {3}), (std::vector{7, 8, 9}));
  EXPECT_EQ(npz.text("metadata"), "{\"content\": \"test\"}");
  tables::write_npz(folder_ / "bare.npz", tables_, {}, {});
  const volume_io::FileSource bare(folder_ / "bare.npz");
  EXPECT_FALSE(volume_io::NpzReader(bare).has("metadata"));
}

TEST_F(TableFiles, AreRowsOfText) {
  const auto word = [](std::size_t row, std::span<std::string> out) { out[0] = row == 0 ? "one" : ""; };
  tables_[0].columns.push_back(made_column<std::string>("word", {}, word));
  tables::write_csv(folder_ / "t.csv", tables_[0], {});
  EXPECT_EQ(test::file_content(folder_ / "t.csv"),
            "x,y,z,pair_0,pair_1,pair_2,pair_3,length,word\n"
            "1,2.5,-0,0,1,2,3,0.1,one\n1e+300,0.1,3,10,11,12,13,inf,\n");
  EXPECT_THROW(tables::write_npz(folder_ / "t.npz", tables_, {}, {}), InvalidOption);
  EXPECT_EQ(folder_.entries(), 1);
}

TEST_F(TableFiles, AreLists) {
  constexpr std::array<std::string_view, 1> typed{"self"};
  tables::write_json(folder_ / "t.json", tables_, {{"self", "true"}, {"other", "true"}}, {typed}, {});
  EXPECT_EQ(test::file_content(folder_ / "t.json"),
            "{\"metadata\": {\"self\": true, \"other\": \"true\"},\n"
            "\"place\": [\n[1, 2.5, -0],\n[1e+300, 0.1, 3]],\n"
            "\"pair\": [\n[[0, 1], [2, 3]],\n[[10, 11], [12, 13]]],\n"
            "\"length\": [\n0.1,\nnull],\n\"index\": [\n7,\n8,\n9]}\n");
  tables::write_json(folder_ / "t.json", std::span(tables_).last(1), {}, {{}, true}, {});
  EXPECT_EQ(test::file_content(folder_ / "t.json"), "{\"metadata\": {},\n\"index\": [7, 8, 9]}\n");
}

TEST_F(TableFiles, WithoutRowsAreWritten) {
  Table empty{0, {column_of("place", std::span<const Vec3d>()), column_of("k", {}, std::span<const double>())}};
  tables::write_csv(folder_ / "t.csv", empty, {});
  EXPECT_EQ(test::file_content(folder_ / "t.csv"), "place_0,place_1,place_2,k\n");
  tables::write_json(folder_ / "t.json", std::span(&empty, 1), {}, {}, {});
  EXPECT_EQ(test::file_content(folder_ / "t.json"), "{\"metadata\": {},\n\"place\": [],\n\"k\": []}\n");
}

TEST_F(TableFiles, CancelledWritesLeaveTheOldFiles) {
  std::stop_source stop;
  stop.request_stop();
  Context context;
  context.cancel = stop.get_token();
  test::put_file(folder_ / "t", "old");
  EXPECT_THROW(tables::write_npz(folder_ / "t", tables_, {}, context), Cancelled);
  EXPECT_THROW(tables::write_csv(folder_ / "t", tables_[0], context), Cancelled);
  EXPECT_THROW(tables::write_json(folder_ / "t", tables_, {}, {}, context), Cancelled);
  EXPECT_EQ(test::file_content(folder_ / "t"), "old");
  EXPECT_EQ(folder_.entries(), 1);
}

TEST(CentrelineFiles, HoldTheGivenLinesAndInfo) {
  const test::TemporaryFolder folder;
  Centrelines lines;
  Centreline& line = lines.labels.emplace_back();
  line.label = 7;
  line.nodes = {{CentrelineNodeKind::end, {0, 0, 0}, 1}, {CentrelineNodeKind::end, {2, 0, 0}, 1}};
  line.branches = {{{0, 1}, 2, 1.5, 1, {{0, 0, 0}, {2, 0, 0}}, {1, 1}}, {{-1, -1}, 3, 1, 1, {{5, 0, 0}}, {1}}};
  const auto written = [&](const char* name, const CentrelineFileInfo& info = {}) {
    write_centrelines(folder / name, lines, info);
    return test::file_content(folder / name);
  };
  EXPECT_EQ(written("c.csv"),
            "label,branch,first_node,last_node,first_kind,last_kind,length,mean_radius,min_radius,points\n"
            "7,0,0,1,end,end,2,1.5,1,2\n7,1,,,closed,closed,3,1,1,1\n");
  EXPECT_TRUE(written("c.json").starts_with("{\n \"labels\": [\n  {\"label\":7,"));
  EXPECT_TRUE(written("c.json", {{}, "{}"}).starts_with("{\n \"labels\": ["));
  EXPECT_TRUE(written("c.json", {{}, "{\n \"a\": {}\n}"}).starts_with("{\n \"a\": {},\n \"labels\": ["));
  EXPECT_TRUE(
      written("c.swc").starts_with("# n type x y z radius parent; written by Blum\n# label 7\n1 0 0 0 0 1 -1\n"));
  EXPECT_TRUE(written("d.swc", {"0.1", {}}).starts_with("# n type x y z radius parent; written by Blum 0.1\n"));
  lines.labels[0].label.reset();
  EXPECT_NE(written("c.csv").find("\n,0,0,1,end,"), std::string::npos);
  EXPECT_THROW(write_centrelines(folder / "c.txt", lines), InvalidOption);
}

}  // namespace
}  // namespace blum
