// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <cctype>
#include <cstddef>
#include <string>
#include <string_view>

namespace kestrel {

// Text of a file as a message can show it: on one line, and not longer than 'max_length'.
inline std::string Shown(std::string_view text, std::size_t max_length = 60) {
  std::string shown(text.substr(0, max_length));
  if (text.size() > max_length) shown += "...";
  std::replace_if(
      shown.begin(), shown.end(), [](unsigned char c) { return std::iscntrl(c) != 0; }, '?');
  return shown;
}

}  // namespace kestrel
