// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/app/console/study/study_judgement.h"

#include <gtest/gtest.h>

namespace kestrel {
namespace {

// The words of test_too_few_recordings_are_not_judged in python/tests/test_study_report.py.
TEST(StudyJudgement, FewRecordingsProveNothing) {
  EXPECT_EQ(StudyJudgement({-3}),
            "Worse in the one recording, too few to prove (1 recording, 8 are the least)");
  EXPECT_EQ(StudyJudgement({-3, -1}),
            "Worse in both, too few to prove (2 recordings, 8 are the least)");
  EXPECT_EQ(StudyJudgement({-1, -1, -1, -1, -1}),
            "Worse in all 5, too few to prove (5 recordings, 8 are the least)");
  EXPECT_EQ(StudyJudgement({-1, 2, 0}),
            "Worse in 1 of 3 and better in 1 of 3, too few to prove (3 recordings, 8 are the "
            "least)");
  EXPECT_EQ(StudyJudgement({0, 4}),
            "Better in 1 of 2, too few to prove (2 recordings, 8 are the least)");
  EXPECT_EQ(StudyJudgement({0, 0}),
            "No difference, too few to prove (2 recordings, 8 are the least)");
}

TEST(StudyJudgement, RefersToReportForManyRecordings) {
  EXPECT_EQ(StudyJudgement({-1, -1, -1, -1, -1, -1, -1, 0}),
            "Worse in 7 of 8; kestrel study report judges whether that is chance");
}

TEST(StudyJudgement, NoRecordingsGiveEmptyText) { EXPECT_EQ(StudyJudgement({}), ""); }

}  // namespace
}  // namespace kestrel
