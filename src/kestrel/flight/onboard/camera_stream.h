// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
#include <string>

#include "kestrel/core/base/time.h"

namespace kestrel {

// The video of a flight, as ground stations learn of it.
struct CameraStream {
  std::string uri;
  double rate_hz = 0;
  std::function<Duration()> delay;  // from the capture of an image until it leaves; any thread
};

}  // namespace kestrel
