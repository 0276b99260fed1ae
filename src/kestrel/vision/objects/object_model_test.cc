// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/vision/objects/object_model.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "kestrel/core/base/error.h"

namespace kestrel {
namespace {

using ::testing::HasSubstr;

constexpr char kModel[] = R"(colors:
  - name: red
    components:
      - {weight: 1, mean: [0, 0.8, 0.7], sigma: [8, 0.1, 0.2]}
classes:
  - {name: red, color: red, shape: disc, size_m: 0.2, height_m: 0, score: 1, may_move: false}
)";

std::string ErrorOf(const std::string& yaml) {
  try {
    ParseObjectModel(yaml, "model.yaml");
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

std::string Replaced(std::string text, const std::string& from, const std::string& to) {
  return text.replace(text.find(from), from.size(), to);
}

TEST(ParseObjectModel, RoundTripsThroughText) {
  const ObjectModel model = DefaultObjectModel();
  const std::string text = PrintObjectModel(model);
  const ObjectModel again = ParseObjectModel(text, "again");
  EXPECT_EQ(PrintObjectModel(again), text);
  EXPECT_EQ(again.classes.size(), model.classes.size());
  EXPECT_EQ(again.colors.colors[2].components[0].mean.hue_deg,
            model.colors.colors[2].components[0].mean.hue_deg);
}

TEST(ParseObjectModel, RefusesSizeInMillimetres) {
  EXPECT_THAT(ErrorOf(Replaced(kModel, "size_m: 0.2", "size_m: 200")),
              HasSubstr("class 1 (red): size_m is 200, expected metres: 0.2?"));
}

TEST(ParseObjectModel, KeepsCorrelationOfHueAndSaturation) {
  const std::string yaml =
      Replaced(kModel, "sigma: [8, 0.1, 0.2]", "sigma: [8, 0.1, 0.2], correlation: -0.625");
  const ObjectModel model = ParseObjectModel(yaml, "model.yaml");
  EXPECT_EQ(model.colors.colors[0].components[0].correlation, -0.625);
  const ObjectModel again = ParseObjectModel(PrintObjectModel(model), "again");
  EXPECT_EQ(again.colors.colors[0].components[0].correlation, -0.625);
  EXPECT_EQ(ParseObjectModel(kModel, "old.yaml").colors.colors[0].components[0].correlation, 0);
  EXPECT_THAT(ErrorOf(Replaced(yaml, "-0.625", "1")), HasSubstr("correlation must be in"));
}

TEST(ParseObjectModel, NamesFileLineAndKey) {
  EXPECT_EQ(ErrorOf(kModel), "");
  EXPECT_THAT(ErrorOf(Replaced(kModel, "shape: disc", "shape: star")),
              HasSubstr("model.yaml:6: classes[0].shape: 'star' is no shape"));
  EXPECT_THAT(ErrorOf(Replaced(kModel, "color: red", "color: rad")),
              HasSubstr("'rad' is none of the colors"));
  EXPECT_THAT(ErrorOf(Replaced(kModel, "size_m: 0.2, ", "")), HasSubstr("'size_m' is missing"));
  EXPECT_THAT(ErrorOf(Replaced(kModel, "size_m", "size_cm")), HasSubstr("unknown key 'size_cm'"));
  EXPECT_THAT(ErrorOf(Replaced(kModel, "0.8, 0.7]", "0.8]")), HasSubstr("list of 3 numbers"));
  EXPECT_THAT(ErrorOf(Replaced(kModel, "[0, 0.8", "[0, high")), HasSubstr("finite number"));
  EXPECT_THAT(ErrorOf(Replaced(kModel, "[0, 0.8", "[400, 0.8")), HasSubstr("hue must be in"));
  EXPECT_THAT(ErrorOf("colors: ["), HasSubstr("not YAML"));
  EXPECT_THAT(ErrorOf(""), HasSubstr("expected 'name: value'"));
}

}  // namespace
}  // namespace kestrel
