// SPDX-License-Identifier: BSD-3-Clause
// Sessions that guide: what they say of a pad that the camera does not see from the search
// altitude.
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "test_session.h"

namespace kestrel {
namespace {

using testing::HasSubstr;
using testing::Not;

// Returns what a session says that guides to a tag of 'size_m'. Nobody is at the link's other end.
std::string EventsWithTagOf(double size_m) {
  DrawnCamera camera(3, PatternImage, 3);
  Witness witness;
  LiveSessionParts parts = LandingParts(&camera, &witness);
  parts.guides = true;
  parts.autopilot = "udpout://127.0.0.1:9";
  LiveSessionOptions options = SessionOptions();
  options.flight.guard.enabled = false;
  options.landing.target.kind = "apriltag";
  options.landing.target.apriltag.size_m = size_m;
  LiveSession(parts, options).Run([] { return false; });
  return witness.seen().events;
}

TEST(GuidedSession, SearchesWhereThePadIsSeen) {
  // The camera's focal length is 150 px; a tag with its margin takes 20 px, 10 cells of 8 in its
  // size.
  const std::string small = EventsWithTagOf(0.8);
  EXPECT_THAT(small, HasSubstr("sees the pad from 7.5 m at most"));
  EXPECT_THAT(small, HasSubstr("searches at 6.0 m, not at search_altitude_m 10, and out to 4.0 m"));
  EXPECT_THAT(small, Not(HasSubstr("limits.floor_m")));
  EXPECT_THAT(EventsWithTagOf(2), Not(HasSubstr("sees the pad")));
  EXPECT_THAT(EventsWithTagOf(0.2), HasSubstr("limits.floor_m 3 is above that"));
}

}  // namespace
}  // namespace kestrel
