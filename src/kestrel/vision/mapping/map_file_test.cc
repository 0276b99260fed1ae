// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/vision/mapping/map_file.h"

#include <filesystem>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "kestrel/core/base/error.h"
#include "kestrel/core/base/read_file.h"
#include "kestrel/core/base/test_folder.h"
#include "kestrel/vision/mapping/test_map.h"

namespace kestrel {
namespace {

using ::testing::HasSubstr;

std::vector<MappedObject> SomeObjects() {
  ObjectMap map(DefaultObjectModel(), {});
  Random random(1);
  for (int i = 0; i < 5; ++i) {
    map.Update(Time(DurationFromSeconds(0.3 * i)),
               std::vector{MeasureNoisily({1, 2, 0}, 0, 0.1, &random),
                           MeasureNoisily({4, 2, 0.1}, 2, 0.1, &random)},
               SeesAll());
  }
  return map.objects();
}

std::string ErrorOf(const std::string& text) {
  try {
    ParseObjects(text, "map.json");
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

TEST(MapFile, RoundTripsExactly) {
  const std::string text = PrintObjects(SomeObjects());
  EXPECT_EQ(PrintObjects(ParseObjects(text, "map")), text);
  EXPECT_TRUE(ParseObjects(PrintObjects({}), "map").empty());
  MappedObject moving = SomeObjects()[1];
  moving.moves = true;
  moving.move_log_odds = 5.25;
  const std::vector<MappedObject> parsed = ParseObjects(PrintObjects({moving}), "map");
  EXPECT_TRUE(parsed.at(0).moves);
  EXPECT_EQ(parsed[0].move_log_odds, 5.25);
}

TEST(MapFile, RefusesFileTruncatedAnywhere) {
  const std::string text = PrintObjects(SomeObjects());
  for (std::size_t size = 0; size + 2 < text.size(); size += 37) {
    EXPECT_NE(ErrorOf(text.substr(0, size)), "") << size;
  }
}

TEST(MapFile, ReportsInvalidValues) {
  const std::string text = PrintObjects(SomeObjects());
  const auto with = [&](const std::string& from, const std::string& to) {
    std::string changed = text;
    return changed.replace(changed.find(from), from.size(), to);
  };
  EXPECT_THAT(ErrorOf(with("disc", "ball")), HasSubstr("'ball' is no shape"));
  EXPECT_THAT(ErrorOf(with("\"kestrel_map\": 3", "\"kestrel_map\": 2")), HasSubstr("format 3"));
  EXPECT_THAT(ErrorOf(with("\"state\": [", "\"state\": [nan, ")), HasSubstr("finite number"));
  EXPECT_THAT(ErrorOf(with("\"covariance\": [", "\"covariance\": [-")), HasSubstr("map.json:2"));
}

TEST(MapFile, FailedSaveKeepsOldFile) {
  const TestFolder folder;
  const std::string path = folder / "map.json";
  SaveObjects(path, SomeObjects());
  const std::string before = ReadFile(path);
  std::filesystem::create_directory(path + ".part");  // where the draft would be written
  EXPECT_THROW(SaveObjects(path, {}), InputError);
  EXPECT_EQ(ReadFile(path), before);
  EXPECT_EQ(LoadObjects(path).size(), 2U);
}

TEST(GeoJson, PlacesObjectsAroundOrigin) {
  std::vector<MappedObject> objects = {SomeObjects()[0]};
  objects[0].state.head<3>() = Eigen::Vector3d(0, 1000, 0);
  const std::string text = PrintGeoJson(objects, DefaultObjectModel(), {0, 10});
  // A minute of latitude at the equator is 1842.9 m.
  EXPECT_THAT(text, HasSubstr("[10.000000000, 0.0090436"));
  EXPECT_THAT(text, HasSubstr("\"class\": \"red\""));
  EXPECT_THAT(text, HasSubstr("\"moving\": false"));
}

}  // namespace
}  // namespace kestrel
