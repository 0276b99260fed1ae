// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/vision/objects/color/color_grid.h"

#include <algorithm>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "kestrel/core/base/error.h"
#include "kestrel/core/base/random.h"
#include "kestrel/core/base/read_file.h"
#include "kestrel/core/base/test_folder.h"
#include "kestrel/vision/objects/object_model.h"

namespace kestrel {
namespace {

using ::testing::HasSubstr;

TEST(ColorGrid, LabelsMatchModel) {
  const ColorModel model = DefaultObjectModel().colors;
  const ColorGrid grid(model);
  Random random(1);
  for (int i = 0; i < 2000; ++i) {
    const auto b = static_cast<std::uint8_t>(4 * random.Integer(0, 63));
    const auto g = static_cast<std::uint8_t>(4 * random.Integer(0, 63));
    const auto r = static_cast<std::uint8_t>(4 * random.Integer(0, 63));
    const auto index = model.Classify(HsvFromBgr(b + 1.5F, g + 1.5F, r + 1.5F));
    const ColorLabel label = grid.At(b, g, r);
    if (index) {
      EXPECT_EQ(label, *index + 1);
    } else {
      EXPECT_TRUE(label == kBackgroundLabel || label == kAmbiguousLabel);
    }
  }
  EXPECT_EQ(grid.At(250, 250, 250), kAmbiguousLabel) << "white";
}

TEST(ColorGrid, SetsAndClearsRegionsOfHueAndSaturation) {
  ColorGrid grid;
  const HueSaturationRegion red{350, 10, 0.5, 1};
  const std::size_t count = grid.SetRegion(red, 3);
  EXPECT_GT(count, 1000U);
  EXPECT_EQ(grid.At(20, 20, 200), 3);
  EXPECT_EQ(grid.At(150, 150, 200), kBackgroundLabel) << "too pale";
  EXPECT_EQ(grid.At(200, 20, 20), kBackgroundLabel) << "blue";
  EXPECT_EQ(grid.ClearRegion(red, 2), 0U) << "another label";
  EXPECT_EQ(grid.ClearRegion(red, 3), count);
  EXPECT_EQ(grid.labels(), ColorGrid().labels());
}

TEST(ColorGrid, SavesAndLoadsRawBytes) {
  const ColorGrid grid(DefaultObjectModel().colors);
  const TestFolder folder;
  const std::string path = folder / "grid.bin";
  grid.Save(path);
  EXPECT_EQ(ReadFile(path).size(), 262144U);
  EXPECT_EQ(ColorGrid::Load(path, 5).labels(), grid.labels());
}

TEST(ColorGrid, StoresRedAsSlowestIndex) {
  std::string bytes(ColorGrid::kCells, '\0');
  bytes[(50 << 12) + (2 << 6) + 1] = 1;
  const ColorGrid grid = ColorGrid::Parse(bytes, 1, "grid");
  EXPECT_EQ(grid.At(1 * 4, 2 * 4, 50 * 4), 1);
}

TEST(ColorGrid, RefusesFilesWithoutGrid) {
  const auto error_of = [](const std::string& bytes) -> std::string {
    try {
      ColorGrid::Parse(bytes, 4, "grid.bin");
    } catch (const InputError& error) {
      return error.what();
    }
    return "";
  };
  EXPECT_EQ(error_of("abc"), "grid.bin: has 3 bytes, a color grid has 262144");
  std::string bytes(ColorGrid::kCells, '\4');
  EXPECT_EQ(error_of(bytes), "");
  bytes[7] = '\5';
  EXPECT_THAT(error_of(bytes), HasSubstr("byte 7 is 5, expected 0 to 4 or 255"));
}

}  // namespace
}  // namespace kestrel
