// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/io/recording/tables/csv_table.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "kestrel/core/base/test_folder.h"

namespace kestrel {
namespace {

using ::testing::HasSubstr;

TEST(CsvTable, ReadsCellsByHeaderName) {
  const CsvTable table("#timestamp [ns], x [m] ,name\n12, 1.5e1 ,a.png\r\n\n13,-2,b.png", "t.csv");
  ASSERT_EQ(table.row_count(), 2u);
  EXPECT_EQ(table.Integer(0, table.Column("timestamp [ns]")), 12);
  EXPECT_EQ(table.Number(0, table.Column("x[m]")), 15);
  EXPECT_EQ(table.Number(1, table.Column("x [m]")), -2);
  EXPECT_EQ(table.Text(0, table.Column("name")), "a.png");
  EXPECT_EQ(table.Text(1, table.Column("name")), "b.png");
}

TEST(CsvTable, MatchesNameWithUnit) {
  const CsvTable table("timestamp [s]\n1\n", "t.csv");
  EXPECT_THAT(InputErrorOf([&] { table.Column("timestamp [ns]"); }),
              HasSubstr("t.csv: no column 'timestamp [ns]'"));
}

TEST(CsvTable, ReportsLineOfWrongWidth) {
  EXPECT_EQ(InputErrorOf([] { CsvTable("a,b\n1,2\n\n3\n", "t.csv"); }),
            "t.csv: line 4: 1 columns, expected 2 as in the header");
  EXPECT_THAT(InputErrorOf([] { CsvTable("a,b\n1,2,\n", "t.csv"); }),
              HasSubstr("line 2: 3 columns"));
}

TEST(CsvTable, ReportsLineAndColumnOfNonNumber) {
  const CsvTable table("a [m],b\n1,2\nnan,2.5\n1x,\n", "t.csv");
  EXPECT_EQ(InputErrorOf([&] { table.Number(1, 0); }),
            "t.csv: line 3: a [m] is 'nan', expected a finite number");
  EXPECT_EQ(InputErrorOf([&] { table.Integer(1, 1); }),
            "t.csv: line 3: b is '2.5', expected a whole number");
  EXPECT_THAT(InputErrorOf([&] { table.Number(2, 0); }), HasSubstr("'1x'"));
  EXPECT_THAT(InputErrorOf([&] { table.Text(2, 1); }), HasSubstr("line 4"));
}

TEST(CsvTable, RefusesIntegerOutOfRange) {
  const CsvTable table("a\n9223372036854775808\n9223372036854775807\n", "t.csv");
  EXPECT_NE(InputErrorOf([&] { table.Integer(0, 0); }), "");
  EXPECT_EQ(table.Integer(1, 0), 9223372036854775807);
}

TEST(CsvTable, RefusesEmptyText) {
  EXPECT_THAT(InputErrorOf([] { CsvTable("\n \n", "t.csv"); }), HasSubstr("t.csv: is empty"));
}

TEST(CsvTable, AcceptsByteOrderMarkAndWindowsLineEnds) {
  const CsvTable table("\xef\xbb\xbf#timestamp [ns],filename\r\n1,a.png\r\n", "t.csv");
  EXPECT_EQ(table.Integer(0, table.Column("timestamp [ns]")), 1);
  EXPECT_EQ(table.Text(0, table.Column("filename")), "a.png");
}

}  // namespace
}  // namespace kestrel
