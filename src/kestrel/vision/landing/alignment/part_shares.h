// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>

namespace kestrel {

// Shares, 0 to 1, of the print's parts that look as in the print, by quarter: quarter k is the
// right angle around arm k. Negative where too little of it is in view.
struct PartShares {
  std::array<double, 4> arm{};
  std::array<double, 4> ring{};

  struct Means {
    double worst_arm;  // 0 when no arm is in view
    double arms;       // mean over the arms; 0 when none is in view
    // Mean without the worst quarter, which a highlight or the image border may hide; 1 when none
    // is in view.
    double ring;
  };
  // Returns the means over the parts in view.
  Means MeansInView() const;
};

}  // namespace kestrel
