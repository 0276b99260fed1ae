// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <span>

namespace kestrel {

// Returns the codes of OpenCV's ArUco dictionaries of 'side' x 'side' bits (4 to 7), by id. The
// first bit (upper left, row by row) is the highest; 1 is white. The smaller dictionaries of that
// size are the first of these.
std::span<const std::uint64_t> ArucoCodes(int side);

// The same for an id (0 to 1023) of the original ArUco dictionary of 5 x 5 bits: each row encodes
// two bits of the id.
std::uint64_t OriginalArucoCode(int id);

}  // namespace kestrel
