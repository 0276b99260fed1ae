// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/flight/guidance/follow_guidance.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "kestrel/core/base/error.h"
#include "kestrel/core/geometry/angles.h"
#include "kestrel/core/poses/gravity.h"
#include "kestrel/flight/guidance/test_flight.h"

namespace kestrel {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;
using Phase = GuidancePhase;
using testing::HasSubstr;

constexpr double kDistance_m = 12, kHeight_m = 8;

const VehicleMotionOptions kWalker{.path = "stops", .speed_mps = 1.4};
const VehicleMotionOptions kCar{.path = "figure8", .speed_mps = 4.2};
const VehicleMotionOptions kStanding{.path = "standing"};

CameraIntrinsics Lens() {
  return {640, 480, 416, 416, 319.5, 239.5, DistortionModel::kNone, {}};  // 60 degrees high
}

// A camera that looks ahead and down, fixed to the body.
RigidTransform BodyFromCamera(double down_deg) {
  Eigen::Matrix3d axes;
  axes << 0, 0, 1, -1, 0, 0, 0, -1, 0;
  RigidTransform body_from_camera;
  body_from_camera.rotation =
      Eigen::AngleAxisd(Radians(down_deg), Vector3d::UnitY()) * Eigen::Quaterniond(axes);
  return body_from_camera;
}

ViewLimits FixedView() { return {Lens(), BodyFromCamera(35)}; }

// Follow guidance, a multicopter whose nose obeys, something that moves on the ground, and wind.
struct FollowFlight {
  explicit FollowFlight(const GuidanceOptions& options = {},
                        const VehicleMotionOptions& motion = kStanding,
                        const TestUavOptions& uav_options = {},
                        const std::optional<ViewLimits>& view = std::nullopt)
      : guidance(options, view), uav(uav_options, {20, 3, 12}), target(motion, 1) {
    Random random(7);
    wind = MakeWind({}, &random);
  }

  GuidanceInput Input() const {
    GuidanceInput input;
    input.now = TimeFromNanoseconds(0) + DurationFromSeconds(100 + time_s);
    input.uav = uav.State();
    const Vector3d up = input.uav->world_from_body.rotation * Vector3d::UnitZ();
    input.uav->world_from_body.rotation = MulticopterAttitude(up, yaw);
    input.target = target.Estimate(input.now, time_s, 0.3);
    input.target_age_s = 0.05;
    input.mark = 1;
    input.order = order;
    input.is_guided = time_s > 0;
    input.is_armed = true;
    return input;
  }
  template <class Change>
  void Fly(double seconds, const Change& change) {
    for (const double end_s = time_s + seconds; time_s < end_s;) {
      GuidanceInput input = Input();
      change(input);
      output = guidance.Update(input);
      if (output.set_point) yaw = output.set_point->yaw.value_or(yaw);
      uav.Step(output.set_point, wind(time_s));
      time_s += kTestStep_s;
      lowest_m = std::min(lowest_m, Height());
      nearest_m = std::min(nearest_m, Distance());
      ++steps;
      good += std::abs(Distance() - kDistance_m) < 0.1 * kDistance_m ? 1 : 0;
      seen += Sees() ? 1 : 0;
    }
  }
  void Fly(double seconds) {
    Fly(seconds, [](GuidanceInput&) {});
  }
  void Confirm() { order = {order.number + 1, 1}; }
  void StopOrder() { order = {order.number + 1, 0}; }
  // Follows, after a confirmation.
  void Follow() {
    Fly(1);
    Confirm();
    Fly(30);
    EXPECT_EQ(output.phase, Phase::kFollow) << output.reason;
    steps = good = seen = 0;
  }

  Vector2d Way() const { return (target.Position(time_s) - uav.position()).head<2>(); }
  double Distance() const { return Way().norm(); }
  double Height() const { return uav.position().z() - target.Position(time_s).z(); }
  double Speed() const { return uav.velocity().norm(); }
  bool Sees() const {
    const GuidanceInput input = Input();
    Vector2d pixel;
    const RigidTransform world_from_camera = input.uav->world_from_body * BodyFromCamera(35);
    return CameraModel(Lens()).Project(world_from_camera.Inverse() * target.Position(time_s),
                                       &pixel) == ProjectionStatus::kOk;
  }
  double share() const { return static_cast<double>(good) / steps; }

  FollowGuidance guidance;
  TestUav uav;
  TestTarget target;
  Path wind;
  GuidanceOutput output;
  FollowOrder order;
  double yaw = 0;
  double time_s = 0;
  double lowest_m = 1e9, nearest_m = 1e9;
  int steps = 0, good = 0, seen = 0;
};

void Lose(GuidanceInput& input) {
  input.target.reset();
  input.target_age_s = 99;
}

TEST(FollowGuidanceTest, LooksUntilConfirmed) {
  FollowFlight flight;
  const Vector3d began = flight.uav.position();
  flight.Fly(8);
  EXPECT_EQ(flight.output.phase, Phase::kLook);
  EXPECT_LT((flight.uav.position() - began).norm(), 0.5);
  const Vector2d way = flight.Way();
  EXPECT_NEAR(std::remainder(flight.yaw - std::atan2(way.y(), way.x()), 2 * kPi), 0, 0.05);
  flight.Confirm();
  flight.Fly(20);
  EXPECT_EQ(flight.output.phase, Phase::kFollow);
  EXPECT_NEAR(flight.Distance(), kDistance_m, 0.5);
  EXPECT_NEAR(flight.Height(), kHeight_m, 0.3);
}

TEST(FollowGuidanceTest, OrderBeforeModeIsVoid) {
  FollowFlight flight;
  flight.Confirm();
  flight.Fly(5);
  EXPECT_EQ(flight.output.phase, Phase::kLook);
}

struct FollowCase {
  const char* name;
  VehicleMotionOptions motion;
  TestUavOptions uav;
  const char* side;
};
class FollowCaseTest : public testing::TestWithParam<FollowCase> {};
INSTANTIATE_TEST_SUITE_P(
    All, FollowCaseTest,
    testing::Values(FollowCase{"WalkerFree", kWalker, TestUavOptions::ArduCopter(), "free"},
                    FollowCase{"WalkerBehind", kWalker, TestUavOptions::Px4(), "behind"},
                    FollowCase{"WalkerNorth", kWalker, TestUavOptions::Px4(), "0"},
                    FollowCase{"CarFree", kCar, TestUavOptions::Px4(), "free"},
                    FollowCase{"CarSouth", kCar, TestUavOptions::Px4(), "180"},
                    FollowCase{"SlowCarFree",
                               {.path = "figure8", .speed_mps = 3},
                               TestUavOptions::ArduCopter(),
                               "free"}),
    [](const auto& info) { return std::string(info.param.name); });

TEST_P(FollowCaseTest, KeepsDistanceAndHeight) {
  GuidanceOptions options;
  options.follow.side = GetParam().side;
  options.model.control = GetParam().uav.Control();
  FollowFlight flight(options, GetParam().motion, GetParam().uav);
  flight.Follow();
  flight.Fly(60);
  RecordProperty("share", std::to_string(flight.share()));
  EXPECT_GT(flight.share(), 0.95);
  EXPECT_GT(flight.lowest_m, kHeight_m - 0.4);
}

TEST(FollowGuidanceTest, StaysOnSideAskedFor) {
  GuidanceOptions options;
  options.follow.side = "270";
  FollowFlight west(options, kWalker);
  west.Follow();
  EXPECT_GT(west.Way().x(), 0.9 * kDistance_m);
  options.follow.side = "behind";
  FollowFlight behind(options, {.path = "straight", .speed_mps = 2});
  behind.Follow();
  const Vector2d ahead = behind.target.Velocity(behind.time_s).head<2>().normalized();
  EXPECT_GT(behind.Way().dot(ahead), 0.9 * kDistance_m);
}

TEST(FollowGuidanceTest, FliesAroundTargetToItsOtherSide) {
  GuidanceOptions options;
  options.follow.side = "270";
  FollowFlight flight(options);
  flight.Follow();
  EXPECT_GT(flight.Way().x(), 0.9 * kDistance_m);
  EXPECT_GT(flight.nearest_m, 0.8 * kDistance_m);
}

TEST(FollowGuidanceTest, FixedCameraKeepsFastCarInView) {
  GuidanceOptions options;
  options.limits.max_tilt_deg = 45;
  options.model.control = TestUavOptions::Px4().Control();
  const VehicleMotionOptions car{.path = "figure8", .speed_mps = 8.33, .radius_m = 26};
  FollowFlight flight(options, car, TestUavOptions::Px4(), FixedView());
  flight.Follow();
  flight.Fly(60);
  RecordProperty("share", std::to_string(flight.share()));
  EXPECT_EQ(flight.seen, flight.steps);
  EXPECT_GT(flight.share(), 0.8);  // in the curves the view limits the lean, and it trails
}

// Returns the largest change of the commanded velocity in the first seconds of an approach, m/s^2.
double LargestChange(const std::optional<ViewLimits>& view) {
  FollowFlight flight({}, kStanding, {}, view);
  flight.Fly(1);
  flight.Confirm();
  double largest = 0;
  for (Vector3d before = flight.output.set_point->velocity; flight.time_s < 3;) {
    flight.Fly(kTestStep_s);
    const Vector3d change = flight.output.set_point->velocity - before;
    largest = std::max(largest, change.head<2>().norm() / kTestStep_s);
    before = flight.output.set_point->velocity;
  }
  return largest;
}

TEST(FollowGuidanceTest, FixedCameraLimitsLean) {
  const ViewLimits::Leans leans = FixedView().LeansFor(20, 10);
  constexpr double kAir = 1.5;  // m/s^2: the lean against the air may help
  EXPECT_LT(LargestChange(FixedView()),
            kGravity * std::hypot(std::tan(leans.forward), std::tan(leans.side)) + kAir);
  EXPECT_GT(LargestChange(std::nullopt), 20);
}

TEST(FollowGuidanceTest, CoastsForOneSecondThenStops) {
  FollowFlight flight({}, {.path = "straight", .speed_mps = 3});
  flight.Follow();
  const double lost_s = flight.time_s;
  const auto lose = [&](GuidanceInput& input) { input.target_age_s = flight.time_s - lost_s; };
  flight.Fly(0.9, lose);
  EXPECT_EQ(flight.output.phase, Phase::kFollow);
  EXPECT_GT(flight.Speed(), 2.5);
  flight.Fly(3, lose);
  EXPECT_EQ(flight.output.phase, Phase::kLook);
  EXPECT_LT(flight.Speed(), 0.5);
  EXPECT_EQ(flight.output.request, GuidanceRequest::kNone);
}

TEST(FollowGuidanceTest, GoesOnWhenFoundAgainInTime) {
  FollowFlight flight;
  flight.Follow();
  flight.Fly(9, Lose);
  EXPECT_EQ(flight.output.phase, Phase::kLook);
  flight.Fly(0.1);
  EXPECT_EQ(flight.output.phase, Phase::kFollow);
}

TEST(FollowGuidanceTest, LongLossNeedsNewConfirmation) {
  FollowFlight flight;
  flight.Follow();
  flight.Fly(11, Lose);
  flight.Fly(5);
  EXPECT_EQ(flight.output.phase, Phase::kLook);
  EXPECT_THAT(flight.output.reason, HasSubstr("new confirmation"));
  flight.Confirm();
  flight.Fly(1);
  EXPECT_EQ(flight.output.phase, Phase::kFollow);
}

// Whatever the tracker finds 7 m farther on after 1.4 s is not the person who has stood there.
TEST(FollowGuidanceTest, ThatFoundTooFarAwayNeedsNewConfirmation) {
  FollowFlight flight;
  const auto find_again = [&](double distance_m) {
    flight.Fly(1.4, Lose);
    flight.Fly(3, [&](GuidanceInput& input) { input.target->motion.mean.x() += distance_m; });
  };
  flight.Follow();
  find_again(2);
  EXPECT_EQ(flight.output.phase, Phase::kFollow);
  flight.Follow();
  const Vector3d before = flight.uav.position();
  find_again(7);
  EXPECT_EQ(flight.output.phase, Phase::kLook);
  EXPECT_THAT(flight.output.reason, HasSubstr("where it cannot be"));
  EXPECT_LT((flight.uav.position() - before).norm(), 0.5);
  flight.Confirm();
  flight.Fly(1);
  EXPECT_NE(flight.output.phase, Phase::kLook);
}

TEST(FollowGuidanceTest, NewMarkNeedsConfirmation) {
  FollowFlight flight;
  flight.Follow();
  const auto other = [](GuidanceInput& input) { input.mark = 2; };
  flight.Fly(1, other);
  EXPECT_EQ(flight.output.phase, Phase::kLook);
  flight.Confirm();  // for the first one: it came too late
  flight.Fly(1, other);
  EXPECT_EQ(flight.output.phase, Phase::kLook);
  EXPECT_THAT(flight.output.reason, HasSubstr("something else is marked"));
  flight.order = {flight.order.number + 1, 2};
  flight.Fly(1, other);
  EXPECT_EQ(flight.output.phase, Phase::kFollow);
}

TEST(FollowGuidanceTest, StopsOnOrder) {
  FollowFlight flight({}, kWalker);
  flight.Follow();
  flight.StopOrder();
  flight.Fly(5);
  EXPECT_EQ(flight.output.phase, Phase::kLook);
  EXPECT_LT(flight.Speed(), 0.3);
}

TEST(FollowGuidanceTest, UncertainPlaceIsRefused) {
  FollowFlight flight;
  const auto uncertain = [&](GuidanceInput& input) {
    input.target = flight.target.Estimate(input.now, flight.time_s, 0.25 * kDistance_m);
  };
  flight.Fly(1, uncertain);
  flight.Confirm();
  flight.Fly(5, uncertain);
  EXPECT_EQ(flight.output.phase, Phase::kLook);
  EXPECT_THAT(flight.output.reason, HasSubstr("refused"));
  flight.Fly(5);
  EXPECT_EQ(flight.output.phase, Phase::kLook) << "that confirmation is void";
}

TEST(FollowGuidanceTest, ModeTakenBackEndsAndNeedsNewConfirmation) {
  FollowFlight flight;
  flight.Follow();
  flight.Fly(0.1, [](GuidanceInput& input) { input.is_guided = false; });
  EXPECT_FALSE(flight.output.set_point);
  flight.Fly(5);
  EXPECT_EQ(flight.output.phase, Phase::kLook);
}

TEST(FollowGuidanceTest, GivesUpWithoutPoses) {
  FollowFlight flight;
  flight.Follow();
  const auto blind = [](GuidanceInput& input) { input.uav.reset(); };
  flight.Fly(0.5, blind);
  EXPECT_EQ(flight.output.set_point->velocity, Vector3d(0, 0, 0));
  flight.Fly(1, blind);
  EXPECT_EQ(flight.output.request, GuidanceRequest::kHold);
  EXPECT_TRUE(flight.guidance.has_given_up());
}

TEST(FollowGuidanceTest, StopsWithoutNewImages) {
  FollowFlight flight({}, kWalker);
  flight.Follow();
  flight.Fly(5, [](GuidanceInput& input) { input.is_camera_up = false; });
  EXPECT_EQ(flight.output.phase, Phase::kLook);
  EXPECT_LT(flight.Speed(), 0.3);
}

std::string ErrorOf(const GuidanceOptions& options, const std::optional<ViewLimits>& view) {
  try {
    FollowGuidance guidance(options, view);
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

TEST(FollowGuidanceTest, RejectsPlaceItCannotFollowFrom) {
  GuidanceOptions options;
  EXPECT_EQ(ErrorOf(options, FixedView()), "");
  EXPECT_THAT(ErrorOf(options, ViewLimits(Lens(), BodyFromCamera(90))), HasSubstr("34 degrees"));
  options.follow.side = "left";
  EXPECT_THAT(ErrorOf(options, {}), HasSubstr("side is 'left', expected free, behind, or degrees"));
  options.follow = {.height_m = 31};
  EXPECT_THAT(ErrorOf(options, {}), HasSubstr("follow.height_m is 31, expected 3"));
}

TEST(ViewLimitsTest, LeansUntilTargetLeavesImage) {
  const ViewLimits::Leans leans = FixedView().LeansFor(12, 8);  // 33.7 degrees down
  EXPECT_NEAR(Degrees(leans.forward), 23, 2);
  EXPECT_NEAR(Degrees(leans.back), 25, 2);
  EXPECT_GT(leans.side, leans.forward);
  EXPECT_TRUE(FixedView().Sees(12, 8));
  EXPECT_FALSE(FixedView().Sees(2, 8));
}

}  // namespace
}  // namespace kestrel
