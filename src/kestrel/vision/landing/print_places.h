// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// Places where a print is compared with an image: numbers that several stages share, and their
// origin.

namespace kestrel {

struct PrintPlaces {
  // Radius of the places inside of the ring, inner radii: beyond the crossing of the arms, before
  // their ends, and clear of the ring's blur.
  static constexpr double kInside = 0.65;
  // Least contrast of the white there, share of that of the ring: dirt and shadows take the rest.
  static constexpr double kLeastInside = 0.2;
  // Share of the white margin around the ring that is used. A board may be smaller than in the
  // options, and beyond it anything may be seen.
  static constexpr double kMargin = 0.6;
  // Least share of the print in view for a print that is not partial.
  static constexpr double kWhole = 0.75;
};

}  // namespace kestrel
