// SPDX-License-Identifier: BSD-3-Clause
// For any content of a model, a grid, a digit model, a map or a draft, the readers give usable data
// or refuse it.
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string>

#include "kestrel/calibration/color_training/color_draft.h"
#include "kestrel/core/base/error.h"
#include "kestrel/vision/mapping/map_file.h"
#include "kestrel/vision/objects/color/color_grid.h"
#include "kestrel/vision/objects/digits/digit_classifier.h"
#include "kestrel/vision/objects/object_model.h"

namespace {

void ReadModel(const std::string& text) {
  if (!kestrel::ParseObjectModel(text, "objects.yaml").Validate().empty()) std::abort();
}

void ReadGrid(const std::string& text) {
  // A complete grid is too large to be found by chance: the text is repeated.
  std::string bytes;
  while (!text.empty() && bytes.size() < kestrel::ColorGrid::kCells) bytes += text;
  bytes.resize(text.size() % 2 == 0 ? kestrel::ColorGrid::kCells : text.size());
  const auto grid = kestrel::ColorGrid::Parse(bytes, 5, "colors.grid");
  if (grid.labels().size() != kestrel::ColorGrid::kCells) std::abort();
}

void ReadDigits(const std::string& text) {
  for (const auto& shares : kestrel::ParseDigitModel(text, "digits.txt")) {
    for (const float share : shares) {
      if (!(share > 0 && share < 1)) std::abort();
    }
  }
}

void ReadMap(const std::string& text) {
  for (const auto& object : kestrel::ParseObjects(text, "object_map.json")) {
    if (!object.state.allFinite() || !object.covariance.allFinite()) std::abort();
  }
}

void ReadDraft(const std::string& text) {
  const auto draft = kestrel::ParseColorDraft(text, "flight", "draft.yaml");
  const std::string printed = kestrel::PrintColorDraft(draft, "flight");
  const auto again = kestrel::ParseColorDraft(printed, "flight", "printed");
  if (again.strokes().size() != draft.strokes().size()) std::abort();
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string text(reinterpret_cast<const char*>(data), size);
  for (const auto read : {ReadModel, ReadGrid, ReadDigits, ReadMap, ReadDraft}) {
    try {
      read(text);
    } catch (const kestrel::InputError&) {
    }
  }
  return 0;
}
