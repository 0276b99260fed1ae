// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/flight/onboard/flight_recorder.h"

#include <algorithm>
#include <chrono>
#include <sys/statvfs.h>
#include <system_error>
#include <utility>

#include <fmt/format.h>

#include "kestrel/core/base/error.h"
#include "kestrel/core/base/options.h"
#include "kestrel/core/codec/png_codec.h"
#include "kestrel/io/recording/euroc/recording_place.h"

namespace kestrel {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kRecords = 4096;  // several seconds of any autopilot
constexpr double kPoseRate_hz = 50;     // as requested from the autopilot
constexpr double kGimbalRate_hz = 50;   // requested; the rows have their own times
constexpr double kZoomRate_hz = 10;     // as above

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

// Returns the folder without the recording that may be in it.
fs::path Emptied(const fs::path& folder) {
  std::error_code error;
  for (const char* old : {"mav0", "mavlink.tlog"}) {
    if (!error) fs::remove_all(folder / old, error);
  }
  RequireDone(error, folder);
  return folder;
}

Duration UtcOffset() {
  return std::chrono::duration_cast<Duration>(std::chrono::system_clock::now().time_since_epoch()) -
         Now().time_since_epoch();
}

}  // namespace

FlightRecorder::FlightRecorder(const fs::path& folder, bool replace,
                               const CameraCalibration& calibration, double rate_hz,
                               const FlightRecorderOptions& options, Notify notify,
                               const std::vector<CameraCalibration>& further)
    : options_(options),
      folder_(MadeFolder(folder, replace, options)),
      lock_(folder_.string()),
      notify_(std::move(notify)),
      utc_offset_(UtcOffset()),
      gimbal_(calibration.gimbal),
      zoom_(calibration.zoom),
      writer_(Emptied(folder_), kEurocTables, 1 + further.size()),
      images_(static_cast<std::size_t>(options.queue_frames)),
      records_(kRecords),
      last_images_(1 + further.size()) {
  if (options_.compression == "jpg") jpeg_encoder_.emplace(options_.jpg_quality);
  if (calibration.intrinsics.width_px > 0) writer_.WriteCamera(calibration, rate_hz);
  for (std::size_t i = 0; i < further.size(); ++i) {
    writer_.WriteCamera(further[i], rate_hz, i + 1);
  }
  writer_.WritePoseSensor(kPoseRate_hz);
  if (zoom_) writer_.WriteZoomSensor(*zoom_, kZoomRate_hz);
  write_thread_ = std::thread([this] { RunWriter(); });
  commit_thread_ = std::thread([this] { RunCommitter(); });
}

FlightRecorder::~FlightRecorder() {
  is_closing_ = true;
  images_.Close();
  write_thread_.join();
  {
    const std::lock_guard lock(stop_mutex_);
    is_stopping_ = true;
  }
  stop_.notify_all();
  commit_thread_.join();
}

void FlightRecorder::Report(const std::string& text) const {
  if (notify_) notify_(text);
}

void FlightRecorder::AddFrame(const Frame& frame, const std::optional<TruePattern>& truth) {
  const auto dropped = images_.Push({{"", frame.time, frame.image, {}, frame.camera}, truth});
  if (dropped) Drop(dropped->frame, "the disk is too slow");
}

void FlightRecorder::Drop(const Frame& frame, const char* reason) {
  drop_count_.fetch_add(1, std::memory_order_relaxed);
  if (!records_.Push(Dropped{frame.time, reason, frame.camera})) return;
  lost_count_.fetch_add(1, std::memory_order_relaxed);
}

void FlightRecorder::AddPose(const PoseSample& pose) {
  if (records_.Push(pose)) lost_count_.fetch_add(1, std::memory_order_relaxed);
}

void FlightRecorder::AddGimbal(const GimbalSample& report) {
  if (records_.Push(report)) lost_count_.fetch_add(1, std::memory_order_relaxed);
}

void FlightRecorder::AddZoom(const ZoomSample& report) {
  if (records_.Push(report)) lost_count_.fetch_add(1, std::memory_order_relaxed);
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
  const std::string refused = SetUpThisThread("recorder", {});
  if (!refused.empty()) Report(refused);
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
  std::string reported;
  const Duration period = DurationFromSeconds(options_.commit_period_s);
  for (bool is_last = false; !is_last;) {
    {
      std::unique_lock lock(stop_mutex_);
      is_last = stop_.wait_for(lock, period, [this] { return is_stopping_; });
    }
    const std::string failure = writer_.Commit();
    if (!failure.empty() && failure != reported) Report("recording: " + failure);
    reported = failure;
  }
}

void FlightRecorder::Write(const RecordedImage& image) {
  const Frame& frame = image.frame;
  if (!IsNext(frame.time, &last_images_[frame.camera])) {
    return Drop(frame, "not later than the image before");
  }
  if (!HasRoom()) return Drop(frame, "the disk is full");
  if (!WriteImage(frame)) return Drop(frame, "it could not be written");
  image_count_.fetch_add(1, std::memory_order_relaxed);
  writer_.ListImage(frame.time, options_.compression, frame.camera);
  if (image.truth) writer_.AddTruePattern(*image.truth);
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
  Report(fmt::format("recording: no more images, the flight goes on: {}", reason));
}

void FlightRecorder::Encode(const cv::Mat& image) {
  encoded_.clear();
  if (!jpeg_encoder_) return AppendPng(image, options_.png_level, &encoded_);
  if (!jpeg_encoder_->Append(image, &encoded_)) throw InputError("no JPEG of an image");
}

bool FlightRecorder::WriteImage(const Frame& frame) {
  try {
    Encode(frame.image);
    writer_.WriteImage(frame.time, options_.compression, encoded_, frame.camera);
  } catch (const InputError& error) {
    StopImages(error.what());
    return false;
  }
  byte_count_.fetch_add(encoded_.size(), std::memory_order_relaxed);
  if (are_images_stopped_.exchange(false)) Report("recording: there is room again, images go on");
  return true;
}

void FlightRecorder::WriteRecords() {
  while (const std::optional<Record> record = records_.TryPop()) {
    std::visit([this](const auto& each) { WriteRecord(each); }, *record);
  }
}

bool FlightRecorder::IsNext(Time time, std::optional<Time>* last) {
  if (*last && time <= **last) return false;
  *last = time;
  return true;
}

void FlightRecorder::WriteRecord(const PoseSample& pose) {
  if (IsNext(kPoses, pose.time)) writer_.AddPose(pose);
}

// The first report says in which frame its yaw is; a recording keeps to that.
void FlightRecorder::WriteRecord(const GimbalSample& report) {
  if (!gimbal_ || !IsNext(kGimbal, report.time)) return;
  if (!yaw_frame_) {
    yaw_frame_ = report.yaw_frame;
    writer_.WriteGimbalSensor(*gimbal_, *yaw_frame_, kGimbalRate_hz);
  }
  if (report.yaw_frame == *yaw_frame_) writer_.AddGimbal(report);
}

void FlightRecorder::WriteRecord(const ZoomSample& report) {
  if (zoom_ && IsNext(kZoom, report.time)) writer_.AddZoom(report);
}

void FlightRecorder::WriteRecord(const TruePose& truth) {
  if (IsNext(kTruePoses, truth.pose.time)) writer_.AddTruePose(truth.pose);
}

void FlightRecorder::WriteRecord(const Exposure& exposure) {
  if (IsNext(kExposures, exposure.from)) writer_.AddExposure(exposure.from, exposure.exposure_s);
}

void FlightRecorder::WriteRecord(const Dropped& dropped) {
  writer_.AddDroppedImage(dropped.time, dropped.reason, dropped.camera);
}

void FlightRecorder::WriteRecord(const Packet& packet) {
  const std::int64_t utc_us = ToNanoseconds(packet.time + utc_offset_) / 1000;
  writer_.AddPacket(utc_us, std::span(packet.bytes).first(packet.size));
}

}  // namespace kestrel
