// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/flight/guidance/go_guidance.h"

#include <algorithm>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "kestrel/core/base/error.h"
#include "kestrel/flight/guidance/test_flight.h"

namespace kestrel {
namespace {

using Phase = GuidancePhase;
using testing::HasSubstr;
using testing::ThrowsMessage;

const VehicleMotionOptions kAtRest{.path = "standing"};

GoJob Delivery() {
  GoJob job = ParseGoJob("pick");
  job.delivers = true;
  return job;
}

// Go guidance, a multicopter, an object, the wind, and a gripper that answers after a moment.
struct GoFlight : FlownInSteps<GoFlight> {
  explicit GoFlight(const std::string& job, const VehicleMotionOptions& motion = kAtRest,
                    const GuidanceOptions& options = {})
      : GoFlight(ParseGoJob(job), motion, options) {}
  explicit GoFlight(const GoJob& job, const VehicleMotionOptions& motion = kAtRest,
                    const GuidanceOptions& options = {})
      : guidance(options, job), uav({}, {6, -3, 10}), object(motion, 1) {
    Random random(3);
    wind = MakeWind({}, &random);
  }

  GuidanceInput Input() const {
    GuidanceInput input;
    input.now = TimeFromNanoseconds(0) + DurationFromSeconds(100 + time_s);
    input.uav = uav.State();
    input.target = object.Estimate(input.now, time_s);
    input.target_age_s = is_gone ? 1e3 : 0.05;
    if (is_gone) input.target.reset();
    input.mark = is_gone ? 0 : mark;
    input.box = box;
    input.others = others;
    input.gripper = gripper;
    input.is_guided = time_s > 0;
    input.is_armed = true;
    return input;
  }

  template <class Change>
  void Step(const Change& change) {
    GuidanceInput input = Input();
    change(input);
    output = guidance.Update(input);
    Answer();
    uav.Step(output.set_point, wind(time_s));
    time_s += kTestStep_s;
  }
  bool FlyUntilDone(double longest_s = 90) {
    return FlyUntil([&] { return guidance.is_done(); }, longest_s);
  }

  void Answer() {
    const bool is_grip =
        output.request == GuidanceRequest::kGrab || output.request == GuidanceRequest::kRelease;
    if (!is_grip) return;
    ++gripper.number;
    gripper.is_accepted = has_gripper;
    if (output.request == GuidanceRequest::kRelease) {
      released_at = uav.position();
      return;
    }
    ++grabs;
    grab_off_m = FromObject().head<2>().norm();
    grab_height_m = FromObject().z();
    if (grabs > misses) is_gone = true;
  }

  // Largest offset from the object until it is high above it.
  double ClimbOff() {
    double off_m = 0;
    EXPECT_TRUE(FlyUntil(
        [&] {
          off_m = std::max(off_m, FromObject().head<2>().norm());
          return FromObject().z() > 1.9;
        },
        10));
    return off_m;
  }

  Eigen::Vector3d FromObject() const {
    return uav.State().world_from_body * Eigen::Vector3d(0, 0, -0.35) - object.Position(time_s);
  }

  GoGuidance guidance;
  TestUav uav;
  TestTarget object;
  Path wind;
  GuidanceOutput output;
  GripperAnswers gripper;
  int mark = 7;
  std::optional<Eigen::Vector2d> box;
  std::vector<OtherUav> others;
  Eigen::Vector3d released_at{0, 0, 0};
  bool has_gripper = true;
  bool is_gone = false;
  int misses = 0;  // so many grabs leave the object where it is
  int grabs = 0;
  double grab_off_m = 1, grab_height_m = 1;
  double time_s = 0;
};

TEST(GoGuidanceTest, PicksObjectThatStands) {
  GoFlight flight("pick");
  ASSERT_TRUE(flight.FlyUntilDone()) << flight.output.reason;
  EXPECT_EQ(flight.grabs, 1);
  EXPECT_LT(flight.grab_off_m, 0.08);
  EXPECT_NEAR(flight.grab_height_m, 0.05, 0.06);
  EXPECT_THAT(flight.output.reason, HasSubstr("gone from the ground"));
  flight.FlyUntil([] { return false; }, 10);
  EXPECT_GT(flight.uav.position().z(), 9);  // at the height of the search again
}

TEST(GoGuidanceTest, PicksObjectThatMoves) {
  GoFlight flight("pick", {.path = "circle", .speed_mps = 1.4});
  ASSERT_TRUE(flight.FlyUntilDone()) << flight.output.reason;
  EXPECT_LT(flight.grab_off_m, 0.1);
  EXPECT_NEAR(flight.grab_height_m, 0.05, 0.08);
}

TEST(GoGuidanceTest, HoversAtTheHeightForTheTime) {
  GoFlight flight("hover,3,4");
  ASSERT_TRUE(flight.FlyUntilPhase(Phase::kAct));
  const double began_s = flight.time_s;
  double lowest_m = 10;
  ASSERT_TRUE(flight.FlyUntil([&] {
    lowest_m = std::min(lowest_m, flight.FromObject().z());
    return flight.guidance.is_done();
  }));
  EXPECT_NEAR(flight.time_s - began_s, 4, 0.1);
  EXPECT_NEAR(lowest_m, 3, 0.3);
}

TEST(GoGuidanceTest, DropsFromTheHeightOfTheJob) {
  GoFlight flight("drop,1");
  double released_m = 0;
  ASSERT_TRUE(flight.FlyUntil([&] {
    if (flight.output.request == GuidanceRequest::kRelease) released_m = flight.FromObject().z();
    return flight.guidance.is_done();
  }));
  EXPECT_NEAR(released_m, 1, 0.1);
}

TEST(GoGuidanceTest, TriesAgainWhenObjectIsStillThere) {
  GoFlight flight("pick");
  flight.misses = 2;
  ASSERT_TRUE(flight.FlyUntilDone(200)) << flight.output.reason;
  EXPECT_EQ(flight.grabs, 3);
}

TEST(GoGuidanceTest, GivesUpAfterAllTriesAndHigh) {
  GoFlight flight("pick");
  flight.misses = 100;
  ASSERT_TRUE(flight.FlyUntil([&] { return flight.guidance.has_given_up(); }, 400));
  EXPECT_EQ(flight.grabs, GoGuidance::kTries);
  EXPECT_THAT(flight.output.reason, HasSubstr("still there after all tries: gave up"));
  EXPECT_EQ(flight.output.request, GuidanceRequest::kHold);
  EXPECT_GT(flight.FromObject().z(), 1.9);
}

TEST(GoGuidanceTest, GivesUpHighAboveWhenThereIsNoGripper) {
  GoFlight flight("pick");
  flight.has_gripper = false;
  ASSERT_TRUE(flight.FlyUntil([&] { return flight.guidance.has_given_up(); }));
  EXPECT_THAT(flight.output.reason, HasSubstr("does not operate the gripper"));
  EXPECT_GT(flight.FromObject().z(), 5);
  EXPECT_EQ(flight.grabs, 0);
}

TEST(GoGuidanceTest, ClimbsAndSearchesWhenObjectIsLostNearTheGround) {
  GoFlight flight("pick");
  ASSERT_TRUE(flight.FlyUntil([&] { return flight.FromObject().z() < 1; }));
  flight.is_gone = true;
  flight.Step([](GuidanceInput&) {});
  EXPECT_EQ(flight.output.phase, Phase::kGoAround);
  EXPECT_TRUE(flight.FlyUntilPhase(Phase::kSearch, 10));
  EXPECT_GT(flight.FromObject().z(), 1.9);
  EXPECT_EQ(flight.grabs, 0);
}

TEST(GoGuidanceTest, LooksFromHigherWhenObjectIsOutOfSightAtTheGround) {
  GoFlight flight("pick");
  ASSERT_TRUE(flight.FlyUntil([&] { return flight.FromObject().z() < 0.4; }));
  const auto unseen = [](GuidanceInput& input) { input.target_age_s = 4; };
  flight.Step(unseen);
  EXPECT_EQ(flight.output.phase, Phase::kDescend);
  EXPECT_TRUE(flight.FlyUntil([&] { return flight.FromObject().z() > 0.7; }, 3, unseen));
  EXPECT_TRUE(flight.FlyUntilDone()) << flight.output.reason;
  EXPECT_EQ(flight.grabs, 1);
}

TEST(GoGuidanceTest, DoesNotGripWhereObjectIsNotKnownWellEnough) {
  GoFlight flight("pick");
  const auto vague = [](GuidanceInput& input) {
    input.target->motion.covariance.diagonal().head<3>().setConstant(0.1 * 0.1);
  };
  EXPECT_FALSE(flight.FlyUntil([&] { return flight.grabs > 0; }, 40, vague));
  EXPECT_TRUE(flight.FlyUntilDone()) << flight.output.reason;
}

TEST(GoGuidanceTest, AnotherObjectDoesNotDrawItAwayNearTheGround) {
  GoFlight flight("pick");
  ASSERT_TRUE(flight.FlyUntil([&] { return flight.FromObject().z() < 1; }));
  flight.Step([](GuidanceInput& input) { input.mark = 8; });
  EXPECT_EQ(flight.output.phase, Phase::kGoAround);
}

TEST(GoGuidanceTest, UnseenObjectIsNotGoneWhileNoImagesCome) {
  GoFlight flight("pick");
  ASSERT_TRUE(flight.FlyUntilPhase(Phase::kLook)) << flight.output.reason;
  const auto blind = [](GuidanceInput& input) { input.is_camera_up = false; };
  EXPECT_FALSE(flight.FlyUntil([&] { return flight.guidance.is_done(); }, 5, blind));
}

TEST(GoGuidanceTest, OnlyGrippersComeDownToTheDeck) {
  for (const auto& [job, comes_down] :
       {std::pair("hover", false), {"look", false}, {"drop,1", false}, {"pick", true}}) {
    GoFlight flight(job);
    ASSERT_TRUE(flight.FlyUntilPhase(Phase::kCommit)) << job;
    EXPECT_EQ(flight.guidance.is_at_deck(), comes_down) << job;
    ASSERT_TRUE(flight.FlyUntilPhase(Phase::kAct)) << job;
    EXPECT_EQ(flight.guidance.is_at_deck(), comes_down) << job;
  }
}

TEST(GoGuidanceTest, ClimbsWithObjectAlthoughAutopilotReportsGround) {
  GoFlight flight("pick");
  ASSERT_TRUE(flight.FlyUntil([&] { return flight.grabs == 1; })) << flight.output.reason;
  const auto landed = [](GuidanceInput& input) { input.is_landed = true; };
  EXPECT_TRUE(flight.FlyUntil([&] { return flight.output.phase == Phase::kGoAround; }, 3, landed));
  flight.Step(landed);
  EXPECT_EQ(flight.output.phase, Phase::kGoAround) << flight.output.reason;
  EXPECT_TRUE(flight.FlyUntilDone()) << flight.output.reason;
}

TEST(GoGuidanceTest, EachTryFromAHighJobHasItsTime) {
  GoFlight flight("drop,1.5");
  ASSERT_TRUE(flight.FlyUntil([&] { return flight.FromObject().z() < 2.3; }));
  const auto hardly_seen = [](GuidanceInput& input) { input.target_age_s = 1; };
  ASSERT_FALSE(flight.FlyUntil([&] { return flight.guidance.has_given_up(); }, 22, hardly_seen));
  EXPECT_TRUE(flight.FlyUntilDone()) << flight.output.reason;
}

TEST(GoGuidanceTest, EndsAtOnceWhenPilotTakesBack) {
  GoFlight flight("pick");
  ASSERT_TRUE(flight.FlyUntilPhase(Phase::kDescend));
  flight.Step([](GuidanceInput& input) { input.is_guided = false; });
  EXPECT_FALSE(flight.output.set_point);
  EXPECT_EQ(flight.output.phase, Phase::kIdle);
}

TEST(GoGuidanceTest, ObjectOutsideOfGeofenceIsGivenUp) {
  GuidanceOptions options;
  options.limits.geofence_radius_m = 4;
  GoFlight flight("pick", kAtRest, options);
  ASSERT_TRUE(flight.FlyUntil([&] { return flight.guidance.has_given_up(); }, 5));
  EXPECT_THAT(flight.output.reason, HasSubstr("outside of the geofence"));
}

TEST(GoGuidanceTest, TakesObjectToBoxAndGoesOnToNextOne) {
  GoFlight flight(Delivery());
  flight.box = {{15, -8}};
  ASSERT_TRUE(flight.FlyUntil([&] { return flight.guidance.ended().mark == 7; }, 90));
  EXPECT_TRUE(flight.guidance.ended().is_taken);
  EXPECT_FALSE(flight.guidance.wants_object());
  ASSERT_TRUE(flight.FlyUntil([&] { return flight.guidance.wants_object(); }, 60));
  EXPECT_LT((flight.released_at.head<2>() - *flight.box).norm(), 0.5);
  EXPECT_LT(flight.released_at.z(), 3.5);
  flight.is_gone = false;
  flight.mark = 8;
  flight.misses = 1;  // the next grab takes it
  ASSERT_TRUE(flight.FlyUntil([&] { return flight.grabs == 2; }, 90)) << flight.output.reason;
}

TEST(GoGuidanceTest, LeavesObjectThatItDoesNotGetAndGoesOn) {
  GoFlight flight(Delivery());
  flight.box = {{15, -8}};
  flight.misses = 100;
  ASSERT_TRUE(flight.FlyUntil([&] { return flight.guidance.ended().mark == 7; }, 400));
  EXPECT_FALSE(flight.guidance.ended().is_taken);
  EXPECT_FALSE(flight.guidance.has_given_up());
  EXPECT_EQ(flight.grabs, GoGuidance::kTries);
  flight.FlyUntil([] { return false; }, 5);
  EXPECT_EQ(flight.output.phase, Phase::kSearch);  // although the vision still sees it
}

TEST(GoGuidanceTest, GivesWayNearTheGround) {
  GoFlight flight("pick");
  ASSERT_TRUE(flight.FlyUntilPhase(Phase::kDescend));
  flight.others = {{.position = flight.uav.position().head<2>() + Eigen::Vector2d(4, 0)}};
  flight.Step([](GuidanceInput&) {});
  EXPECT_EQ(flight.output.phase, Phase::kDescend);
  flight.others[0].goes_first = true;
  EXPECT_FALSE(flight.FlyUntilPhase(Phase::kCommit, 10));
  EXPECT_GT((flight.uav.position().head<2>() - flight.others[0].position).norm(), 5.5);
  EXPECT_GT(flight.uav.position().z(), 8);
  flight.others.clear();
  EXPECT_TRUE(flight.FlyUntilDone()) << flight.output.reason;
}

TEST(GoGuidanceTest, OnItsWayGivesWayAtEachHeight) {
  GoFlight flight("pick");
  ASSERT_TRUE(flight.FlyUntilPhase(Phase::kApproach));
  flight.uav = TestUav({}, flight.object.Position(0) + Eigen::Vector3d(0, -5, 1.5));
  flight.others = {
      {.position = flight.uav.position().head<2>() + Eigen::Vector2d(0, 4), .goes_first = true}};
  flight.Step([](GuidanceInput&) {});
  EXPECT_EQ(flight.output.phase, Phase::kApproach);
  EXPECT_LT(flight.output.set_point->velocity.y(), 0);
}

TEST(GoGuidanceTest, ClimbsBeforeItGivesWayOnTheGround) {
  GoFlight flight("pick");
  ASSERT_TRUE(flight.FlyUntil([&] { return flight.FromObject().z() < 0.3; }));
  flight.others = {
      {.position = flight.uav.position().head<2>() + Eigen::Vector2d(4, 0), .goes_first = true}};
  EXPECT_LT(flight.ClimbOff(), 0.2);
  EXPECT_EQ(flight.grabs, 0);
  flight.FlyUntil([] { return false; }, 10);
  EXPECT_GT((flight.uav.position().head<2>() - flight.others[0].position).norm(), 5.5);
}

TEST(GoGuidanceTest, KeepsTheObjectInTheGripperWhenAnotherUavComes) {
  GoFlight flight(Delivery());
  flight.box = {{15, -8}};
  ASSERT_TRUE(flight.FlyUntil([&] { return flight.grabs == 1; }));
  flight.others = {
      {.position = flight.uav.position().head<2>() + Eigen::Vector2d(4, 0), .goes_first = true}};
  const double released_m = flight.released_at.z();  // before the pick
  flight.FlyUntil([] { return false; }, 15);
  EXPECT_FALSE(flight.guidance.ended().is_taken) << "it does not see whether the object is gone";
  flight.others.clear();
  ASSERT_TRUE(flight.FlyUntil([&] { return flight.guidance.ended().is_taken; }, 30));
  EXPECT_EQ(flight.grabs, 1);
  EXPECT_EQ(flight.released_at.z(), released_m);
}

TEST(GoGuidanceTest, MovesAwayAtWorkFromUavThatGoesFirst) {
  GoFlight flight(Delivery());
  flight.box = {{15, -8}};
  ASSERT_TRUE(flight.FlyUntil([&] { return flight.guidance.ended().mark == 7; }));
  ASSERT_TRUE(flight.FlyUntil(
      [&] { return flight.guidance.is_at_work() && flight.uav.position().z() < 6; }));
  const Eigen::Vector3d before = flight.released_at;
  flight.others = {{.position = *flight.box + Eigen::Vector2d(4, 0), .goes_first = true}};
  flight.FlyUntil([] { return false; }, 10);
  EXPECT_EQ(flight.released_at, before);
  EXPECT_GT((flight.uav.position().head<2>() - flight.others[0].position).norm(), 5.5);
  EXPECT_GT(flight.uav.position().z(), 8);
  flight.others.clear();
  ASSERT_TRUE(flight.FlyUntil([&] { return flight.guidance.wants_object(); }, 60));
  EXPECT_LT((flight.released_at.head<2>() - *flight.box).norm(), 0.5);
}

TEST(GoGuidanceTest, PickThatIsDoneIsReported) {
  GoFlight flight("pick");
  EXPECT_TRUE(flight.guidance.wants_object());
  ASSERT_TRUE(flight.FlyUntilDone());
  EXPECT_FALSE(flight.guidance.wants_object());
  EXPECT_EQ(flight.guidance.ended().mark, 7);
  EXPECT_TRUE(flight.guidance.ended().is_taken);
}

TEST(GoGuidanceTest, GoesOnFromObjectThatIsNotSeenFromAbove) {
  GoFlight flight("pick");
  const auto unseen = [](GuidanceInput& input) { input.target_age_s = 1e3; };
  const auto leaves = [&] { return flight.guidance.ended().mark == 7; };
  EXPECT_FALSE(flight.FlyUntil(leaves, 60, [&](GuidanceInput& input) {
    unseen(input);
    input.is_camera_up = static_cast<int>(10 * flight.time_s) % 40 > 0;  // now and then
  }));
  ASSERT_TRUE(flight.FlyUntil(leaves, 10, unseen));
  EXPECT_FALSE(flight.guidance.ended().is_taken);
  EXPECT_FALSE(flight.guidance.has_given_up());
}

TEST(GoGuidanceTest, ObjectInTheBoxIsLeft) {
  GoFlight flight(Delivery());
  flight.box = flight.object.Position(0).head<2>() + Eigen::Vector2d(1, 0);
  ASSERT_TRUE(flight.FlyUntil([&] { return flight.guidance.ended().mark == 7; }, 2));
  EXPECT_FALSE(flight.guidance.ended().is_taken);
}

TEST(GoGuidanceTest, BoxOutsideOfGeofenceIsGivenUp) {
  GoFlight flight(Delivery());
  flight.box = {{120, 0}};
  ASSERT_TRUE(flight.FlyUntil([&] { return flight.guidance.has_given_up(); }, 1));
  EXPECT_THAT(flight.output.reason, HasSubstr("the box is outside of the geofence"));
}

TEST(GoGuidanceTest, DeliversInLayerAboveTheCeilingAndWithoutLegs) {
  GuidanceOptions options;
  options.leg_m = 0;
  options.limits.ceiling_m = 11;
  GoFlight flight(Delivery(), kAtRest, options);
  flight.box = {{15, -8}};
  double highest_m = 0;
  ASSERT_TRUE(flight.FlyUntil([&] { return flight.guidance.ended().is_taken; }));
  const auto high = [](GuidanceInput& input) { input.layer = 4; };
  ASSERT_TRUE(flight.FlyUntil(
      [&] {
        highest_m = std::max(highest_m, flight.uav.position().z());
        return flight.guidance.wants_object();
      },
      90, high))
      << flight.output.reason;
  EXPECT_LT(highest_m, 11.2);
}

TEST(GoGuidanceTest, TravelsInItsLayer) {
  GoFlight flight("hover");
  const auto above = [](GuidanceInput& input) {
    input.layer = 2;
    input.target.reset();
  };
  flight.FlyUntil([] { return false; }, 15, above);
  EXPECT_NEAR(flight.uav.position().z(), 10 + 3 + 0.35, 0.2);
}

// A place is a target that is always seen, and stands.
TEST(GoGuidanceTest, DropsAbovePlaceNoLowerThanTheFloor) {
  GoJob job = ParseGoJob("drop,2.7");
  job.target = GoTarget::kPlace;
  GoFlight flight(job);
  double lowest_m = 10;
  ASSERT_TRUE(flight.FlyUntil([&] {
    lowest_m = std::min(lowest_m, flight.FromObject().z());
    return flight.guidance.is_done();
  })) << flight.output.reason;
  EXPECT_GT(flight.released_at.z(), 3);
  EXPECT_LT((flight.released_at - flight.object.Position(0)).head<2>().norm(), 0.12);
  EXPECT_NEAR(lowest_m, 2.7, 0.2);
  EXPECT_FALSE(flight.guidance.is_at_deck());
}

TEST(GoGuidanceTest, PlaceIsNothingToPickUpOrToComeDownOn) {
  GoJob job = ParseGoJob("pick");
  job.target = GoTarget::kPlace;
  EXPECT_THAT([&] { GoGuidance({}, job); }, ThrowsMessage<InputError>(HasSubstr("pick: expected")));
  job.action = GoAction::kDrop;
  EXPECT_THAT([&] { GoGuidance({}, job); },
              ThrowsMessage<InputError>(HasSubstr("expected at least 2.65")));
}

TEST(GoGuidanceTest, MarkedThingNeedsConfirmation) {
  GoJob job = ParseGoJob("hover,2.5,3");
  job.target = GoTarget::kMarked;
  GoFlight flight(job);
  const Eigen::Vector3d began = flight.uav.position();
  flight.FlyUntil([] { return false; }, 5);
  EXPECT_EQ(flight.guidance.phase(), Phase::kLook);
  EXPECT_LT((flight.uav.position() - began).norm(), 0.5);
  const auto order = [&](int number, int mark) {
    return [number, mark](GuidanceInput& input) { input.order = {number, mark}; };
  };
  flight.FlyUntil([] { return false; }, 1, order(1, 6));
  EXPECT_THAT(flight.output.reason, HasSubstr("something else is marked"));
  flight.FlyUntil([] { return false; }, 2, order(2, 7));
  EXPECT_EQ(flight.guidance.phase(), Phase::kApproach);
  flight.FlyUntil([] { return false; }, 2, order(3, 0));
  EXPECT_THAT(flight.output.reason, HasSubstr("was stopped"));
  ASSERT_TRUE(flight.FlyUntil([&] { return flight.guidance.is_done(); }, 60, order(4, 7)))
      << flight.output.reason;
  flight.mark = 8;
  flight.FlyUntil([] { return false; }, 1, order(4, 7));
  EXPECT_THAT(flight.output.reason, HasSubstr("something else is marked"));
  EXPECT_TRUE(
      flight.FlyUntil([&] { return flight.guidance.phase() == Phase::kAct; }, 60, order(5, 8)));
}

TEST(GoGuidanceTest, MarkedThingThatJumpsNeedsConfirmation) {
  GoJob job = ParseGoJob("hover,2.5,3");
  job.target = GoTarget::kMarked;
  GoFlight flight(job);
  flight.FlyUntil([] { return false; }, 1);
  const auto order = [](GuidanceInput& input) { input.order = {1, 7}; };
  ASSERT_TRUE(
      flight.FlyUntil([&] { return flight.guidance.phase() == Phase::kDescend; }, 30, order));
  flight.FlyUntil([] { return false; }, 1,
                  [&](GuidanceInput& input) {
                    order(input);
                    input.target->motion.mean.head<2>() += Eigen::Vector2d(5, 0);
                  });
  EXPECT_EQ(flight.guidance.phase(), Phase::kLook);
  EXPECT_THAT(flight.output.reason, HasSubstr("where it cannot be"));
}

TEST(GoGuidanceTest, HoversNoNearerToUavThatGivesWay) {
  GoFlight flight("hover,3,60", {.path = "straight", .speed_mps = 1});
  ASSERT_TRUE(flight.FlyUntilPhase(Phase::kAct));
  const Eigen::Vector3d drive =
      flight.object.Position(flight.time_s + 1) - flight.object.Position(flight.time_s);
  flight.others = {{.position = flight.uav.position().head<2>() + 10 * drive.head<2>()}};
  double nearest_m = 10;
  flight.FlyUntil(
      [&] {
        const Eigen::Vector2d way = flight.others[0].position - flight.uav.position().head<2>();
        nearest_m = std::min(nearest_m, way.norm());
        return false;
      },
      20);
  EXPECT_GT(nearest_m, 3);  // gusts push it
}

TEST(GoGuidanceTest, DoneNearTheGroundClimbsBeforeItGivesWay) {
  GoFlight flight("hover,0.3,1");
  ASSERT_TRUE(flight.FlyUntilDone());
  flight.others = {
      {.position = flight.uav.position().head<2>() + Eigen::Vector2d(4, 0), .goes_first = true}};
  EXPECT_LT(flight.ClimbOff(), 0.2);
}

TEST(GoGuidanceTest, LostMarkedThingIsNotSearchedFor) {
  GoJob job = ParseGoJob("hover,2.5,3");
  job.target = GoTarget::kMarked;
  GoFlight flight(job);
  const auto order = [](GuidanceInput& input) { input.order = {1, 7}; };
  flight.FlyUntil([] { return false; }, 1);
  flight.FlyUntil([] { return false; }, 2, order);
  flight.is_gone = true;
  flight.mark = 7;
  flight.FlyUntil([] { return false; }, 2,
                  [&](GuidanceInput& input) {
                    order(input);
                    input.mark = 7;
                  });
  EXPECT_EQ(flight.guidance.phase(), Phase::kLook);
  EXPECT_THAT(flight.output.reason, HasSubstr("what is marked is lost"));
}

TEST(GoGuidanceTest, MarkedThingThatIsNotSeenIsNotConfirmed) {
  GoJob job = ParseGoJob("hover,2.5,3");
  job.target = GoTarget::kMarked;
  GoFlight flight(job);
  flight.FlyUntil([] { return false; }, 1);
  flight.FlyUntil([] { return false; }, 1,
                  [](GuidanceInput& input) {
                    input.order = {1, 7};
                    input.target_age_s = 2;
                  });
  EXPECT_THAT(flight.output.reason, HasSubstr("is not seen"));
}

TEST(GoGuidanceTest, OtherObjectBesideIsNotTheOneThatWasTaken) {
  GoFlight flight("pick", {.path = "circle", .speed_mps = 1.4});
  const auto show_other = [&](GuidanceInput& input) {
    if (flight.grabs == 0 || flight.guidance.phase() == Phase::kAct) return;
    input.target = flight.object.Estimate(input.now, flight.time_s);
    input.target->motion.mean.head<2>() += Eigen::Vector2d(3, 3);
    input.target_age_s = 0.05;
    input.mark = 7;
  };
  ASSERT_TRUE(flight.FlyUntil([&] { return flight.guidance.is_done(); }, 90, show_other))
      << flight.output.reason;
  EXPECT_EQ(flight.grabs, 1);
}

TEST(GoGuidanceTest, RisesNoHigherThanItsLayerWhileItSeesNothing) {
  GoFlight flight("hover,2,3");
  ASSERT_TRUE(flight.FlyUntilPhase(Phase::kDescend)) << flight.output.reason;
  double highest_m = 0;
  flight.FlyUntil(
      [&] {
        highest_m = std::max(highest_m, flight.uav.position().z());
        return false;
      },
      20, [](GuidanceInput& input) { input.target_age_s = 60; });
  EXPECT_LT(highest_m, GuidanceOptions().search_altitude_m + 1);
}

TEST(GoGuidanceTest, SearchBeyondTheLimitsIsRefused) {
  GuidanceOptions options;
  options.search_radius_m = 200;
  EXPECT_THAT([&] { GoGuidance(options, {}); },
              ThrowsMessage<InputError>(HasSubstr("expected at most 100 (limits.geofence")));
  EXPECT_THAT([&] { GoGuidance({}, ParseGoJob("hover,12")); },
              ThrowsMessage<InputError>(HasSubstr("expected at most 10")));
}

TEST(GoJobTest, IsReadWithHeightAndTime) {
  EXPECT_EQ(ParseGoJob("pick").action, GoAction::kPick);
  const GoJob job = ParseGoJob("look,4.5,30");
  EXPECT_EQ(job.action, GoAction::kLook);
  EXPECT_EQ(job.height_m, 4.5);
  EXPECT_EQ(job.seconds, 30);
  for (const char* wrong : {"", "dance", "hover,x", "hover,-1", "hover,1,2,3", "pick,nan"}) {
    EXPECT_THAT([&] { ParseGoJob(wrong); },
                ThrowsMessage<InputError>(HasSubstr("expected hover, look, drop or pick")))
        << wrong;
  }
}

}  // namespace
}  // namespace kestrel
