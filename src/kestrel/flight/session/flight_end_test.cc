// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/flight/session/flight_end.h"

#include <gtest/gtest.h>

#include "kestrel/core/geometry/angles.h"

namespace kestrel {
namespace {

TEST(FlightEndTest, EachEndHasTextAndExitStatus) {
  struct Case {
    FlightEnd end;
    const char* words;
    int status;
  };
  const Case cases[] = {
      {{FlightOutcome::kOnPattern, 0.054}, "landed 0.05 m from the centre (estimated)", 0},
      {{.outcome = FlightOutcome::kOnPattern, .offset_m = 0.054, .has_true_offset = true},
       "landed 0.05 m from the centre (true)",
       0},
      {{.outcome = FlightOutcome::kOnPattern,
        .offset_m = 0.054,
        .has_true_offset = true,
        .estimated_m = 0.061},
       "landed 0.05 m from the centre (true), 0.06 m estimated",
       0},
      {{FlightOutcome::kOnPattern, 0.031, "by what was seen: the autopilot had no position"},
       "landed 0.03 m from the centre (estimated), by what was seen: the autopilot had no position",
       0},
      {{FlightOutcome::kOnPattern}, "landed on the pattern", 0},
      {{FlightOutcome::kStopped}, "ended by the user", 0},
      {{FlightOutcome::kSourceEnded}, "the source has ended", 0},
      {{FlightOutcome::kLanded}, "landed", 0},
      {{FlightOutcome::kBesidePattern, 10.83}, "landed 10.8 m beside the pattern (estimated)", 4},
      {{FlightOutcome::kDownSomewhere, {}, "the pattern was never seen"},
       "down, and not known where: the pattern was never seen",
       4},
      {{FlightOutcome::kGaveUp, 3.2, "no new images"},
       "guidance gave up (no new images); down 3.2 m from the pattern (estimated)",
       4},
      {{FlightOutcome::kGaveUp, {}, "no new images"},
       "guidance gave up (no new images); down, and not known where",
       4},
      {{FlightOutcome::kNotLanded, {}, "no image for 60 s"}, "not landed: no image for 60 s", 3},
      {{FlightOutcome::kRestarted}, "the autopilot restarted in flight", 3},
      {{FlightOutcome::kLinkLost, {}, "no heartbeat of the autopilot for 60 s"},
       "link lost: no heartbeat of the autopilot for 60 s",
       3},
  };
  for (const Case& one : cases) {
    EXPECT_EQ(InWords(one.end), one.words);
    EXPECT_EQ(ExitStatus(one.end), one.status) << one.words;
  }
}

TEST(FlightEndTest, TableHasOneRow) {
  EXPECT_EQ(FlightEndCsv({FlightOutcome::kBesidePattern, 10.83}),
            "end,offset_m,words,heading_error_deg,offset_is\n"
            "beside pattern,10.8300,\"landed 10.8 m beside the pattern (estimated)\",,estimated\n");
  EXPECT_EQ(FlightEndCsv({FlightOutcome::kStopped}),
            "end,offset_m,words,heading_error_deg,offset_is\nstopped,,\"ended by the user\",,\n");
  EXPECT_EQ(
      FlightEndCsv({FlightOutcome::kOnPattern, 0.05, {}, Radians(1.25)}),
      "end,offset_m,words,heading_error_deg,offset_is\n"
      "on pattern,0.0500,\"landed 0.05 m from the centre (estimated), heading off by 1.2 degrees\","
      "1.25,estimated\n");
}

TEST(FlightEndTest, PrintsZeroHeadingErrorWithoutSign) {
  const FlightEnd end{FlightOutcome::kOnPattern, 0.05, {}, Radians(-0.004)};
  EXPECT_EQ(InWords(end), "landed 0.05 m from the centre (estimated), heading off by 0.0 degrees");
  EXPECT_NE(FlightEndCsv(end).find(",0.00,"), std::string::npos) << FlightEndCsv(end);
}

}  // namespace
}  // namespace kestrel
