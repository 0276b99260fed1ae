// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <span>
#include <string_view>

namespace kestrel {

// A file of the page, as it goes out.
struct WebAsset {
  std::string_view path;  // as "/index.html"
  std::string_view type;  // as "text/html; charset=utf-8"
  std::string_view content;
  bool is_gzipped = false;
};

// The files of web/, which the build makes and puts into the program; a page that says how to get
// them where it was built without Node.
std::span<const WebAsset> WebAssets();

}  // namespace kestrel
