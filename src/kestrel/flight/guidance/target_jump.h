// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>

#include "kestrel/flight/guidance/guidance.h"

namespace kestrel {

// Finds out when the track of what a person has marked goes on with something else.
class TargetJump {
 public:
  void Reset() { last_.reset(); }
  // True when the target, which is seen, is farther from where it was than it can have gone since
  // it was seen there; else its place is kept. The tracker looks as far, by the same speed.
  bool Update(const GuidanceInput& input);

 private:
  struct Sight {
    TurnState motion;
    Time time;
  };

  std::optional<Sight> last_;
};

}  // namespace kestrel
