// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/core/image/bit_image.h"

namespace kestrel {

void CloseBits(BitImage* image, BitImage* scratch) {
  scratch->Reset(image->width(), image->height());
  const int words = image->words_per_row();
  const int last_bits = image->width() % 64;
  const std::uint64_t last_mask = (std::uint64_t{1} << last_bits) - 1;
  // The word before a row's first word and the bits right of the image are clear, so that
  // neighbouring words can be read without a test.
  for (int y = 0; y < image->height(); ++y) {
    const std::uint64_t* here = image->row(y);
    const std::uint64_t* above = image->row(y - 1);
    const std::uint64_t* below = image->row(y + 1);
    std::uint64_t* out = scratch->row(y);
    for (int i = 0; i < words; ++i) {
      const std::uint64_t next = i + 1 < words ? here[i + 1] : 0;
      const std::uint64_t left = here[i] << 1 | here[i - 1] >> 63;
      const std::uint64_t right = here[i] >> 1 | next << 63;
      out[i] = here[i] | left | right | above[i] | below[i];
    }
    out[words - 1] &= last_mask;
  }
  for (int y = 0; y < image->height(); ++y) {
    const std::uint64_t* here = scratch->row(y);
    const std::uint64_t* above = scratch->row(y - 1);
    const std::uint64_t* below = scratch->row(y + 1);
    std::uint64_t* out = image->row(y);
    for (int i = 0; i < words; ++i) {
      const std::uint64_t next = i + 1 < words ? here[i + 1] : 0;
      const std::uint64_t left = here[i] << 1 | here[i - 1] >> 63;
      const std::uint64_t right = here[i] >> 1 | next << 63;
      // Original pixels are never lost, not even at the image border.
      out[i] |= here[i] & left & right & above[i] & below[i];
    }
  }
}

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
