// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/flight/doctor/computer_checks.h"

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <system_error>
#include <thread>

#include <fmt/format.h>

#include "kestrel/flight/doctor/statistics.h"

namespace kestrel {
namespace {

namespace fs = std::filesystem;

// Returns the highest temperature of all thermal zones, deg C.
std::optional<double> HottestZone() {
  constexpr double kMilli = 1e-3;
  constexpr double kMostPlausible = 150;
  std::optional<double> hottest;
  std::error_code error;
  for (const auto& zone : fs::directory_iterator("/sys/class/thermal", error)) {
    double temperature = 0;
    std::ifstream file(zone.path() / "temp");
    if (!(file >> temperature)) continue;
    temperature *= kMilli;
    if (temperature > 0 && temperature < kMostPlausible) {
      hottest = std::max(hottest.value_or(temperature), temperature);
    }
  }
  return hottest;
}

std::optional<std::uint32_t> ThrottledFlags() {
  std::ifstream file("/sys/devices/platform/soc/soc:firmware/get_throttled");
  std::uint32_t flags = 0;
  if (!(file >> std::hex >> flags)) return std::nullopt;
  return flags;
}

// Returns the free room on the disk of an existing or future folder, MB.
std::optional<double> FreeDisk(const std::string& folder) {
  constexpr double kMega = 1e6;
  std::error_code error;
  fs::path path = fs::absolute(folder, error);
  while (!path.empty() && !fs::exists(path, error) && path != path.parent_path()) {
    path = path.parent_path();
  }
  const fs::space_info space = fs::space(path, error);
  if (error) return std::nullopt;
  return static_cast<double>(space.available) / kMega;
}

}  // namespace

ComputerObservations ObserveComputer(const std::string& record) {
  ComputerObservations computer;
  computer.cores = std::max(1U, std::thread::hardware_concurrency());
  double load = 0;
  if (getloadavg(&load, 1) == 1) computer.load = load;
  computer.hottest_c = HottestZone();
  computer.throttled = ThrottledFlags();
  if (!record.empty()) computer.free_disk_mb = FreeDisk(record);
  return computer;
}

Finding CheckDetectionTime(const DoctorObservations& observations) {
  constexpr double kComfortable = 0.6;  // of the frames' period
  constexpr double kMostDropped = 0.3;
  const std::string check = "detection time";
  const VisionObservations& vision = observations.vision;
  const auto& frames = observations.camera.frames;
  if (vision.frames < 4 || frames.size() < 4) return NotChecked(check, "too few images");
  const double period_s = ToSeconds(frames.back().arrival - frames.front().arrival) /
                          static_cast<double>(frames.size() - 1);
  const double dropped =
      static_cast<double>(vision.dropped_frames) / (vision.frames + vision.dropped_frames);
  const std::string measured = fmt::format(
      "median {:.1f} ms, 9 of 10 below {:.1f}, of {:.0f} between images; {:.0f} % dropped",
      kMilliseconds * vision.detect_s, kMilliseconds * vision.detect_p90_s,
      kMilliseconds * period_s, kPercent * dropped);
  const std::string advice =
      "fewer or smaller images, nothing else on the computer (fly.vision_thread gives the vision a "
      "core of its own), landing.detector.max_search_ms";
  if (vision.detect_s > period_s) return Wrong(check, measured, advice);
  if (vision.detect_p90_s > kComfortable * period_s || dropped > kMostDropped) {
    return Doubtful(check, measured, advice);
  }
  return Good(check, measured);
}

Finding CheckLoad(const ComputerObservations& computer) {
  constexpr double kBusy = 1.5;  // of the cores
  const std::string check = "load";
  const std::string measured =
      fmt::format("{:.1f} processes on {} cores", computer.load, computer.cores);
  const std::string advice = "stop what is not needed in flight: desktop, updates, logging (top)";
  if (computer.load > kBusy * computer.cores) return Doubtful(check, measured, advice);
  return Good(check, measured);
}

Finding CheckHeat(const ComputerObservations& computer) {
  constexpr double kHot = 78;
  constexpr double kTooHot = 90;
  constexpr std::uint32_t kNow = 0xf;        // low voltage, capped, throttled, soft limit: now
  constexpr std::uint32_t kSince = 0xf0000;  // the same since the start
  const std::string check = "heat, power";
  if (!computer.hottest_c && !computer.throttled) return NotChecked(check, "no sensor");
  std::string measured = computer.hottest_c ? fmt::format("{:.0f} deg C", *computer.hottest_c)
                                            : std::string("no thermometer");
  const std::uint32_t flags = computer.throttled.value_or(0);
  if (computer.throttled) measured += fmt::format(", flags {:#x}", flags);
  const std::string advice = "a heat sink and air, a supply of 5 V that holds under load";
  const double heat = computer.hottest_c.value_or(0);
  if ((flags & kNow) != 0 || heat > kTooHot) return Wrong(check, measured + ": slowed", advice);
  if ((flags & kSince) != 0) {
    return Doubtful(check, measured + ": was slowed since it was started", advice);
  }
  if (heat > kHot) return Doubtful(check, measured, advice);
  return Good(check, measured);
}

Finding CheckDisk(const DoctorObservations& observations) {
  constexpr double kFlight_s = 900;
  constexpr double kCompressed = 0.6;
  constexpr double kRate_hz = 20;
  const std::string check = "disk";
  const ComputerObservations& computer = observations.computer;
  if (observations.use.record.empty()) return NotChecked(check, "nothing is recorded", "--record");
  if (!computer.free_disk_mb) return Wrong(check, "cannot be asked", "the folder of --record");
  const double needed_mb =
      computer.least_disk_mb + kFlight_s * kRate_hz * kCompressed * computer.frame_mb;
  const std::string measured = fmt::format("{:.0f} MB free, a flight of {:.0f} min needs {:.0f}",
                                           *computer.free_disk_mb, kFlight_s / 60, needed_mb);
  const std::string advice =
      "remove old recordings, or fly.recorder.compression=jpg (a fifth of the size)";
  if (*computer.free_disk_mb < computer.least_disk_mb) return Wrong(check, measured, advice);
  if (*computer.free_disk_mb < needed_mb) return Doubtful(check, measured, advice);
  return Good(check, measured);
}

std::vector<Finding> CheckComputer(const DoctorObservations& observations) {
  std::vector<Finding> findings = {CheckDetectionTime(observations),
                                   CheckLoad(observations.computer),
                                   CheckHeat(observations.computer)};
  if (!observations.use.record.empty()) findings.push_back(CheckDisk(observations));
  return findings;
}

}  // namespace kestrel
