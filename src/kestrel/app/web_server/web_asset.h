// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string_view>

namespace kestrel {

// A file of a page as it is sent.
struct WebAsset {
  std::string_view path;  // as "/index.html"
  std::string_view type;  // as "text/html; charset=utf-8"
  std::string_view content;
  bool is_gzipped = false;
};

}  // namespace kestrel
