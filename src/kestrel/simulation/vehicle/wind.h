// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "kestrel/core/base/random.h"
#include "kestrel/simulation/scene/motion.h"

namespace kestrel {

// Motion of the air: a steady wind with random speed and direction, and gusts.
struct WindOptions {
  double min_mps = 2.8;  // the steady speed is random between these; 10 to 20 km/h
  double max_mps = 5.6;
  double gusts = 0.25;  // standard deviation of the gusts per axis, as a part of the steady speed;
                        // half of it vertically
  double gust_period_s = 3;

  template <class Self, class Visitor>
  static void Visit(Self& self, Visitor&& visitor) {
    visitor("min_mps", self.min_mps, "m/s", "smallest steady speed that is drawn");
    visitor("max_mps", self.max_mps, "m/s", "largest steady speed that is drawn");
    visitor("gusts", self.gusts, "1", "spread of the gusts, as a part of the steady speed");
    visitor("gust_period_s", self.gust_period_s, "s", "typical duration of a gust");
  }
  std::vector<std::string> Validate() const;
};

// Velocity of the air (m/s) as a function of time (s).
Path MakeWind(const WindOptions& options, Random* random);

}  // namespace kestrel
