// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/flight/guidance/flight_model.h"

#include <gtest/gtest.h>

#include "kestrel/flight/guidance/test_flight.h"

namespace kestrel {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

// Flies a circle of 6 m at 4.2 m/s with the commands of the model. Returns the RMS difference from
// the wanted velocity over the last 10 s.
double FlyCircle(const TestUavOptions& uav_options, const Vector3d& wind, double link_delay_s,
                 FlightModel* model) {
  constexpr double kSpeed = 4.2;
  constexpr double kRate = kSpeed / 6;
  constexpr double kFlight_s = 40;
  TestUav uav(uav_options, {0, 0, 10});
  double squares = 0;
  int count = 0;
  for (double time_s = 0; time_s < kFlight_s; time_s += kTestStep_s) {
    const auto velocity_at = [&](double at_s) {
      return Vector2d(kSpeed * Vector2d(-std::sin(kRate * at_s), std::cos(kRate * at_s)));
    };
    const double then_s = time_s + model->delay_s();
    const Vector2d velocity = velocity_at(then_s);
    const Vector2d acceleration = kRate * Vector2d(-velocity.y(), velocity.x());
    SetPoint command;
    command.velocity.head<2>() = velocity;
    command.acceleration.head<2>() = acceleration;
    model->Command(&command);
    const UavState state = uav.State();
    model->Observe(TimeFromNanoseconds(0) + DurationFromSeconds(time_s), state.velocity_in_world,
                   state.world_from_body.rotation * Vector3d::UnitZ(), command, link_delay_s);
    uav.Step(command, wind);
    if (time_s > kFlight_s - 10) {
      squares += (uav.velocity().head<2>() - velocity_at(time_s + kTestStep_s)).squaredNorm();
      ++count;
    }
  }
  return std::sqrt(squares / count);
}

TEST(FlightModelTest, EstimatesDragAndWindFromLean) {
  for (const double drag : {0.1, 0.25, 0.5}) {
    TestUavOptions options = TestUavOptions::Px4();
    options.drag = drag;
    FlightModel model({});
    FlyCircle(options, {4, -3, 0}, 0, &model);
    ASSERT_TRUE(model.air());
    EXPECT_NEAR(model.air()->drag, drag, 0.03);
    EXPECT_LT((model.air()->wind - Vector2d(4, -3)).norm(), 0.5);
  }
}

TEST(FlightModelTest, GivesNoAirEstimateBeforeFlight) {
  FlightModel model({});
  EXPECT_FALSE(model.air());
  for (int i = 0; i < 200; ++i) {
    model.Observe(TimeFromNanoseconds(0) + DurationFromSeconds(0.02 * i), Vector3d::Zero(),
                  Vector3d::UnitZ(), SetPoint(), 0);
  }
  EXPECT_FALSE(model.air()) << "hovers in a calm";
}

// With little gain, wind causes an error of the velocity control. The learnt model reduces it to a
// part.
TEST(FlightModelTest, ReachesDemandedVelocityOnCurveInWind) {
  TestUavOptions options;
  options.p = 1.5;
  for (const double attitude_lag_s : {0.06, 0.12}) {
    options.attitude_lag_s = attitude_lag_s;
    FlightModelOptions assumed;
    assumed.is_used = false;
    FlightModel ignorant(assumed);
    FlightModel model({});
    const double before = FlyCircle(options, {4, -3, 0}, 0, &ignorant);
    const double after = FlyCircle(options, {4, -3, 0}, 0, &model);
    EXPECT_GT(before, 0.8);
    EXPECT_LT(after, 0.6 * before);
  }
}

// The velocity control of PX4 has a gain of 1.8: a drag of 1 per s would leave it 2.3 m/s behind.
TEST(FlightModelTest, FeedsForwardAirToAutopilotWithAccelerations) {
  for (const double drag : {0.1, 0.35, 1.0}) {
    TestUavOptions options = TestUavOptions::Px4();
    options.drag = drag;
    FlightModelOptions px4;
    px4.control = options.Control();
    FlightModel model(px4);
    EXPECT_LT(FlyCircle(options, {2, -1.5, 0}, 0, &model), 0.12) << drag;
  }
}

TEST(FlightModelTest, DelayIncludesLink) {
  TestUavOptions options = TestUavOptions::Px4();
  options.delay_s = 0.1;
  FlightModel model({});
  const double error = FlyCircle(options, {4, -3, 0}, 0.1, &model);
  EXPECT_NEAR(model.delay_s(), 0.1 + 2 * 0.08, 0.06);
  EXPECT_LT(error, 0.3);
}

TEST(FlightModelTest, ToleratesGapsAndIrregularCalls) {
  FlightModel model({});
  Random random(3);
  double time_s = 0;
  for (int i = 0; i < 2000; ++i) {
    time_s += i % 100 == 0 ? 2 : random.Uniform(0, 0.06);
    const Vector3d velocity(std::sin(time_s), std::cos(time_s), 0);
    std::optional<SetPoint> sent;
    if (i % 50 > 5) sent = SetPoint{velocity, Vector3d::Zero(), std::nullopt};
    model.Observe(TimeFromNanoseconds(0) + DurationFromSeconds(time_s), velocity, Vector3d::UnitZ(),
                  sent, 0.02);
    SetPoint command{{1, 1, 0}, {1, 1, 0}};
    model.Command(&command);
    ASSERT_TRUE(command.velocity.allFinite());
    ASSERT_TRUE(command.acceleration.allFinite());
    ASSERT_GE(model.delay_s(), 0);
    ASSERT_LE(model.delay_s(), 0.5);
  }
  SetPoint command{{1, 0, 0}};
  model.Command(&command);
  EXPECT_LT((command.velocity - Vector3d(1, 0, 0)).norm(), 0.3);
}

}  // namespace
}  // namespace kestrel
