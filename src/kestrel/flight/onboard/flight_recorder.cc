// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/flight/onboard/flight_recorder.h"

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <fstream>
#include <sys/statvfs.h>
#include <system_error>
#include <utility>

#include <fmt/format.h>

#include "kestrel/core/base/error.h"
#include "kestrel/core/base/options.h"
#include "kestrel/core/base/violations.h"
#include "kestrel/core/base/write_file.h"
#include "kestrel/core/codec/png_codec.h"
#include "kestrel/io/recording/euroc_text.h"
#include "kestrel/io/recording/recording_writer.h"

namespace kestrel {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kRecords = 4096;  // several seconds of any autopilot
constexpr double kPoseRate_hz = 50;     // as requested from the autopilot

void RequireDone(const std::error_code& error, const fs::path& folder) {
  if (!error) return;
  throw InputError(fmt::format("{}: cannot be written: {}", folder.string(), error.message()));
}

fs::path MadeFolder(const fs::path& folder, bool replace, const FlightRecorderOptions& options) {
  RequireValid(options);
  RequireFreeForRecording(folder, replace);
  std::error_code error;
  fs::create_directories(folder, error);
  RequireDone(error, folder);
  return folder;
}

// Removes an existing recording, and makes the folders of a new one.
void MakeParts(const fs::path& folder) {
  std::error_code error;
  for (const char* old : {"mav0", "mavlink.tlog"}) {
    if (!error) fs::remove_all(folder / old, error);
  }
  for (const char* part :
       {"cam0/data", "nav0", "state_groundtruth_estimate0", "landing_pattern0"}) {
    if (!error) fs::create_directories(folder / "mav0" / part, error);
  }
  RequireDone(error, folder);
}

std::vector<RecordedFiles::File> FilesOf(const fs::path& folder) {
  const fs::path root = folder / "mav0";
  return {{root / "cam0/data.csv", "#timestamp [ns],filename\n"},
          {root / "cam0/exposure.csv", "#timestamp [ns],exposure [s]\n"},
          {root / "cam0/dropped.csv", "#timestamp [ns],reason\n"},
          {root / "nav0/data.csv", EurocPoseColumns("WB") + "\n"},
          {root / "state_groundtruth_estimate0/data.csv", TrueStateHeader()},
          {root / "landing_pattern0/data.csv", LandingTruthHeader()},
          {folder / "mavlink.tlog", ""}};
}

Duration UtcOffset() {
  return std::chrono::duration_cast<Duration>(std::chrono::system_clock::now().time_since_epoch()) -
         Now().time_since_epoch();
}

}  // namespace

std::vector<std::string> FlightRecorderOptions::Validate() const {
  std::vector<std::string> violations;
  if (compression != "png" && compression != "jpg") {
    violations.push_back(fmt::format("compression is '{}', expected png or jpg", compression));
  }
  RequireIn(png_level, 0, 9, "png_level", &violations);
  RequireIn(jpg_quality, 1, 100, "jpg_quality", &violations);
  RequireIn(queue_frames, 1, 1000, "queue_frames", &violations);
  RequireNotNegative(free_space_mb, "free_space_mb", &violations);
  RequireIn(commit_period_s, 0.01, 60, "commit_period_s", &violations);
  AddViolations("thread", thread.Validate(), &violations);
  return violations;
}

FlightRecorder::FlightRecorder(const fs::path& folder, bool replace,
                               const CameraCalibration& calibration, double rate_hz,
                               const FlightRecorderOptions& options, Tell tell)
    : options_(options),
      folder_(MadeFolder(folder, replace, options)),
      lock_(folder_.string()),
      tell_(std::move(tell)),
      utc_offset_(UtcOffset()),
      files_(folder_, FilesOf(folder_)),
      images_(static_cast<std::size_t>(options.queue_frames)),
      records_(kRecords) {
  if (options_.compression == "jpg") jpeg_encoder_.emplace(options_.jpg_quality);
  MakeParts(folder_);
  WriteFile(folder_ / "mav0/cam0/sensor.yaml", EurocCalibrationText(calibration, rate_hz));
  WriteFile(folder_ / "mav0/nav0/sensor.yaml", EurocPoseSensorText(kPoseRate_hz));
  writer_ = std::thread([this] { RunWriter(); });
  committer_ = std::thread([this] { RunCommitter(); });
}

FlightRecorder::~FlightRecorder() {
  is_closing_ = true;
  images_.Close();
  writer_.join();
  {
    const std::lock_guard lock(stop_mutex_);
    is_stopping_ = true;
  }
  stop_.notify_all();
  committer_.join();
}

void FlightRecorder::Say(const std::string& text) const {
  if (tell_) tell_(text);
}

void FlightRecorder::AddFrame(const Frame& frame, const std::optional<TruePattern>& truth) {
  const auto dropped = images_.Push({{"", frame.time, frame.image}, truth});
  if (dropped) Drop(dropped->frame.time, "the disk is too slow");
}

void FlightRecorder::Drop(Time time, const char* reason) {
  drop_count_.fetch_add(1, std::memory_order_relaxed);
  if (records_.Push(Dropped{time, reason})) lost_count_.fetch_add(1, std::memory_order_relaxed);
}

void FlightRecorder::AddPose(const PoseSample& pose) {
  if (records_.Push(pose)) lost_count_.fetch_add(1, std::memory_order_relaxed);
}

void FlightRecorder::AddTruePose(const PoseSample& pose) {
  if (records_.Push(TruePose{pose})) lost_count_.fetch_add(1, std::memory_order_relaxed);
}

void FlightRecorder::AddExposure(Time from, double exposure_s) {
  if (records_.Push(Exposure{from, exposure_s})) {
    lost_count_.fetch_add(1, std::memory_order_relaxed);
  }
}

void FlightRecorder::AddPacket(Time time, std::span<const std::uint8_t> bytes) {
  if (bytes.size() > Packet::kMaxSize) return;
  Packet packet{time, bytes.size(), {}};
  std::copy(bytes.begin(), bytes.end(), packet.bytes.begin());
  if (records_.Push(packet)) lost_count_.fetch_add(1, std::memory_order_relaxed);
}

RecorderCounters FlightRecorder::counters() const {
  return {image_count_, drop_count_, byte_count_, lost_count_};
}

void FlightRecorder::RunWriter() {
  constexpr Duration kIdle = std::chrono::milliseconds(50);
  const std::string refused = SetUpThisThread("recorder", options_.thread);
  if (!refused.empty()) Say(refused);
  for (;;) {
    const bool was_closing = is_closing_;
    const std::optional<RecordedImage> image = images_.Pop(kIdle);
    if (image) Write(*image);
    WriteRecords();
    if (!image && was_closing) return;
  }
}

// Commits in a thread of its own: it takes time, during which images go on being written.
void FlightRecorder::RunCommitter() {
  SetUpThisThread("recorder-sync", {});
  std::string told;
  const Duration period = DurationFromSeconds(options_.commit_period_s);
  for (bool is_last = false; !is_last;) {
    {
      std::unique_lock lock(stop_mutex_);
      is_last = stop_.wait_for(lock, period, [this] { return is_stopping_; });
    }
    const std::string failure = files_.Commit();
    if (!failure.empty() && failure != told) Say("recording: " + failure);
    told = failure;
  }
}

void FlightRecorder::Write(const RecordedImage& image) {
  const Time time = image.frame.time;
  if (!IsNext(kImages, time)) return Drop(time, "not later than the image before");
  if (!HasRoom()) return Drop(time, "the disk is full");
  const std::string name = fmt::format("{}.{}", ToNanoseconds(time), options_.compression);
  if (!WriteImage(image.frame.image, folder_ / "mav0/cam0/data" / name)) {
    return Drop(time, "it could not be written");
  }
  image_count_.fetch_add(1, std::memory_order_relaxed);
  files_.Add(kImages, fmt::format("{},{}\n", ToNanoseconds(time), name));
  if (image.truth) files_.Add(kTruePatterns, LandingTruthRow(*image.truth));
}

// True when there is room for images. After a stop it requires a tenth more, so that writing does
// not switch on and off all the time.
bool FlightRecorder::HasRoom() {
  constexpr double kMore = 1.1;
  if (Now() < next_attempt_) return false;
  struct statvfs disk {};
  if (statvfs(folder_.c_str(), &disk) != 0) return true;  // an attempt to write will show
  const double free_mb =
      1e-6 * static_cast<double>(disk.f_bavail) * static_cast<double>(disk.f_frsize);
  const double floor_mb = options_.free_space_mb * (are_images_stopped_ ? kMore : 1);
  if (free_mb >= floor_mb) return true;
  StopImages(
      fmt::format("{:.0f} MB are free, {:.0f} are to stay", free_mb, options_.free_space_mb));
  return false;
}

void FlightRecorder::StopImages(const std::string& reason) {
  constexpr Duration kPause = std::chrono::seconds(1);
  next_attempt_ = Now() + kPause;
  if (are_images_stopped_.exchange(true)) return;
  Say(fmt::format("recording: no more images, the flight goes on: {}", reason));
}

void FlightRecorder::Encode(const cv::Mat& image) {
  encoded_.clear();
  if (!jpeg_encoder_) return AppendPng(image, options_.png_level, &encoded_);
  if (!jpeg_encoder_->Append(image, &encoded_)) throw InputError("no JPEG of an image");
}

bool FlightRecorder::WriteImage(const cv::Mat& image, const fs::path& path) {
  const fs::path draft = path.string() + ".part";
  try {
    Encode(image);
  } catch (const InputError& error) {
    StopImages(error.what());
    return false;
  }
  std::ofstream file(draft, std::ios::binary | std::ios::trunc);
  file.write(encoded_.data(), static_cast<std::streamsize>(encoded_.size()));
  file.close();
  if (!file || std::rename(draft.c_str(), path.c_str()) != 0) {
    std::error_code ignored;
    fs::remove(draft, ignored);
    StopImages("an image could not be written, is the disk full?");
    return false;
  }
  byte_count_.fetch_add(encoded_.size(), std::memory_order_relaxed);
  if (are_images_stopped_.exchange(false)) Say("recording: there is room again, images go on");
  return true;
}

void FlightRecorder::WriteRecords() {
  while (const std::optional<Record> record = records_.TryPop()) {
    std::visit([this](const auto& each) { WriteRecord(each); }, *record);
  }
}

bool FlightRecorder::IsNext(FileIndex file, Time time) {
  std::optional<Time>& last = last_times_[file];
  if (last && time <= *last) return false;
  last = time;
  return true;
}

void FlightRecorder::WriteRecord(const PoseSample& pose) {
  if (!IsNext(kPoses, pose.time)) return;
  files_.Add(kPoses, EurocPoseCells(pose.time, pose.world_from_body) + "\n");
}

void FlightRecorder::WriteRecord(const TruePose& truth) {
  const PoseSample& pose = truth.pose;
  if (!IsNext(kTruePoses, pose.time)) return;
  files_.Add(kTruePoses, TrueStateRow(pose.time, pose.world_from_body,
                                      pose.motion.value_or(BodyMotion()).velocity_in_world));
}

void FlightRecorder::WriteRecord(const Exposure& exposure) {
  if (!IsNext(kExposures, exposure.from)) return;
  files_.Add(kExposures,
             fmt::format("{},{:.7f}\n", ToNanoseconds(exposure.from), exposure.exposure_s));
}

void FlightRecorder::WriteRecord(const Dropped& dropped) {
  files_.Add(kDropped, fmt::format("{},{}\n", ToNanoseconds(dropped.time), dropped.reason));
}

// A .tlog is a sequence of times (us of UTC, big endian) and packets.
void FlightRecorder::WriteRecord(const Packet& packet) {
  constexpr int kTimeBytes = 8;
  const std::int64_t us = ToNanoseconds(packet.time + utc_offset_) / 1000;
  row_.clear();
  for (int shift = 8 * (kTimeBytes - 1); shift >= 0; shift -= 8) {
    row_ += static_cast<char>(static_cast<std::uint64_t>(us) >> shift);
  }
  row_.append(reinterpret_cast<const char*>(packet.bytes.data()), packet.size);
  files_.Add(kPackets, row_);
}

}  // namespace kestrel
