// Proves that metadata read back from JSON unchanged, and that all other text than flat objects of strings is refused.
// Nesting and length of hostile text cost no more than reading the text.
#include "io/text/json.hpp"

#include <gtest/gtest.h>

#include "blum/core/error.hpp"

namespace blum {
namespace {

using volume_io::from_json;
using volume_io::to_json;

TEST(Json, ReadsBackUnchanged) {
  const FileMetadata pairs{{"b", "1"},
                           {"a", "caf\xC3\xA9 \xF0\x9F\x98\x80 \"quoted\" \\ / \x01\x1F\x7F\b\f\n\r\t"},
                           {"", ""},
                           {"b", "again"}};
  const std::string text = to_json(pairs);
  EXPECT_EQ(from_json(text, "test"), pairs);
  for (const char c : text) EXPECT_TRUE(c >= ' ' && c < 0x7F) << "ASCII only";
  EXPECT_EQ(to_json({{"theta", "60"}, {"a", "b"}}), R"({"theta": "60", "a": "b"})");
  EXPECT_EQ(to_json({}), "{}");
  EXPECT_EQ(from_json(" {\n} ", "test"), FileMetadata{});
}

TEST(Json, ReplacesInvalidUtf8) {
  EXPECT_EQ(from_json(to_json({{"k",
                                "a\xFF"
                                "b"}}),
                      "test"),
            (FileMetadata{{"k",
                           "a\xEF\xBF\xBD"
                           "b"}}));
}

TEST(Json, RefusesAllOtherText) {
  const std::string deep(1'000'000, '[');
  std::string objects;
  for (int i = 0; i < 100'000; ++i) objects += R"({"k":)";
  for (const std::string& text : {std::string(),
                                  std::string("{"),
                                  std::string("[]"),
                                  std::string("\"text\""),
                                  std::string("null"),
                                  std::string(R"({"k": 1})"),
                                  std::string(R"({"k": NaN})"),
                                  std::string(R"({"k": Infinity})"),
                                  std::string(R"({"k": 1e999})"),
                                  std::string(R"({"k": null})"),
                                  std::string(R"({"k": true})"),
                                  std::string(R"({"k": ["v"]})"),
                                  std::string(R"({"k": {"l": "v"}})"),
                                  std::string(R"({"k": "v"} more)"),
                                  std::string(R"({"k": "\ud800"})"),
                                  std::string(R"({"k": "\x"})"),
                                  std::string("{\"k\": \"\xFF\"}"),
                                  std::string(R"({"k" "v"})"),
                                  std::string(R"({k: "v"})"),
                                  std::string(R"({"k": "v",})"),
                                  deep,
                                  objects,
                                  R"({"k": )" + deep}) {
    EXPECT_THROW((void)from_json(text, "test"), FormatError) << text.substr(0, 40);
  }
}

}  // namespace
}  // namespace blum
