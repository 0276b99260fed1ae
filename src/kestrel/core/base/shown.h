// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <cctype>
#include <cstddef>
#include <string>
#include <string_view>

namespace kestrel {

// Makes text of a file fit for a message: one line of at most 'max_length' characters, then "...".
inline std::string Shown(std::string_view text, std::size_t max_length = 60) {
  std::string shown(text.substr(0, max_length));
  if (text.size() > max_length) shown += "...";
  std::replace_if(
      shown.begin(), shown.end(), [](unsigned char c) { return std::iscntrl(c) != 0; }, '?');
  return shown;
}

}  // namespace kestrel
