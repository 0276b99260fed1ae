// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/flight/onboard/flight_options.h"

#include <fmt/format.h>

#include "kestrel/flight/onboard/pad_position.h"

namespace kestrel {

std::vector<std::string> FlightOptions::Validate() const {
  if (pad_origin.empty() || ParseGlobalPosition(pad_origin)) return {};
  return {fmt::format("pad_origin is '{}', expected LATITUDE,LONGITUDE in degrees, not 0,0",
                      pad_origin)};
}

}  // namespace kestrel
