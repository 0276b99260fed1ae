// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/flight/doctor/computer_checks.h"

#include <filesystem>
#include <fstream>
#include <string>

#include <gtest/gtest.h>

#include "kestrel/core/base/test_folder.h"

namespace kestrel {
namespace {

// The files in which a Raspberry Pi reports its state.
class ComputerChecksTest : public ::testing::Test {
 protected:
  void Write(const std::string& name, const std::string& text) const {
    const std::filesystem::path path = std::filesystem::path(folder_ / "root") / name;
    std::filesystem::create_directories(path.parent_path());
    std::ofstream(path) << text;
  }
  ComputerObservations Observe() const {
    return ObserveComputer(folder_ / "flight", folder_ / "root");
  }

  TestFolder folder_;
};

TEST_F(ComputerChecksTest, ReadsFlagsAlarmWearAndClock) {
  Write("sys/devices/platform/soc/soc:firmware/get_throttled", "50005\n");
  Write("sys/class/hwmon/hwmon0/name", "cpu_thermal\n");
  Write("sys/class/hwmon/hwmon1/name", "rpi_volt\n");
  Write("sys/class/hwmon/hwmon1/in0_lcrit_alarm", "1\n");
  Write("sys/block/mmcblk0/device/life_time", "0x02 0x0a\n");
  Write("dev/rtc0", "");
  const ComputerObservations computer = Observe();
  EXPECT_EQ(computer.throttled, 0x50005);
  EXPECT_TRUE(computer.has_low_voltage);
  EXPECT_EQ(computer.disk_wear, 1.0);
  EXPECT_TRUE(computer.has_battery_clock);
  EXPECT_EQ(CheckPower(computer).verdict, Verdict::kWrong);
  EXPECT_EQ(CheckHeat(computer).verdict, Verdict::kWrong);
}

TEST_F(ComputerChecksTest, DoesNotJudgeComputerWithoutSuchFiles) {
  const ComputerObservations computer = Observe();
  EXPECT_FALSE(computer.throttled);
  EXPECT_FALSE(computer.has_low_voltage);
  EXPECT_FALSE(computer.disk_wear);
  EXPECT_FALSE(computer.has_battery_clock);
  EXPECT_EQ(CheckPower(computer).verdict, Verdict::kNotChecked);
  EXPECT_EQ(CheckHeat(computer).verdict, Verdict::kNotChecked);
}

TEST_F(ComputerChecksTest, MeasuresDiskWithoutLeavingFiles) {
  const auto speed = MeasureDisk(folder_ / "flight");
  ASSERT_TRUE(speed);
  EXPECT_GT(*speed, 0);
  EXPECT_TRUE(std::filesystem::is_empty(std::filesystem::path(folder_ / "x").parent_path()));
  EXPECT_FALSE(MeasureDisk("/proc/flight"));
}

}  // namespace
}  // namespace kestrel
