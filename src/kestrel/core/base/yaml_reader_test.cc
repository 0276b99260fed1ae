// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/core/base/yaml_reader.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "kestrel/core/base/error.h"
#include "kestrel/core/base/test_folder.h"

namespace kestrel {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

YamlReader ReaderOf(const std::string& text) { return YamlReader(text, "file.yaml"); }

TEST(YamlReader, ReadsValues) {
  const YamlReader root = ReaderOf("name: red\nsize: 0.2\ncount: 3\non: true\nmean: [1, 2.5]\n");
  EXPECT_EQ(root["name"].Text(), "red");
  EXPECT_EQ(root["size"].Number(), 0.2);
  EXPECT_EQ(root["count"].Integer(), 3);
  EXPECT_TRUE(root["on"].Bool());
  EXPECT_THAT(root["mean"].Numbers(2), ElementsAre(1, 2.5));
  EXPECT_EQ(root["mean"].Items().size(), 2u);
  EXPECT_TRUE(root.Has("name"));
  EXPECT_FALSE(root.Has("other"));
}

TEST(YamlReader, AcceptsIntegersWithZeroFraction) {
  EXPECT_EQ(ReaderOf("id: 7.0\n")["id"].Integer(), 7);
  EXPECT_EQ(ReaderOf("id: 9007199254740993\n")["id"].Integer(), 9007199254740993);
  EXPECT_THAT(InputErrorOf([] { ReaderOf("id: 1e30\n")["id"].Integer(); }),
              HasSubstr("a whole number"));
}

TEST(YamlReader, ReadsJson) { EXPECT_EQ(ReaderOf(R"({"a": {"b": 4}})")["a"]["b"].Integer(), 4); }

TEST(YamlReader, ErrorsNameFileLineAndKey) {
  const YamlReader root = ReaderOf("a: 1\nb:\n  size: big\n");
  EXPECT_THAT(InputErrorOf([&] { root["b"]["size"].Number(); }),
              AllOf(HasSubstr("file.yaml:3:"), HasSubstr("size"), HasSubstr("a finite number")));
  EXPECT_THAT(InputErrorOf([&] { root["c"]; }), HasSubstr("'c' is missing"));
  EXPECT_THAT(InputErrorOf([] { ReaderOf("a: [1, 2"); }), HasSubstr("file.yaml:"));
}

TEST(YamlReader, RefusesWrongTypes) {
  const YamlReader root = ReaderOf("list: [1, x]\nnumber: 1.5\nhuge: .inf\n");
  EXPECT_THAT(InputErrorOf([&] { root["list"].Text(); }), HasSubstr("a word"));
  EXPECT_THAT(InputErrorOf([&] { root["list"].Numbers(2); }), HasSubstr("a finite number"));
  EXPECT_THAT(InputErrorOf([&] { ReaderOf("[1, 2]").Numbers(3); }),
              HasSubstr("a list of 3 numbers"));
  EXPECT_THAT(InputErrorOf([&] { root["number"].Integer(); }), HasSubstr("a whole number"));
  EXPECT_THAT(InputErrorOf([&] { root["number"].Bool(); }), HasSubstr("true or false"));
  EXPECT_THAT(InputErrorOf([&] { root["number"].Items(); }), HasSubstr("a list"));
  EXPECT_THAT(InputErrorOf([&] { root["huge"].Number(); }), HasSubstr("a finite number"));
}

TEST(YamlReader, RefusesUnknownAndDuplicateKeys) {
  EXPECT_EQ(InputErrorOf([] { ReaderOf("a: 1\nb: 2\n").RequireKeys({"a", "b", "c"}); }), "");
  EXPECT_THAT(InputErrorOf([] { ReaderOf("a: 1\nz: 2\n").RequireKeys({"a"}); }), HasSubstr("'z'"));
  EXPECT_THAT(InputErrorOf([] { ReaderOf("a: 1\na: 2\n").RequireKeys({"a"}); }),
              HasSubstr("twice"));
  EXPECT_THAT(InputErrorOf([] { ReaderOf("[1]").RequireKeys({"a"}); }), HasSubstr("name: value"));
}

}  // namespace
}  // namespace kestrel
