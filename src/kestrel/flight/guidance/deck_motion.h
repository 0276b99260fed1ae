// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>

#include <Eigen/Core>

#include "kestrel/core/base/time.h"
#include "kestrel/flight/guidance/oscillation.h"

namespace kestrel {

// Attitude and motion of a deck at a later time.
struct DeckForecast {
  double height_m = 0;  // world
  double climb_mps = 0;
  double tilt = 0;  // angle of its normal from the vertical, rad
  double height_sigma_m = 0;
  double climb_sigma_mps = 0;
  double tilt_sigma = 0;
};

// Predicts the heave, roll and pitch of a deck by its own motion of the last 15 s, some seconds
// ahead: when it will be level and hardly rise, to touch down then. Neither allocates nor throws.
//
// Example:
//   DeckMotion deck;
//   deck.Observe(time, pattern_height_m, pattern_normal);
//   if (const auto window = deck.NextWindow(Radians(3), 0.2)) Descend(window->begin_s);
class DeckMotion {
 public:
  DeckMotion();

  // Takes the height (m, world) of the deck's middle and its normal (a unit vector in the world,
  // upwards) at a time. What is not finite or not later than the one before is left out. After a
  // gap of kLongestGap_s it begins anew.
  void Observe(Time time, double height_m, const Eigen::Vector3d& normal);
  void Reset();

  // True once it has been observed for kFirst_s: about a period.
  bool is_known() const;

  // Returns the deck 'ahead_s' after the last observation, up to 3 s are sensible; nothing while it
  // is not known.
  std::optional<DeckForecast> Ahead(double ahead_s) const;

  // Largest motion within a time.
  struct Swing {
    double climb_mps = 0;                  // up or down
    double least_tilt = 0, most_tilt = 0;  // rad
  };
  // Returns the largest motion within 'horizon_s' by its expectation; nothing while the deck is not
  // known.
  std::optional<Swing> SwingWithin(double horizon_s) const;

  // A time span, s after the last observation.
  struct Window {
    double begin_s = 0;
    double end_s = 0;
  };
  // Returns the first span within 'horizon_s' in which the tilt is below 'max_tilt' (rad) and the
  // vertical speed below 'max_climb_mps', up or down, each by its expectation; nothing: there is
  // none, or the deck is not known.
  std::optional<Window> NextWindow(double max_tilt, double max_climb_mps,
                                   double horizon_s = 3) const;

  static constexpr double kFirst_s = 6;
  static constexpr double kLongestGap_s = 3;

 private:
  std::optional<Time> first_;
  Time last_;
  Oscillation height_;
  Oscillation normal_x_;
  Oscillation normal_y_;
};

}  // namespace kestrel
