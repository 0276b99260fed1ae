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

// The files of web/page, which the build puts into the program.
std::span<const WebAsset> WebAssets();

}  // namespace kestrel
