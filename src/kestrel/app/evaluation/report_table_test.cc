// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/app/evaluation/report_table.h"

#include <limits>

#include <gtest/gtest.h>

namespace kestrel {
namespace {

const ReportTable kTable = {
    "rates", "Rates", "All of it.", {"what", "rate, %"}, {{"day", "-"}, {"night", "12.5"}}};

TEST(ReportTable, FormatsAsMarkdown) {
  EXPECT_EQ(ToMarkdown(kTable),
            "## Rates\n\nAll of it.\n\n| what | rate, % |\n| --- | --- |\n| day | - |\n"
            "| night | 12.5 |\n");
}

TEST(ReportTable, FormatsAsCsvWithEmptyUnknownsAndQuotedCommas) {
  EXPECT_EQ(ToCsv(kTable), "what,\"rate, %\"\nday,\nnight,12.5\n");
}

TEST(ReportTable, FormatsNumbers) {
  EXPECT_EQ(FormatFixed(1.005, 1), "1.0");
  EXPECT_EQ(FormatFixed(std::numeric_limits<double>::quiet_NaN(), 1), "-");
  EXPECT_EQ(FormatPercent(0.9876), "98.8");
  EXPECT_EQ(FormatPercent(Interval{0.5, 1}), "50.0 to 100.0");
}

}  // namespace
}  // namespace kestrel
