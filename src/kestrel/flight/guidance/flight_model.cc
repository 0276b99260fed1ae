// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/flight/guidance/flight_model.h"

#include <algorithm>
#include <cmath>

#include "kestrel/core/base/limits.h"
#include "kestrel/core/base/options.h"
#include "kestrel/core/poses/gravity.h"

namespace kestrel {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;
using Answer = Eigen::Matrix<double, 5, 1>;
using Air = Eigen::Vector3d;

constexpr double kSample_s = 0.02;
constexpr int kWindow = 10;               // samples over which the motion is averaged
constexpr double kResponseMemory_s = 20;  // age after which measurements are forgotten
constexpr int kLearnEvery = 5;            // samples
constexpr int kDelayStep = 2;             // samples between the delays tried
constexpr double kGap_s = 0.25;           // samples before a longer gap are of no use
// Deviations from the model (gusts above all) last this long: measurements within are not
// independent.
constexpr double kCorrelation_s = 0.5;
constexpr double kWeight = kLearnEvery * kSample_s / kCorrelation_s;  // weight of one measurement
constexpr double kNoise_mps = 0.6;
constexpr double kDelaySigma_s = 0.03;  // uncertainty of the assumed delay
constexpr double kAirMemory_s = 20;
constexpr double kAirNoise = 0.3;      // m/s^2
constexpr double kMaxAirSigma = 0.06;  // largest usable uncertainty of the drag, 1/s

// Limits of the learning. A slack above the first is a limit of the autopilot, not its answer, if
// the velocity still approaches the command by more than the last (m/s^2) or if the slack is above
// the second.
constexpr double kMaxSlack_mps = 1.5;
constexpr double kMaxSteadySlack_mps = 4;
constexpr double kSteadyAcceleration = 1;

// Assumption: the autopilot knows its own velocity without delay. A command that is given ahead by
// the delay is therefore too large by the delay times the acceleration.
Answer AssumedAnswer(double delay_s) { return {0.3, -delay_s, 0, 0, 0}; }

// Prior standard deviations of slack (s), lag (s), drag (1/s) and push (m/s, two axes). Drag and
// push are kept small because a landing is too short to separate them from the velocity error that
// is left from catching up with the target. They are smaller still for an autopilot that takes
// accelerations, as these already compensate the air. The sigma of drag is such that at 3 m/s it
// causes the same error as the push.
Answer AnswerSigma(const VelocityControl& control) {
  const double push_mps = control.takes_acceleration() ? 0.1 : 0.3;
  return {0.3, 0.05, push_mps / 3, push_mps, push_mps};
}

// True when a UAV that is slower than its command by 'slack' is at a limit of its autopilot: this
// carries no information about its answer. 'gain': its acceleration beyond the one that is
// commanded. A UAV with a moderate slack that comes no nearer to the command has drag that nothing
// compensates, and counts.
bool IsAtLimit(const Eigen::Vector2d& slack, const Eigen::Vector2d& gain) {
  const double size = slack.norm();
  if (size <= kMaxSlack_mps) return false;
  return size > kMaxSteadySlack_mps || gain.dot(slack) > kSteadyAcceleration * size;
}

}  // namespace

std::vector<std::string> FlightModelOptions::Validate() const {
  std::vector<std::string> violations;
  AddViolations("control", control.Validate(), &violations);
  return violations;
}

FlightModel::FlightModel(const FlightModelOptions& options)
    : options_(Checked(options)),
      by_lean_(Air(0.1, 0, 0), Air(0.15, 1, 1), kAirNoise),
      observer_(options.control),
      gusts_(options.path),
      delay_s_(options.delay_s),
      answer_(AssumedAnswer(options.delay_s)) {
  by_delay_.fill(ForgettingRegression<5>(answer_, AnswerSigma(options.control), kNoise_mps));
}

void FlightModel::Observe(Time now, const Vector3d& velocity, const Vector3d& up,
                          const std::optional<SetPoint>& sent, double link_delay_s) {
  const Vector2d lean = up.head<2>() / std::max(up.z(), 0.1);
  link_delay_s_ = link_delay_s;
  const double passed_s = newest_ ? ToSeconds(now - newest_->time) : kGap_s;
  if (!(passed_s < kGap_s)) {
    count_ = 0;
    next_sample_ = now;
  } else {
    for (; next_sample_ <= now; next_sample_ += DurationFromSeconds(kSample_s)) {
      const double part = passed_s > 0 ? 1 - ToSeconds(now - next_sample_) / passed_s : 1;
      AddSample(newest_->velocity + part * (velocity - newest_->velocity),
                newest_->lean + part * (lean - newest_->lean));
    }
  }
  newest_ = Instant{now, velocity, lean, sent, fed_forward_, fed_velocity_};
  gusts_.Observe(now, velocity.head<2>(), lean);
  if (count_ == 0) Weigh();
}

// Adds a sample before the set-point of this instant was sent: the one before is in force.
void FlightModel::AddSample(const Vector3d& velocity, const Vector2d& lean) {
  Sums sums = count_ > 0 ? Ago(0) : Sums();
  sums.velocity_now = velocity;
  sums.velocity += velocity.head<2>();
  sums.lean += lean;
  if (newest_->sent) {
    sums.commanded_velocity += newest_->sent->velocity.head<2>() - newest_->fed_velocity;
    sums.commanded_acceleration += newest_->sent->acceleration.head<2>();
    sums.fed_forward += newest_->fed_forward;
    ++sums.commands;
  }
  ++count_;
  sums_[(count_ - 1) % kSamples] = sums;
  if (count_ % kLearnEvery == 0 && count_ > kWindow) Learn();
}

void FlightModel::Learn() {
  const Sums& end = Ago(0);
  const Sums& begin = Ago(kWindow);
  const Vector3d acceleration = (end.velocity_now - begin.velocity_now) / (kWindow * kSample_s);
  // The mean between the samples, not of the samples after the first.
  const Vector2d ends = 0.5 * (begin.velocity_now - end.velocity_now).head<2>();
  const Vector2d velocity = (end.velocity - begin.velocity + ends) / kWindow;
  LearnAir(begin, end, acceleration);
  if (options_.control.takes_acceleration()) ObserveDisturbance(velocity, acceleration.head<2>());
  // All delays are judged by the same measurements.
  constexpr int kSpan = kWindow + (kDelays - 1) * kDelayStep;
  if (count_ <= kSpan || Ago(0).commands - Ago(kSpan).commands < kSpan) return;
  for (int i = 0; i < kDelays; ++i) {
    const Sums& sent_end = Ago(i * kDelayStep);
    const Sums& sent_begin = Ago(i * kDelayStep + kWindow);
    const Vector2d commanded =
        (sent_end.commanded_velocity - sent_begin.commanded_velocity) / kWindow;
    const Vector2d pushed = (sent_end.commanded_acceleration - sent_begin.commanded_acceleration -
                             (sent_end.fed_forward - sent_begin.fed_forward)) /
                            kWindow;
    if (IsAtLimit(commanded - velocity, acceleration.head<2>() - pushed)) continue;
    by_delay_[i].Forget(std::exp(-kLearnEvery * kSample_s / kResponseMemory_s));
    for (int axis = 0; axis < 2; ++axis) {
      Answer row(acceleration(axis) - pushed(axis), pushed(axis), velocity(axis), 0, 0);
      row(3 + axis) = 1;
      by_delay_[i].Add(row, commanded(axis) - velocity(axis), kWeight);
    }
  }
  Weigh();
}

void FlightModel::LearnAir(const Sums& begin, const Sums& end, const Vector3d& acceleration) {
  const Vector2d lean = (end.lean - begin.lean) / kWindow;
  // The drag of a descent reduces the thrust that leans.
  const double climb = 0.5 * (begin.velocity_now.z() + end.velocity_now.z());
  const Vector2d velocity = (end.velocity - begin.velocity) / kWindow - climb * lean;
  const Vector2d by_air = acceleration.head<2>() - (kGravity + acceleration.z()) * lean;
  by_lean_.Forget(std::exp(-kLearnEvery * kSample_s / kAirMemory_s));
  for (int axis = 0; axis < 2; ++axis) {
    Air row(-velocity(axis), 0, 0);
    row(1 + axis) = 1;
    by_lean_.Add(row, by_air(axis), kWeight);
  }
}

// The control saw its velocity and the command before its answer, by the delay of the attitude and
// by the whole delay.
void FlightModel::ObserveDisturbance(const Vector2d& velocity, const Vector2d& acceleration) {
  const Air air = by_lean_.Solve().parameters;
  observer_.SetAir({air(0), air.tail<2>()}, velocity);
  const auto samples = [](double seconds) {
    return std::clamp(static_cast<int>(std::lround(seconds / kSample_s)), 0, kDelays * kDelayStep);
  };
  const int command = samples(delay_s_);
  const int attitude = samples(delay_s_ - link_delay_s_);
  if (count_ <= kWindow + command) return;
  const Sums& sent_end = Ago(command);
  const Sums& sent_begin = Ago(command + kWindow);
  if (sent_end.commands - sent_begin.commands < kWindow) return;
  const Vector2d seen = (Ago(attitude).velocity - Ago(attitude + kWindow).velocity) / kWindow;
  DisturbanceObserver::Sample sample;
  sample.velocity = velocity;
  sample.acceleration = acceleration;
  sample.slip = (sent_end.commanded_velocity - sent_begin.commanded_velocity) / kWindow - seen;
  sample.commanded =
      (sent_end.commanded_acceleration - sent_begin.commanded_acceleration) / kWindow;
  observer_.Observe(sample, kLearnEvery * kSample_s, delay_s_);
}

// Averages over the delays, each weighted by its likelihood given its residuals.
void FlightModel::Weigh() {
  const double assumed_s = options_.delay_s + link_delay_s_;
  delay_s_ = assumed_s;
  answer_ = AssumedAnswer(options_.delay_s);
  if (!options_.is_used) return;
  std::array<ForgettingRegression<5>::Fit, kDelays> fits;
  std::array<double, kDelays> chi2;
  for (int i = 0; i < kDelays; ++i) {
    fits[i] = by_delay_[i].Solve();
    chi2[i] = fits[i].chi2 + std::pow((i * kDelayStep * kSample_s - assumed_s) / kDelaySigma_s, 2);
  }
  const double best = *std::ranges::min_element(chi2);
  double sum = 0;
  delay_s_ = 0;
  answer_.setZero();
  for (int i = 0; i < kDelays; ++i) {
    const double weight = std::exp(-0.5 * (chi2[i] - best));
    sum += weight;
    delay_s_ += weight * i * kDelayStep * kSample_s;
    answer_ += weight * fits[i].parameters;
  }
  delay_s_ /= sum;
  answer_ /= sum;
}

void FlightModel::Command(SetPoint* set_point) {
  const Vector2d velocity = set_point->velocity.head<2>();
  const Vector2d acceleration = set_point->acceleration.head<2>();
  set_point->velocity.head<2>() +=
      answer_(1) * acceleration + answer_(2) * velocity + answer_.tail<2>();
  if (options_.is_used) FeedForward(velocity, acceleration);
  set_point->velocity.head<2>() += fed_velocity_;
  set_point->acceleration.head<2>() += fed_forward_;
}

void FlightModel::FeedForward(const Vector2d& velocity, const Vector2d& acceleration) {
  if (options_.control.takes_acceleration()) {
    fed_forward_ = observer_.FeedForward(velocity, acceleration);
  } else if (options_.meets_gusts && options_.path.is_known()) {
    gusts_.Move(delay_s_);
    fed_velocity_ = gusts_.velocity();
    fed_forward_ = gusts_.acceleration();
  }
}

std::optional<AirEstimate> FlightModel::air() const {
  constexpr double kLeastDrag = 0.02;  // 1/s; a lower drag does not determine the wind
  const auto fit = by_lean_.Solve();
  if (fit.sigma(0) > kMaxAirSigma || fit.parameters(0) < kLeastDrag) return std::nullopt;
  return AirEstimate{fit.parameters(0), fit.parameters.tail<2>() / fit.parameters(0)};
}

}  // namespace kestrel
