// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/flight/onboard/gstreamer_camera.h"

#include <algorithm>
#include <string_view>
#include <thread>
#include <utility>

#include <fmt/format.h>

#include "kestrel/core/base/error.h"
#include "kestrel/core/base/options.h"
#include "kestrel/flight/onboard/exposure_drive.h"
#include "kestrel/flight/onboard/gstreamer_pipeline.h"
#include "kestrel/flight/onboard/image_pool.h"
#include "kestrel/io/recording/media/video_address.h"
#include "kestrel/io/recording/media/video_device.h"
#include "kestrel/io/recording/media/video_source.h"

namespace kestrel {
namespace {

constexpr std::size_t kPooledImages = 64;  // that vision and the recorder's queue hold at a time
constexpr Duration kMaxReopen = std::chrono::seconds(8);  // longest interval between attempts

// Returns the caps to request from a device.
std::string DeviceCaps(const CameraIntrinsics& calibration, const GstreamerCameraOptions& options) {
  if (!options.device_caps.empty()) return options.device_caps;
  if (calibration.width_px == 0) return "video/x-raw";
  return fmt::format("video/x-raw,width={},height={}", calibration.width_px, calibration.height_px);
}

}  // namespace

GstreamerCamera::GstreamerCamera(const std::string& camera, const CameraIntrinsics& calibration,
                                 PixelFormat format, const GstreamerCameraOptions& options)
    : camera_(camera),
      name_(WithoutPassword(camera)),
      is_network_(IsNetworkVideo(camera)),
      calibration_(calibration),
      format_(format),
      options_(Checked(options)),
      exposure_s_(options.exposure_s),
      images_(std::make_unique<ImagePool>(kPooledImages)),
      back_off_(DurationFromSeconds(options.reopen_s)) {
  constexpr Duration kFirstFrame = std::chrono::seconds(10);
  constexpr Duration kStep = std::chrono::milliseconds(100);  // after which a fault is reported
  if (camera.starts_with(kVideoDevice) && options.exposure_property.empty()) {
    v4l2_exposure_ = std::make_unique<V4l2ExposureActuator>(camera);
  }
  Open();
  const Time deadline = Now() + kFirstFrame;
  while (!first_ && Now() < deadline) first_ = TakeFrame(kStep);
  if (!first_) throw InputError(name_ + ": no frame within 10 s");
}

GstreamerCamera::~GstreamerCamera() = default;

void GstreamerCamera::Open() {
  auto pipeline = std::make_unique<GstreamerPipeline>(
      CameraPipelineText(camera_, DeviceCaps(calibration_, options_)), name_, format_);
  if (!options_.exposure_property.empty()) {
    pipeline->UseExposureProperty(options_.exposure_property, options_.exposure_unit_s);
  }
  StartPipeline(pipeline.get());
  last_arrival_ = Now();
  stream_clock_ = {};  // RTP begins anew
  sender_clock_ = {};
  const std::lock_guard lock(mutex_);
  pipeline_ = std::move(pipeline);
}

// GStreamer's words for a device that does not open do not tell why.
void GstreamerCamera::StartPipeline(GstreamerPipeline* pipeline) const {
  try {
    pipeline->Start();
  } catch (const InputError&) {
    const std::string fault = CameraFault(camera_);
    if (fault.empty()) throw;
    throw InputError(fault);
  }
}

std::optional<Event> GstreamerCamera::Next(Duration timeout) {
  if (has_ended_) return EndOfStream{};
  if (first_) return std::exchange(first_, std::nullopt);
  if (pipeline_) return TakeFrameOrFail(timeout);
  const Time now = Now();
  if (now < next_attempt_) {
    std::this_thread::sleep_for(std::min(timeout, next_attempt_ - now));
    return std::nullopt;
  }
  return Reopen() ? TakeFrameOrFail(timeout) : std::nullopt;
}

std::optional<Event> GstreamerCamera::TakeFrameOrFail(Duration timeout) {
  try {
    return TakeFrame(timeout);
  } catch (const InputError& fault) {
    Fail(fault.what());
    return std::nullopt;
  }
}

// Reopens the pipeline. The camera is back only when a frame has come: 'error_' stays until then.
bool GstreamerCamera::Reopen() {
  try {
    Open();
    return true;
  } catch (const InputError& fault) {
    Fail(fault.what());
    return false;
  }
}

void GstreamerCamera::Fail(const std::string& reason) {
  next_attempt_ = Now() + back_off_;
  back_off_ = std::min(2 * back_off_, kMaxReopen);
  std::unique_ptr<GstreamerPipeline> gone;  // stops without the lock held
  const std::lock_guard lock(mutex_);
  gone = std::exchange(pipeline_, nullptr);
  error_ = reason;
}

std::optional<Event> GstreamerCamera::TakeFrame(Duration timeout) {
  const GstSamplePointer sample = pipeline_->Pull(timeout);
  const Time now = Now();
  if (!sample) {
    const std::string fault = pipeline_->Fault();
    if (!fault.empty()) throw InputError(fault);
    const bool has_ended = pipeline_->HasEnded();
    has_ended_ = has_ended && !pipeline_->is_live();
    if (has_ended_) return EndOfStream{};
    if (has_ended) throw InputError(name_ + ": the camera has stopped");
    const bool has_begun = last_time_ > Time::min();
    if (has_begun && now - last_arrival_ > DurationFromSeconds(options_.stall_s)) {
      throw InputError(fmt::format("{}: no frame for {} s", name_, options_.stall_s));
    }
    return std::nullopt;
  }
  GstVideoInfo info;
  if (gst_video_info_from_caps(&info, gst_sample_get_caps(sample.get())) == FALSE) {
    throw InputError(name_ + ": no images received");
  }
  const bool is_smeared = is_network_ && GstreamerPipeline::IsSmeared(sample.get());
  if (!IsUsable(info.width, info.height, is_smeared)) return std::nullopt;
  const std::uint64_t missed = pipeline_->MissedBefore(sample.get());
  Frame frame;
  frame.image =
      images_->Take({info.width, info.height}, format_ == PixelFormat::kGray ? CV_8UC1 : CV_8UC3);
  if (!CopyPixels(sample.get(), info, &frame.image)) return std::nullopt;
  last_arrival_ = now;
  back_off_ = DurationFromSeconds(options_.reopen_s);
  std::optional<Time> driver_time = pipeline_->DriverTime(sample.get());
  if (is_network_ && driver_time) {
    driver_time = NetworkTime(*driver_time, GstreamerPipeline::SenderTime(sample.get()), now);
  }

  const std::lock_guard lock(mutex_);
  counters_.missed += missed;
  if (!error_.empty()) ++counters_.reopened;
  error_.clear();
  frame.time = CaptureTime(driver_time, now);
  if (frame.time <= last_time_) {  // not later than the last: not needed
    ++counters_.missed;
    return std::nullopt;
  }
  last_time_ = frame.time;
  frame.name = fmt::format("camera/{:06}", counters_.captured++);
  return frame;
}

// A stream that changes its size may change it back, or is another one after the next start.
bool GstreamerCamera::IsUsable(int width_px, int height_px, bool is_smeared) {
  std::string error;
  try {
    if (calibration_.width_px > 0) {
      CheckImageSize(calibration_, width_px, height_px, name_);
    }
  } catch (const InputError& fault) {
    if (last_time_ == Time::min() || !is_network_) throw;
    error = fault.what();
  }
  if (!is_smeared && error.empty()) return true;
  last_arrival_ = Now();
  const std::lock_guard lock(mutex_);
  ++counters_.missed;
  ++counters_.refused;
  if (!error.empty()) error_ = error + ": left out until the stream has that size again";
  return false;
}

// Returns the time of a network's frame on the clock of Now(). 'stamp': by RTP; 'sent': by RTCP.
Time GstreamerCamera::NetworkTime(Time stamp, std::optional<Time> sent, Time now) {
  const Time by_stream = stream_clock_.Map(stamp, now);
  if (!sent) return by_stream;
  // The first report of the sender must not move the times.
  return sender_clock_.Map(*sent, sender_clock_.has_begun() ? now : by_stream);
}

// Returns the capture time. If the driver uses another clock, its times are useless: the arrival is
// used instead.
Time GstreamerCamera::CaptureTime(std::optional<Time> driver_time, Time now) {
  constexpr Duration kOldest = std::chrono::seconds(5);
  constexpr Duration kNewest = std::chrono::milliseconds(100);
  const bool is_plausible =
      driver_time && *driver_time > now - kOldest && *driver_time < now + kNewest;
  if (!is_plausible) ++counters_.untimed;
  const double before_s = 0.5 * exposure_s_.load(std::memory_order_relaxed) + options_.readout_s;
  return (is_plausible ? *driver_time : now) - DurationFromSeconds(before_s);
}

std::string GstreamerCamera::error() const {
  const std::lock_guard lock(mutex_);
  return error_;
}

CaptureCounters GstreamerCamera::counters() const {
  const std::lock_guard lock(mutex_);
  return counters_;
}

bool GstreamerCamera::SetExposure(double exposure_s) {
  bool is_set = false;
  if (v4l2_exposure_) {
    is_set = v4l2_exposure_->SetExposure(exposure_s);
  } else {
    const std::lock_guard lock(mutex_);
    is_set = pipeline_ && pipeline_->SetExposure(exposure_s);
  }
  if (is_set) exposure_s_.store(exposure_s, std::memory_order_relaxed);
  return is_set;
}

}  // namespace kestrel
