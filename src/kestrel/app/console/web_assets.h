// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <span>
#include <string_view>

namespace kestrel {

// A file of the page as it is sent.
struct WebAsset {
  std::string_view path;  // as "/index.html"
  std::string_view type;  // as "text/html; charset=utf-8"
  std::string_view content;
  bool is_gzipped = false;
};

// The files that the build makes of web/ and puts into the program. A build without Node has
// instead one page that says how to get them.
std::span<const WebAsset> WebAssets();

}  // namespace kestrel
