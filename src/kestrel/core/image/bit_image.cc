// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/core/image/bit_image.h"

namespace kestrel {

void InvertBits(const BitImage& image, BitImage* inverse) {
  inverse->Reset(image.width(), image.height());
  const int whole_words = image.width() / 64;
  const std::uint64_t rest = (std::uint64_t{1} << (image.width() % 64)) - 1;
  for (int y = 0; y < image.height(); ++y) {
    const std::uint64_t* from = image.row(y);
    std::uint64_t* to = inverse->row(y);
    for (int word = 0; word < whole_words; ++word) to[word] = ~from[word];
    to[whole_words] = ~from[whole_words] & rest;
  }
}

}  // namespace kestrel
