// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/flight/doctor/finding.h"

#include <array>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace kestrel {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

std::array<Finding, 3> SomeFindings() {
  Finding wrong = Wrong("PLND_TYPE", "0", "param set PLND_TYPE 1");
  wrong.fix = ParameterFix{"PLND_TYPE", 1, true};
  return {Good("images", "160"), NotChecked("focus", "no \"edges\" \xff", "lay"), wrong};
}

TEST(FindingTest, TableHasAdviceAndCounts) {
  const std::string table = FindingsTable(SomeFindings(), false);
  EXPECT_THAT(table, HasSubstr("images     good         160\n"));
  EXPECT_THAT(table, HasSubstr("-> param set PLND_TYPE 1\n"));
  EXPECT_THAT(table, HasSubstr("1 good, 0 doubtful, 1 wrong, 1 not checked\n"));
  EXPECT_THAT(table, Not(HasSubstr("\x1b")));
}

TEST(FindingTest, JsonIsValidForAnyText) {
  const auto json = nlohmann::json::parse(FindingsJson(SomeFindings()));
  EXPECT_EQ(json["wrong"], 1);
  EXPECT_EQ(json["not checked"], 1);
  EXPECT_EQ(json["findings"].size(), 3u);
  EXPECT_FALSE(json["findings"][0].contains("advice"));
  EXPECT_EQ(json["findings"][2]["fix"]["parameter"], "PLND_TYPE");
  EXPECT_EQ(json["findings"][2]["fix"]["reboot"], true);
}

}  // namespace
}  // namespace kestrel
