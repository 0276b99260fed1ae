// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
#include <string>
#include <vector>

namespace kestrel {

// Options for reading a bag.
struct BagChoice {
  std::vector<std::string> topics = {};  // where the types leave a choice
  bool use_arrival_times = false;        // instead of the stamps in the headers
  // Called with what the user should know: what was cut off or left out, one line each. May be
  // empty.
  std::function<void(const std::string&)> notify = {};
};

}  // namespace kestrel
