// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/flight/doctor/computer_checks.h"

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sys/statvfs.h>
#include <sys/timex.h>
#include <system_error>
#include <thread>
#include <unistd.h>
#include <vector>

#include <fmt/format.h>

#include "kestrel/comms/mavlink/file_descriptor.h"
#include "kestrel/core/base/time.h"
#include "kestrel/flight/doctor/statistics.h"

namespace kestrel {
namespace {

namespace fs = std::filesystem;

constexpr int kSinceStart = 16;  // shift from a bit "now" to its bit "since start" (Raspberry Pi)

// Returns the highest temperature of all thermal zones, deg C.
std::optional<double> HottestZone(const fs::path& root) {
  constexpr double kMilli = 1e-3;
  constexpr double kMostPlausible = 150;
  std::optional<double> hottest;
  std::error_code error;
  for (const auto& zone : fs::directory_iterator(root / "sys/class/thermal", error)) {
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

std::optional<std::uint32_t> ThrottledFlags(const fs::path& root) {
  std::ifstream file(root / "sys/devices/platform/soc/soc:firmware/get_throttled");
  std::uint32_t flags = 0;
  if (!(file >> std::hex >> flags)) return std::nullopt;
  return flags;
}

// The alarm of the supply of a Raspberry Pi whose kernel has no flags.
bool HasVoltageAlarm(const fs::path& root) {
  std::error_code error;
  for (const auto& sensor : fs::directory_iterator(root / "sys/class/hwmon", error)) {
    std::string name;
    int alarm = 0;
    std::ifstream(sensor.path() / "name") >> name;
    if (name == "rpi_volt" && std::ifstream(sensor.path() / "in0_lcrit_alarm") >> alarm) {
      return alarm != 0;
    }
  }
  return false;
}

// Returns the existing folder in which an existing or future folder is.
fs::path ExistingPart(const std::string& folder) {
  std::error_code error;
  fs::path path = fs::absolute(folder, error);
  while (!path.empty() && !fs::exists(path, error) && path != path.parent_path()) {
    path = path.parent_path();
  }
  return path;
}

// Returns the free room on the disk of an existing or future folder, MB.
std::optional<double> FreeDisk(const std::string& folder) {
  constexpr double kMega = 1e6;
  std::error_code error;
  const fs::space_info space = fs::space(ExistingPart(folder), error);
  if (error) return std::nullopt;
  return static_cast<double>(space.available) / kMega;
}

bool IsReadOnly(const std::string& folder) {
  struct statvfs status {};
  return statvfs(ExistingPart(folder).c_str(), &status) == 0 && (status.f_flag & ST_RDONLY) != 0;
}

// Returns the used share of the life of the most worn card: cards and eMMC report it in tenths, SD
// cards mostly do not.
std::optional<double> WearOfCards(const fs::path& root) {
  std::optional<double> worst;
  std::error_code error;
  for (const auto& block : fs::directory_iterator(root / "sys/block", error)) {
    std::ifstream file(block.path() / "device/life_time");
    for (int tenths = 0; file >> std::hex >> tenths;) {
      if (tenths > 0) worst = std::max(worst.value_or(0), tenths / 10.0);
    }
  }
  return worst;
}

bool IsTimeSynchronized() {
  timex state{};
  return adjtimex(&state) != TIME_ERROR && (state.status & STA_UNSYNC) == 0;
}

}  // namespace

std::optional<double> MeasureDisk(const std::string& record) {
  constexpr int kMegabytes = 8;
  std::string path = (ExistingPart(record) / ".kestrel_XXXXXX").string();
  const FileDescriptor file(mkstemp(path.data()));
  if (!file.is_open()) return std::nullopt;
  unlink(path.c_str());
  const std::vector<char> megabyte(1'000'000, 'k');
  const Time begin = Now();
  for (int i = 0; i < kMegabytes; ++i) {
    if (write(file.number(), megabyte.data(), megabyte.size()) < 0) return std::nullopt;
  }
  if (fdatasync(file.number()) != 0) return std::nullopt;
  return kMegabytes / std::max(ToSeconds(Now() - begin), 1e-6);
}

ComputerObservations ObserveComputer(const std::string& record, const fs::path& root) {
  ComputerObservations computer;
  computer.cores = std::max(1U, std::thread::hardware_concurrency());
  double load = 0;
  if (getloadavg(&load, 1) == 1) computer.load = load;
  computer.hottest_c = HottestZone(root);
  computer.throttled = ThrottledFlags(root);
  computer.has_low_voltage = HasVoltageAlarm(root);
  computer.is_time_synchronized = IsTimeSynchronized();
  std::error_code ignored;
  computer.has_battery_clock = fs::exists(root / "dev/rtc0", ignored);
  if (record.empty()) return computer;
  computer.free_disk_mb = FreeDisk(record);
  computer.is_disk_read_only = IsReadOnly(record);
  computer.disk_wear = WearOfCards(root);
  return computer;
}

Finding CheckDetectionTime(const DoctorObservations& observations) {
  constexpr double kComfortable = 0.6;  // share of the frame period
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
  constexpr double kBusy = 1.5;  // processes per core
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
  // Flags of the Raspberry Pi: frequency capped, throttled, soft limit of the temperature.
  constexpr std::uint32_t kSlowed = 0xe;
  const std::string check = "heat";
  if (!computer.hottest_c && !computer.throttled) return NotChecked(check, "no sensor");
  const std::string measured = computer.hottest_c ? fmt::format("{:.0f} deg C", *computer.hottest_c)
                                                  : std::string("no thermometer");
  const std::uint32_t flags = computer.throttled.value_or(0);
  const std::string advice = "a heat sink and air";
  const double heat = computer.hottest_c.value_or(0);
  if ((flags & kSlowed) != 0 || heat > kTooHot) return Wrong(check, measured + ": slowed", advice);
  if ((flags >> kSinceStart & kSlowed) != 0) {
    return Doubtful(check, measured + ": was slowed since it was started", advice);
  }
  if (heat > kHot) return Doubtful(check, measured, advice);
  return Good(check, measured);
}

Finding CheckPower(const ComputerObservations& computer) {
  constexpr std::uint32_t kUndervoltage = 1;
  const std::string check = "power";
  const std::uint32_t flags = computer.throttled.value_or(0);
  const std::string advice =
      "a supply of 5.1 V that holds under load (5 A for a Pi 5), short and thick wires: it stops "
      "in "
      "flight otherwise";
  if (computer.has_low_voltage || (flags & kUndervoltage) != 0) {
    return Wrong(check, "undervoltage now", advice);
  }
  if ((flags >> kSinceStart & kUndervoltage) != 0) {
    return Doubtful(check, "undervoltage since it was started", advice);
  }
  return computer.throttled ? Good(check, "no undervoltage") : NotChecked(check, "no sensor");
}

Finding CheckDisk(const DoctorObservations& observations) {
  constexpr double kFlight_s = 900;
  constexpr double kCompressed = 0.6;
  constexpr double kRate_hz = 20;
  constexpr double kWorn = 0.9;
  const std::string check = "disk";
  const ComputerObservations& computer = observations.computer;
  if (observations.use.record.empty()) return NotChecked(check, "nothing is recorded", "--record");
  if (!computer.free_disk_mb) return Wrong(check, "cannot be read", "the folder of --record");
  const double needed_mb =
      computer.least_disk_mb + kFlight_s * kRate_hz * kCompressed * computer.frame_mb;
  if (computer.is_disk_read_only) {
    return Wrong(
        check, "can only be read",
        "a card with errors is mounted so: dmesg, fsck, another card; else mount it with rw");
  }
  std::string measured = fmt::format("{:.0f} MB free, a flight of {:.0f} min needs {:.0f}",
                                     *computer.free_disk_mb, kFlight_s / 60, needed_mb);
  const double needed_mb_per_s = kRate_hz * kCompressed * computer.frame_mb;
  if (computer.disk_mb_per_s) {
    measured +=
        fmt::format("; {:.0f} MB/s, {:.0f} needed", *computer.disk_mb_per_s, needed_mb_per_s);
  }
  const std::string advice =
      "remove old recordings, or fly.recorder.compression=jpg (a fifth of the size)";
  if (*computer.free_disk_mb < computer.least_disk_mb) return Wrong(check, measured, advice);
  if (*computer.free_disk_mb < needed_mb) return Doubtful(check, measured, advice);
  if (computer.disk_mb_per_s.value_or(needed_mb_per_s) < needed_mb_per_s) {
    return Doubtful(check, measured + ": too slow, images will be dropped",
                    "a faster card (A2, V30) or a USB 3 drive, or fly.recorder.compression=jpg");
  }
  if (computer.disk_wear.value_or(0) >= kWorn) {
    return Doubtful(check,
                    fmt::format("{}; {:.0f} % of the card's life is used", measured,
                                kPercent * *computer.disk_wear),
                    "another card, before this one loses a flight");
  }
  return Good(check, measured);
}

Finding CheckTimeOfDay(const ComputerObservations& computer) {
  const std::string check = "time of day";
  if (!computer.is_time_synchronized) return NotChecked(check, "not requested");
  if (*computer.is_time_synchronized) return Good(check, "synchronised");
  return Doubtful(
      check,
      computer.has_battery_clock ? "not synchronised" : "not synchronised, and no battery clock",
      "recordings get a wrong date, and signed packets are refused when it is a minute off: NTP "
      "before the flight (timedatectl), chrony with the GNSS, or a clock with a battery");
}

std::vector<Finding> CheckComputer(const DoctorObservations& observations) {
  std::vector<Finding> findings = {
      CheckDetectionTime(observations), CheckLoad(observations.computer),
      CheckHeat(observations.computer), CheckPower(observations.computer)};
  const bool is_recorded = !observations.use.record.empty();
  if (is_recorded) findings.push_back(CheckDisk(observations));
  if (is_recorded || observations.link.is_signed) {
    findings.push_back(CheckTimeOfDay(observations.computer));
  }
  return findings;
}

}  // namespace kestrel
