// SPDX-License-Identifier: BSD-3-Clause
// Any content of a file of a board of tags gives a board that can be looked for and printed, or one
// with violations, or is refused with an InputError.
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string>

#include "kestrel/core/base/error.h"
#include "kestrel/vision/tags/board_model.h"
#include "kestrel/vision/tags/tag_print.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string text(reinterpret_cast<const char*>(data), size);
  try {
    const kestrel::TagBoard board = kestrel::ParseTagBoard(text, "fuzz", "tag36h11", 0.5);
    if (!board.Validate().empty()) return 0;
    kestrel::PrintOf(board);
    if (kestrel::BoardModel(board).tags.size() != board.tags.size()) std::abort();
  } catch (const kestrel::InputError&) {
  }
  return 0;
}
