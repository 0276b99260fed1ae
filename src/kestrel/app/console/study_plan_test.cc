// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/app/console/study_plan.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "kestrel/core/base/test_folder.h"

namespace kestrel {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::StartsWith;

TEST(StudyPlan, KnowsTheArgumentsOfEachConfiguration) {
  const TestFolder folder;
  folder.Write("study/study.yaml", R"(task: land
arguments: [--altitude, 3]
configurations:
  - name: usual
    config: options/usual.yaml
  - name: usual grid
    config: /etc/kestrel.yaml
    set: {landing.still: true, landing.tracker.gate: [9, 12.5], landing.track_yaw: [true, false]}
)");
  const StudyPlan plan(folder / "study");
  EXPECT_THAT(plan.ArgumentsOf("usual"),
              ElementsAre("--altitude", "3", "--config", folder / "options/usual.yaml"));
  EXPECT_THAT(
      plan.ArgumentsOf("usual grid landing.tracker.gate=12.5, landing.track_yaw=false"),
      ElementsAre("--altitude", "3", "--config", "/etc/kestrel.yaml", "--set", "landing.still=true",
                  "--set", "landing.tracker.gate=12.5", "--set", "landing.track_yaw=false"));
  EXPECT_EQ(plan.PlaceOf("usual"), 0u);
  EXPECT_EQ(plan.PlaceOf("usual grid landing.tracker.gate=9, landing.track_yaw=true"), 1u);
  EXPECT_EQ(plan.PlaceOf("usually"), 2u);
  EXPECT_THAT(InputErrorOf([&] { plan.ArgumentsOf("usually"); }),
              HasSubstr("study.yaml: has no configuration 'usually' any more"));
}

TEST(StudyPlan, HasADefaultWhereNothingIsCompared) {
  const TestFolder folder;
  folder.Write("study/study.yaml", "task: land\nrecordings: [flights]\n");
  EXPECT_THAT(StudyPlan(folder / "study").ArgumentsOf("default"), IsEmpty());
}

TEST(StudyPlan, SaysWhatIsWrongInIt) {
  const TestFolder folder;
  const auto error = [&](const std::string& text) {
    folder.Write("study/study.yaml", text);
    return InputErrorOf([&] { StudyPlan(folder / "study"); });
  };
  const std::string file = folder / "study/study.yaml";
  EXPECT_EQ(error("[]"), file + ": not the plan of a study, expected keys");
  EXPECT_EQ(error("task: land\nconfigurations:\n  - config: a.yaml\n"),
            file + ":3: a configuration has no 'name'");
  EXPECT_THAT(error("a: [\n"), StartsWith(file + ":2: not the plan of a study: "));
  EXPECT_THAT(InputErrorOf([&] { StudyPlan(folder / "none"); }), HasSubstr("none/study.yaml"));
}

}  // namespace
}  // namespace kestrel
