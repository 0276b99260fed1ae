// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/flight/guidance/oscillation.h"

#include <algorithm>
#include <cmath>

#include "kestrel/core/geometry/angles.h"

namespace kestrel {
namespace {

constexpr double kShortest_s = 2.5;  // periods of the bank: from a boat in chop to a ship in swell
constexpr double kLongest_s = 16;
constexpr double kDamping = 0.04;
constexpr double kMemory_s = 15;  // for so long a filter's predictions count

}  // namespace

Oscillation::Oscillation(const Spread& spread) : spread_(spread) {
  const double step = std::log(kLongest_s / kShortest_s) / (kPeriods - 1);
  for (int i = 0; i < kPeriods; ++i) {
    filters_[i].rate = 2 * kPi / (kShortest_s * std::exp(step * i));
  }
}

void Oscillation::Observe(double seconds, double value) {
  for (Filter& filter : filters_) {
    if (has_begun_) {
      Predict(seconds, &filter);
    } else {
      filter.state << value, 0, 0;
      const Eigen::Vector3d sigma(2 * spread_.swing, spread_.swing, filter.rate * spread_.swing);
      filter.covariance = sigma.cwiseAbs2().asDiagonal();
    }
    Correct(seconds, value, &filter);
  }
  has_begun_ = true;
  double best = filters_[0].log_weight;
  for (const Filter& filter : filters_) best = std::max(best, filter.log_weight);
  for (Filter& filter : filters_) filter.log_weight -= best;
}

// The exact motion of a damped oscillator that noise keeps swinging by 'swing'.
void Oscillation::Predict(double seconds, Filter* filter) const {
  const double natural = filter->rate;
  const double decay = kDamping * natural;
  const double rate = natural * std::sqrt(1 - kDamping * kDamping);
  const double fade = std::exp(-decay * seconds);
  const double sine = fade * std::sin(rate * seconds) / rate;
  const double cosine = fade * std::cos(rate * seconds);
  Eigen::Matrix3d motion = Eigen::Matrix3d::Identity();
  motion.bottomRightCorner<2, 2>() << cosine + decay * sine, sine, -natural * natural * sine,
      cosine - decay * sine;
  const Eigen::Vector3d sigma(0, spread_.swing, natural * spread_.swing);
  const Eigen::Matrix3d rest = sigma.cwiseAbs2().asDiagonal();
  filter->state = motion * filter->state;
  filter->covariance = motion * (filter->covariance - rest) * motion.transpose() + rest;
  filter->covariance(0, 0) += seconds * spread_.level_per_s * spread_.level_per_s;
}

void Oscillation::Correct(double seconds, double value, Filter* filter) const {
  const Eigen::RowVector3d seen(1, 1, 0);
  const double variance = (seen * filter->covariance * seen.transpose()).value() +
                          spread_.measurement * spread_.measurement;
  const double error = value - (seen * filter->state).value();
  const Eigen::Vector3d gain = filter->covariance * seen.transpose() / variance;
  filter->state += gain * error;
  filter->covariance -= variance * gain * gain.transpose();
  filter->log_weight *= std::exp(-seconds / kMemory_s);
  filter->log_weight -= 0.5 * (std::log(variance) + error * error / variance);
}

Oscillation::Prediction Oscillation::Ahead(double seconds) const {
  double weights = 0;
  Eigen::Vector2d mean(0, 0);
  Eigen::Vector2d square(0, 0);
  for (Filter filter : filters_) {
    Predict(seconds, &filter);
    const double weight = std::exp(filter.log_weight);
    const Eigen::Matrix3d& p = filter.covariance;
    const Eigen::Vector2d values(filter.state[0] + filter.state[1], filter.state[2]);
    const Eigen::Vector2d variances(p(0, 0) + p(1, 1) + 2 * p(0, 1), p(2, 2));
    weights += weight;
    mean += weight * values;
    square += weight * (values.cwiseAbs2() + variances);
  }
  mean /= weights;
  const Eigen::Vector2d sigma = (square / weights - mean.cwiseAbs2()).cwiseMax(0).cwiseSqrt();
  return {mean[0], mean[1], sigma[0], sigma[1]};
}

}  // namespace kestrel
