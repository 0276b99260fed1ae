// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/core/base/load_yaml.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <yaml-cpp/yaml.h>

#include "kestrel/core/base/error.h"
#include "kestrel/core/base/test_folder.h"

namespace kestrel {
namespace {

using ::testing::HasSubstr;

std::string Refusal(const std::string& text) {
  return InputErrorOf([&] { LoadYaml(text, "file.yaml"); });
}

TEST(LoadYaml, SkipsOpenCvDirectiveAndByteOrderMark) {
  const YAML::Node root = LoadYaml("\xEF\xBB\xBF%YAML:1.0\n---\na: 1\n", "file.yaml");
  EXPECT_EQ(root["a"].Scalar(), "1");
  EXPECT_EQ(root["a"].Mark().line, 2);
}

TEST(LoadYaml, ReportsTabs) {
  EXPECT_EQ(Refusal("lens:\n\twidth: 1\n"), "file.yaml:2: a tab; YAML indents by spaces");
  EXPECT_EQ(Refusal("a: 1\nb:\n  c: 1\n  \td: 2\n"), "file.yaml:4: a tab; YAML indents by spaces");
  EXPECT_EQ(LoadYaml("a:\tb\n", "file.yaml")["a"].Scalar(), "b");
}

TEST(LoadYaml, RefusesNonYaml) {
  EXPECT_THAT(Refusal("a: [1, 2\n"),
              HasSubstr("file.yaml:2: the file is not YAML or is truncated"));
  EXPECT_EQ(Refusal(std::string("PK\0\x03", 4)),
            "file.yaml: the file is binary, expected text (YAML)");
}

}  // namespace
}  // namespace kestrel
