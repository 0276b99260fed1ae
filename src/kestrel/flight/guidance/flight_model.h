// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "kestrel/core/base/time.h"
#include "kestrel/core/poses/set_point.h"
#include "kestrel/flight/guidance/forgetting_regression.h"

namespace kestrel {

struct FlightModelOptions {
  bool is_used = true;  // false: what is assumed is kept
  // What is assumed until the flight has told better.
  double delay_s = 0.12;  // of attitude and thrust after the autopilot's command
  double memory_s = 20;   // what is longer ago is forgotten

  template <class Self, class Visitor>
  static void Visit(Self& self, Visitor&& visitor) {
    visitor("is_used", self.is_used, "", "what the flight tells is used");
    visitor("delay_s", self.delay_s, "s",
            "of attitude and thrust after the autopilot's command, before it is known");
    visitor("memory_s", self.memory_s, "s", "what is longer ago is forgotten");
  }
  std::vector<std::string> Validate() const;
};

// The air, by how the UAV leans against it.
struct AirEstimate {
  double drag = 0;             // acceleration per speed through the air, 1/s
  Eigen::Vector2d wind{0, 0};  // velocity of the air, m/s
};

// How a UAV answers to set-points, learnt while it flies. Horizontally, what it is commanded
// differs from what it does some time later by
//   v_command - v = slack (a - a_command) + lag a_command + drag v + push
// whatever its autopilot does inside: a velocity control with too little gain, drag that it does
// not compensate, the wind, integrators. The four are fitted for each of some delays, and weighted
// by how well each explains the flight; the same equation then says what to command.
class FlightModel {
 public:
  // Throws InputError when the options are not valid.
  explicit FlightModel(const FlightModelOptions& options);

  // The UAV at 'now' (the body's z axis in the world is 'up', along which it is pushed), and the
  // set-point that is sent now; nothing: none is, or it could not obey. In order of time.
  void Observe(Time now, const Eigen::Vector3d& velocity, const Eigen::Vector3d& up,
               const std::optional<SetPoint>& sent, double link_delay_s);

  // The UAV is not known for a moment: what comes next has nothing to do with what was before.
  void Forgo() { newest_.reset(); }

  // From sending a set-point to its effect, s.
  double delay_s() const { return delay_s_; }

  // The horizontal velocity to command, beside 'acceleration', for the UAV to fly with 'velocity'
  // and 'acceleration' when the command has its effect.
  Eigen::Vector2d VelocityCommand(const Eigen::Vector2d& velocity,
                                  const Eigen::Vector2d& acceleration) const;

  // Nothing until it has flown with different velocities.
  std::optional<AirEstimate> air() const;

 private:
  static constexpr int kDelays = 13;
  static constexpr int kSamples = 64;

  // What has been up to an instant, added up over the samples: differences are means.
  struct Sums {
    Eigen::Vector3d velocity_now{0, 0, 0};  // not a sum
    Eigen::Vector2d velocity{0, 0};
    Eigen::Vector2d lean{0, 0};  // horizontal per vertical thrust
    Eigen::Vector2d commanded_velocity{0, 0};
    Eigen::Vector2d commanded_acceleration{0, 0};
    int commands = 0;
  };
  struct Instant {
    Time time;
    Eigen::Vector3d velocity;
    Eigen::Vector2d lean;
    std::optional<SetPoint> sent;
  };

  void AddSample(const Eigen::Vector3d& velocity, const Eigen::Vector2d& lean);
  void Learn();
  void LearnAir(const Sums& begin, const Sums& end, const Eigen::Vector3d& acceleration);
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
  double delay_s_;
  Eigen::Matrix<double, 5, 1> answer_;  // slack, lag, drag, push (2)
};

}  // namespace kestrel
