// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "kestrel/core/base/limits.h"
#include "kestrel/core/base/random.h"
#include "kestrel/simulation/scene/motion.h"

namespace kestrel {

// Motion of the air: a steady wind with random speed and direction, and gusts.
struct WindOptions {
  double min_mps = 2.8;
  double max_mps = 5.6;
  double gusts = 0.25;
  double gust_period_s = 3;

  static void Visit(auto& self, auto&& visit) {
    visit("min_mps", self.min_mps, Range{0, 30}, "smallest steady speed that is drawn");
    visit("max_mps", self.max_mps, "largest steady speed that is drawn");
    visit("gusts", self.gusts, Range{0, 1}, "spread of the gusts, as a part of the steady speed");
    visit("gust_period_s", self.gust_period_s, Range{0.2, 60}, "typical duration of a gust");
  }
  std::vector<std::string> Validate() const;
};

// Velocity of the air (m/s) as a function of time (s).
Path MakeWind(const WindOptions& options, Random* random);

}  // namespace kestrel
