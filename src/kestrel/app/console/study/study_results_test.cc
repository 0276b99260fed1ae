// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/app/console/study/study_results.h"

#include <filesystem>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "kestrel/app/console/study/test_study.h"

namespace kestrel {
namespace {

using ::testing::ElementsAre;
using ::testing::EndsWith;
using ::testing::HasSubstr;

const StudyVariant kUsual{"usual", "v1", "land"}, kStrict{"strict", "v1", "land"};

std::vector<std::string> Names(const StudyComparison& comparison) {
  std::vector<std::string> names;
  for (const StudyRow& row : comparison.rows) names.push_back(row.recording);
  return names;
}

TEST(StudyResults, SortsWorstRowFirst) {
  const TestFolder folder;
  const TestStudy study(folder);
  study.AddDone("same", "usual", 8);
  study.AddDone("same", "strict", 8);
  study.AddDone("better", "usual", 5);
  study.AddDone("better", "strict", 9);
  study.AddDone("lost", "usual", 9);
  study.AddDone("lost", "strict", 4);
  study.AddDone("false", "usual", 8, 0);
  study.AddDone("false", "strict", 8, 3);
  study.AddDone("broken", "usual", 8);
  study.AddFailed("broken", "strict", "memory limit");
  study.AddDone("to do", "usual", 8);
  const StudyResults results(study.path());
  const StudyComparison comparison = results.Compare(kUsual, kStrict);
  EXPECT_THAT(Names(comparison), ElementsAre("broken", "lost", "false", "same", "better", "to do"));
  EXPECT_EQ(comparison.total, 6u);
  EXPECT_EQ(comparison.judgement,
            "Worse in 1 of 4 and better in 1 of 4, too few to prove (4 recordings, 8 are the "
            "least)");
  EXPECT_EQ(results.Compare(kUsual, kUsual).judgement, "");
  EXPECT_EQ(comparison.rows[0].after.failure, "memory limit");
  const StudyRow& lost = comparison.rows[1];
  EXPECT_DOUBLE_EQ(*lost.before.found, 0.9);
  EXPECT_DOUBLE_EQ(*lost.after.found, 0.4);
  EXPECT_DOUBLE_EQ(*lost.before.error_m, 0.05) << "of 0.01 to 0.09";
  EXPECT_DOUBLE_EQ(*lost.after.error_m, 0.025) << "of 0.01 to 0.04";
  EXPECT_DOUBLE_EQ(*lost.Change(), -0.5);
  EXPECT_NEAR(*comparison.rows[2].Change(), -0.3, 1e-12);
  EXPECT_TRUE(comparison.rows[5].after.key.empty());
}

TEST(StudyResults, FindsFirstFrameOfWorstChange) {
  const TestFolder folder;
  const TestStudy study(folder);
  constexpr std::int64_t kBegin = 1'700'000'000'000'000'000;
  study.AddDone("lost", "usual", 9, 0, "", kBegin);
  study.AddDone("lost", "strict", 4, 0, "", kBegin);
  const StudyResults results(study.path());
  const StudyComparison comparison = results.Compare(kUsual, kStrict);
  EXPECT_EQ(ToNanoseconds(*results.WorstFrame(comparison.rows[0])), kBegin + 400'000'000);
  // A false detection beside what is found weighs less than one in the place of what was found.
  study.Run(
      "UPDATE detection SET \"false\" = 1 WHERE key = 'loststrict' AND frame IN ('2.png', "
      "'7.png')");
  EXPECT_EQ(ToNanoseconds(*results.WorstFrame(comparison.rows[0])), kBegin + 700'000'000);
}

TEST(StudyResults, FindsLargestErrorIfNothingElseDiffers) {
  const TestFolder folder;
  const TestStudy study(folder);
  study.AddDone("flight", "usual", 9, 0, "", 100'000'000);
  study.AddDone("flight", "strict", 9, 0, "", 100'000'000);
  const StudyResults results(study.path());
  const StudyRow row = results.Compare(kUsual, kStrict).rows.at(0);
  EXPECT_EQ(ToNanoseconds(*results.WorstFrame(row)), 100'000'000) << "the first";
  study.Run("INSERT INTO worst VALUES('flightstrict', 1, 300000000, '3.png', 'error_m', 1)");
  EXPECT_EQ(ToNanoseconds(*results.WorstFrame(row)), 300'000'000) << "nothing differs";
  study.Run("UPDATE detection SET error_m = 2 WHERE key = 'flightstrict' AND frame = '6.png'");
  EXPECT_EQ(ToNanoseconds(*results.WorstFrame(row)), 700'000'000);
}

TEST(StudyResults, IgnoresUnitsOfEarlierPlan) {
  const TestFolder folder;
  const TestStudy study(folder);
  study.AddDone("flight", "usual", 9);
  study.AddDone("flight", "old", 9);
  study.Run("UPDATE unit SET state = 'old' WHERE configuration = 'old'");
  EXPECT_THAT(StudyResults(study.path()).Variants(), ElementsAre(kUsual));
}

TEST(StudyResults, ListsVariantsInOrderOfPlanWithOptions) {
  const TestFolder folder;
  const TestStudy study(folder);
  for (const char* name : {"no plan has it", "strict", "usual"}) study.AddDone("flight", name, 9);
  const StudyResults results(study.path());
  const StudyVariant unknown{"no plan has it", "v1", "land"};
  EXPECT_THAT(results.Variants(), ElementsAre(kUsual, kStrict, unknown));
  EXPECT_THAT(results.OptionsOf(kStrict).arguments, ElementsAre("--altitude", "3"));
  EXPECT_EQ(results.OptionsOf(kStrict).text, "landing: {detector: {min_quality: 1}}");
  EXPECT_THAT(InputErrorOf([&] { results.OptionsOf(unknown); }),
              EndsWith("has no options of 'no plan has it'"));
  study.Run("UPDATE configuration SET arguments = '[3]'");
  EXPECT_THAT(InputErrorOf([&] { results.OptionsOf(kUsual); }),
              EndsWith("the arguments of 'usual' are not a list of words"));
}

TEST(StudyResults, ReadsResultsWhileStudyWrites) {
  const TestFolder folder;
  const TestStudy study(folder);
  study.Run("PRAGMA journal_mode = WAL");
  study.AddDone("flight", "usual", 9);
  const StudyResults results(study.path());
  study.Run("BEGIN");
  study.AddDone("another", "usual", 9);
  EXPECT_EQ(results.Compare(kUsual, kUsual).total, 1u);
  study.Run("COMMIT");
  EXPECT_EQ(results.Compare(kUsual, kUsual).total, 2u);
}

TEST(StudyResults, KeepsWorstOfManyRows) {
  const TestFolder folder;
  const TestStudy study(folder);
  study.Run("BEGIN");
  for (int i = 0; i < 1200; ++i) {
    study.Run(fmt::format(
        "INSERT INTO unit VALUES('k{0}', 'flight {0}', 0, 'usual', 'v1', 'land', NULL, 'done', '', "
        "10, '')",
        i));
  }
  study.Run("COMMIT");
  const StudyComparison comparison = StudyResults(study.path()).Compare(kUsual, kUsual);
  EXPECT_EQ(comparison.total, 1200u);
  EXPECT_EQ(comparison.rows.size(), StudyResults::kMaxRows);
}

TEST(StudyResults, ReportsWhyFileIsNoStudy) {
  const TestFolder folder;
  const auto error = [&] {
    return InputErrorOf([&] {
      const StudyResults results(folder / "study");
      results.Compare(results.Variants().at(0), kStrict);
    });
  };
  folder.Write("study/study.db",
               "this is no database, and long enough to be read as a header....."
               "....................................................");
  EXPECT_THAT(error(), EndsWith("not the results of a study: file is not a database"));
  std::filesystem::remove(folder / "study/study.db");
  const TestStudy study(folder);
  EXPECT_THAT(error(), EndsWith("has no results yet; `kestrel study run` makes them"));
  study.AddDone("flight", "usual", 4);
  EXPECT_EQ(error(), "");
  study.Run("UPDATE bin SET found = 11");
  EXPECT_THAT(error(), EndsWith("the unit flightusual has found 11 of 10"));
  study.Run("ALTER TABLE bin RENAME COLUMN found TO hits");
  EXPECT_THAT(error(), HasSubstr("no such column: found"));
  study.Run("DROP TABLE bin");
  study.Run(
      "CREATE VIEW bin AS WITH RECURSIVE n(x) AS (SELECT 1 UNION ALL SELECT x FROM n) "
      "SELECT * FROM n");
  EXPECT_THAT(error(), EndsWith("has no table 'bin'"));
}

TEST(StudyResults, RefusesTruncatedFile) {
  const TestFolder folder;
  {
    const TestStudy study(folder);
    for (int i = 0; i < 50; ++i) study.AddDone(fmt::format("flight {}", i), "usual", 4);
  }
  TestFolder::CutOff(folder / "study/study.db", 0.5);
  const std::string error = InputErrorOf([&] {
    const StudyResults results(folder / "study");
    results.Compare(results.Variants().at(0), kStrict);
  });
  EXPECT_THAT(error, HasSubstr("study.db: not the results of a study: "));
}

}  // namespace
}  // namespace kestrel
