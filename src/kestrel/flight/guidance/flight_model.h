// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "kestrel/core/base/limits.h"
#include "kestrel/core/base/time.h"
#include "kestrel/core/poses/set_point.h"
#include "kestrel/flight/guidance/disturbance_observer.h"
#include "kestrel/flight/guidance/forgetting_regression.h"
#include "kestrel/flight/guidance/gust_feed.h"

namespace kestrel {

struct FlightModelOptions {
  bool is_used = true;
  double delay_s = 0.12;
  VelocityControl control;
  PathControl path;
  bool meets_gusts = false;  // by the path; no option of the user

  static void Visit(auto& self, auto&& visit) {
    visit("is_used", self.is_used, "use the response that is measured in flight");
    visit("delay_s", self.delay_s, Range{0, 0.4},
          "delay of attitude and thrust until it is measured");
    visit.Gone({"memory_s"});
  }
  std::vector<std::string> Validate() const;
};

// The air, estimated from how the UAV leans against it.
struct AirEstimate {
  double drag = 0;             // acceleration per speed through the air, 1/s
  Eigen::Vector2d wind{0, 0};  // velocity of the air, m/s
};

// The UAV's answer to set-points, learnt in flight. Horizontally, the commanded velocity differs
// from the velocity some time later by
//   v_command - v = slack (a - a_command) + lag a_command + drag v + push
// whatever the autopilot does inside: a velocity control with too little gain, drag that it does
// not compensate, the wind, integrators. The four terms are fitted for each of several delays. The
// delays are weighted by how well each explains the flight. The same equation then gives the
// command. For an autopilot that takes accelerations as they are, the air is fed forward in the
// acceleration: the accelerations of the equation are those without it, and drag and push are what
// it leaves.
class FlightModel {
 public:
  // Throws InputError when the options are not valid.
  explicit FlightModel(const FlightModelOptions& options);

  // Takes the UAV's state at 'now' and the set-point that is sent now, in order of time. 'up': the
  // body's z axis in the world, the direction of thrust. No set-point: none is sent, or the UAV
  // could not obey it.
  void Observe(Time now, const Eigen::Vector3d& velocity, const Eigen::Vector3d& up,
               const std::optional<SetPoint>& sent, double link_delay_s);

  // The UAV's state is not known for a moment: the next samples do not continue the previous ones.
  void Forgo() { newest_.reset(); }

  // Meets no gust until now, as one that rests on something: what it does not follow is none.
  void Rest() {
    gusts_.Forget();
    fed_velocity_.setZero();
  }

  // Time from sending a set-point to its effect, s.
  double delay_s() const { return delay_s_; }
  // Part of the newest commanded velocity that meets gusts, and that the UAV does not follow.
  const Eigen::Vector2d& fed_velocity() const { return fed_velocity_; }

  // Takes the horizontal velocity and acceleration that the UAV is to have when the command takes
  // effect, and replaces them by those to command. The next set-point observed is the one of the
  // last call, within limits.
  void Command(SetPoint* set_point);

  // Nothing until the UAV has flown at different velocities.
  std::optional<AirEstimate> air() const;

 private:
  static constexpr int kDelays = 13;
  static constexpr int kSamples = 64;

  // Sums over all samples up to an instant. Differences of two sums give means.
  struct Sums {
    Eigen::Vector3d velocity_now{0, 0, 0};  // not a sum
    Eigen::Vector2d velocity{0, 0};
    Eigen::Vector2d lean{0, 0};  // horizontal part of the thrust's direction per vertical part
    Eigen::Vector2d commanded_velocity{0, 0};
    Eigen::Vector2d commanded_acceleration{0, 0};
    Eigen::Vector2d fed_forward{0, 0};  // part of it
    int commands = 0;
  };
  struct Instant {
    Time time;
    Eigen::Vector3d velocity;
    Eigen::Vector2d lean;
    std::optional<SetPoint> sent;
    Eigen::Vector2d fed_forward;
    Eigen::Vector2d fed_velocity;
  };

  void AddSample(const Eigen::Vector3d& velocity, const Eigen::Vector2d& lean);
  void Learn();
  void LearnAir(const Sums& begin, const Sums& end, const Eigen::Vector3d& acceleration);
  void FeedForward(const Eigen::Vector2d& velocity, const Eigen::Vector2d& acceleration);
  void ObserveDisturbance(const Eigen::Vector2d& velocity, const Eigen::Vector2d& acceleration);
  void Weigh();
  const Sums& Ago(int samples) const { return sums_[(count_ - 1 - samples) % kSamples]; }

  FlightModelOptions options_;
  std::array<Sums, kSamples> sums_;
  std::int64_t count_ = 0;  // samples since the last gap
  std::optional<Instant> newest_;
  Time next_sample_;
  double link_delay_s_ = 0;
  std::array<ForgettingRegression<5>, kDelays> by_delay_;
  ForgettingRegression<3> by_lean_;
  DisturbanceObserver observer_;
  GustFeed gusts_;
  // Acceleration and velocity that the last command has in addition.
  Eigen::Vector2d fed_forward_{0, 0};
  Eigen::Vector2d fed_velocity_{0, 0};
  double delay_s_;
  Eigen::Matrix<double, 5, 1> answer_;  // slack, lag, drag, push (2)
};

}  // namespace kestrel
