// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/io/recording/tables/object_csv.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "kestrel/io/recording/tables/csv_table.h"
#include "kestrel/io/recording/tables/object_map_csv.h"

namespace kestrel {
namespace {

ObjectDetection RedDisc() {
  ObjectDetection detection;
  detection.center_px = {100.5, 200.25};
  detection.ellipse = {{100, 200}, 12, 10, 0.5};
  detection.class_probability = 0.9;
  detection.roundness = 1.1;
  detection.circularity = 1.01;
  detection.pixels = 377;
  detection.location = {{1, 2, 3}, 0.04 * Eigen::Matrix3d::Identity()};
  return detection;
}

HuntObservation Observation(const std::vector<ObjectDetection>& detections) {
  HuntObservation observation;
  observation.time = TimeFromNanoseconds(1'500'000'000);
  observation.detect_time = std::chrono::microseconds(250);
  observation.report.detections = detections;
  observation.in_world.resize(detections.size());
  return observation;
}

std::string Cell(const CsvTable& table, std::size_t row, const char* column) {
  const std::size_t index = table.Column(column);
  return table.IsEmpty(row, index) ? "" : std::string(table.Text(row, index));
}

TEST(ObjectCsv, EveryObjectHasRow) {
  HuntObservation observation = Observation({RedDisc(), RedDisc()});
  observation.in_world[1] = ObjectLocation{{10, 20, 0.5}, Eigen::Matrix3d::Identity()};
  const std::string text =
      ObjectCsvHeader() + ObjectCsvRows("a.png", observation, DefaultObjectModel());
  const CsvTable table(text, "csv");
  ASSERT_EQ(table.row_count(), 2u);
  EXPECT_EQ(Cell(table, 0, "frame"), "a.png");
  EXPECT_EQ(Cell(table, 0, "timestamp_ns"), "1500000000");
  EXPECT_EQ(Cell(table, 0, "u_px"), "100.500");
  EXPECT_EQ(Cell(table, 0, "semi_minor_px"), "10.00");
  EXPECT_EQ(Cell(table, 0, "class"), "red");
  EXPECT_EQ(Cell(table, 0, "p_CO_C_z_m"), "3.000000");
  EXPECT_EQ(Cell(table, 0, "p_WO_W_x_m"), "") << "no pose";
  EXPECT_EQ(Cell(table, 0, "sigma_m"), "0.2000");
  EXPECT_EQ(Cell(table, 0, "pixels"), "377");
  EXPECT_EQ(Cell(table, 0, "detect_ms"), "0.2500");
  EXPECT_EQ(Cell(table, 1, "p_WO_W_y_m"), "20.000000");
}

TEST(ObjectCsv, MergedObjectsHaveNoPosition) {
  ObjectDetection merged = RedDisc();
  merged.completeness = Completeness::kMerged;
  merged.location.reset();
  const std::string text =
      ObjectCsvHeader() + ObjectCsvRows("a.png", Observation({merged}), DefaultObjectModel());
  const CsvTable table(text, "csv");
  ASSERT_EQ(table.row_count(), 1u);
  EXPECT_EQ(Cell(table, 0, "class"), "red");
  EXPECT_EQ(Cell(table, 0, "p_CO_C_x_m"), "");
  EXPECT_EQ(Cell(table, 0, "sigma_m"), "");
}

TEST(ObjectCsv, FrameWithoutObjectsHasNameAndTimes) {
  const std::string text =
      ObjectCsvHeader() + ObjectCsvRows("a.png", Observation({}), DefaultObjectModel());
  const CsvTable table(text, "csv");
  ASSERT_EQ(table.row_count(), 1u);
  EXPECT_EQ(Cell(table, 0, "u_px"), "");
  EXPECT_EQ(Cell(table, 0, "pixels"), "");
  EXPECT_EQ(Cell(table, 0, "detect_ms"), "0.2500");
}

TEST(ObjectMapCsv, ColumnsMatchObject) {
  MappedObject object;
  object.id = 7;
  object.state.head<6>() << 1, 2, 3, 0.5, 0, 0;
  object.covariance.diagonal().head<6>() << 0.01, 0.01, 0.01, 1e-4, 1e-4, 1e-4;
  object.moves = true;
  object.detections = 12;
  object.first_seen = TimeFromNanoseconds(5);
  object.last_seen = TimeFromNanoseconds(9);
  const std::string text = ObjectMapCsv({object}, DefaultObjectModel());
  const CsvTable table(text, "csv");
  ASSERT_EQ(table.row_count(), 1u);
  EXPECT_EQ(Cell(table, 0, "id"), "7");
  EXPECT_EQ(Cell(table, 0, "class"), "red");
  EXPECT_EQ(Cell(table, 0, "v_x_mps"), "0.500000");
  EXPECT_EQ(Cell(table, 0, "sigma_m"), "0.1000");
  EXPECT_EQ(Cell(table, 0, "detections"), "12");
  EXPECT_EQ(Cell(table, 0, "first_seen_ns"), "5");
  EXPECT_EQ(Cell(table, 0, "last_seen_ns"), "9");
  EXPECT_EQ(Cell(table, 0, "moving"), "1");
  object.moves = false;
  const std::string unsure = ObjectMapCsv({object}, DefaultObjectModel());
  EXPECT_EQ(Cell(CsvTable(unsure, "csv"), 0, "moving"), "0") << "has a velocity, but may stand";
}

}  // namespace
}  // namespace kestrel
