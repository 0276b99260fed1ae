// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/flight/guidance/deck_motion.h"

#include <algorithm>
#include <cmath>

namespace kestrel {
namespace {

// A deck's heave and tilt, and the errors with which vision measures them.
constexpr Oscillation::Spread kHeight = {.swing = 0.4, .measurement = 0.03, .level_per_s = 0.02};
constexpr Oscillation::Spread kNormal = {.swing = 0.07, .measurement = 0.02, .level_per_s = 0.002};

constexpr double kForecastStep_s = 0.1;

}  // namespace

DeckMotion::DeckMotion() : height_(kHeight), normal_x_(kNormal), normal_y_(kNormal) {}

void DeckMotion::Reset() { *this = {}; }

void DeckMotion::Observe(Time time, double height_m, const Eigen::Vector3d& normal) {
  if (!std::isfinite(height_m) || !normal.allFinite() || (first_ && time <= last_)) return;
  if (first_ && ToSeconds(time - last_) > kLongestGap_s) Reset();
  const double seconds = first_ ? ToSeconds(time - last_) : 0;
  height_.Observe(seconds, height_m);
  normal_x_.Observe(seconds, normal.x());
  normal_y_.Observe(seconds, normal.y());
  if (!first_) first_ = time;
  last_ = time;
}

bool DeckMotion::is_known() const { return first_ && ToSeconds(last_ - *first_) >= kFirst_s; }

std::optional<DeckForecast> DeckMotion::Ahead(double ahead_s) const {
  if (!is_known()) return std::nullopt;
  const Oscillation::Prediction height = height_.Ahead(ahead_s);
  const Oscillation::Prediction x = normal_x_.Ahead(ahead_s);
  const Oscillation::Prediction y = normal_y_.Ahead(ahead_s);
  DeckForecast forecast;
  forecast.height_m = height.value;
  forecast.climb_mps = height.rate;
  forecast.tilt = std::asin(std::min(std::hypot(x.value, y.value), 1.0));
  forecast.height_sigma_m = height.sigma;
  forecast.climb_sigma_mps = height.rate_sigma;
  forecast.tilt_sigma = std::max(x.sigma, y.sigma);
  return forecast;
}

std::optional<DeckMotion::Swing> DeckMotion::SwingWithin(double horizon_s) const {
  const auto now = Ahead(0);
  if (!now) return std::nullopt;
  Swing swing{std::abs(now->climb_mps), now->tilt, now->tilt};
  for (double ahead_s = kForecastStep_s; ahead_s <= horizon_s; ahead_s += kForecastStep_s) {
    const DeckForecast deck = *Ahead(ahead_s);
    swing.climb_mps = std::max(swing.climb_mps, std::abs(deck.climb_mps));
    swing.least_tilt = std::min(swing.least_tilt, deck.tilt);
    swing.most_tilt = std::max(swing.most_tilt, deck.tilt);
  }
  return swing;
}

std::optional<DeckMotion::Window> DeckMotion::NextWindow(double max_tilt, double max_climb_mps,
                                                         double horizon_s) const {
  std::optional<Window> window;
  for (double ahead_s = 0; ahead_s <= horizon_s; ahead_s += kForecastStep_s) {
    const auto deck = Ahead(ahead_s);
    if (!deck) return std::nullopt;
    const bool is_good = deck->tilt < max_tilt && std::abs(deck->climb_mps) < max_climb_mps;
    if (is_good && !window) window = Window{ahead_s, ahead_s};
    if (is_good) window->end_s = ahead_s;
    if (!is_good && window) break;
  }
  return window;
}

}  // namespace kestrel
