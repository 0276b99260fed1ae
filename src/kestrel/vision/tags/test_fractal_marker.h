// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

namespace kestrel {

// Returns a fractal marker of two levels as the library ArUco writes it: 10 x 10 bits, and 6 x 6 in
// a square of a third of the side.
inline std::string FractalMarkerText() {
  const std::string outer =
      "0, 1, 0, 1, 1, 1, 1, 1, 1, 1, 0, 0, 1, 1, 1, 1, 1, 0, 0, 1, 0, 1, 1, 1, 1, 1, 1, 1, "
      "1, 0, 0, 0, 1, 0, 0, 0, 0, 1, 1, 1, 0, 1, 1, 0, 0, 0, 0, 1, 0, 1, 0, 0, 1, 0, 0, 0, "
      "0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 1, 1, 0, 1, 1, 1, 1, 1, 1, 0, 0, 0, 1, 0, 1, "
      "0, 1, 0, 1, 1, 1, 1, 0, 0, 1, 1, 0, 0, 0, 0, 1";
  const std::string inner =
      "1, 1, 1, 0, 0, 1, 1, 1, 0, 1, 0, 0, 0, 0, 1, 1, 1, 1, 1, 1, 0, 0, 1, 1, 1, 0, 0, 0, "
      "1, 1, 0, 1, 1, 0, 1, 0";
  return "%YAML:1.0\n---\ncodeid: fractalmarkers\nmInfoType: 2\nfractal_levels: "
         "2\nfractal_external_id: 0\n"
         "markers:\n   - { id:0, bits:[ " +
         outer +
         " ],\n       corners:[ [ -1., 1., 0. ], [ 1., 1., 0. ], [ 1., -1., 0. ], [ -1., -1., 0. ] "
         "],\n"
         "       submarkers_id:[ 1 ] }\n   - { id:1, bits:[ " +
         inner +
         " ],\n       corners:[ [ -0.333333, 0.333333, 0. ], [ 0.333333, 0.333333, 0. ],\n"
         "           [ 0.333333, -0.333333, 0. ], [ -0.333333, -0.333333, 0. ] ],\n"
         "       submarkers_id:[  ] }\n";
}

}  // namespace kestrel
