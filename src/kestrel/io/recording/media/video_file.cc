// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/io/recording/media/video_file.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <gst/app/gstappsrc.h>
#include <utility>

#include <fmt/format.h>

#include "kestrel/core/base/error.h"
#include "kestrel/io/recording/media/gstreamer.h"

namespace kestrel {
namespace {

constexpr int kRateParts = 100;  // the rate is in 1/100 Hz

// vp9enc would lose the images in its look-ahead at the end. mp4mux needs properties of VP9
// that vp9enc does not set, and crashes without the chroma site.
constexpr const char* kVp9InMp4 =
    "video/x-raw,format=I420,colorimetry=bt601 ! "
    "vp9enc deadline=1 cpu-used=9 lag-in-frames=0 end-usage=cq cq-level=24 "
    "target-bitrate=20000000 ! "
    "capssetter caps=\"video/x-vp9,chroma-format=(string)4:2:0,chroma-site=(string)mpeg2,"
    "bit-depth-luma=(uint)8,bit-depth-chroma=(uint)8\" ! mp4mux";
// JPEG uses the full range of values.
constexpr const char* kJpegInAvi =
    "video/x-raw,format=I420,colorimetry=1:4:0:0 ! jpegenc quality=85 ! avimux";

std::string PipelineText(VideoFormat format) {
  return fmt::format("appsrc name=images format=time ! videoconvert ! {} ! filesink name=file",
                     format == VideoFormat::kMp4 ? kVp9InMp4 : kJpegInAvi);
}

}  // namespace

class VideoFile::Encoder {
 public:
  // Throws InputError when GStreamer lacks an element of the pipeline.
  Encoder(GstElementPointer pipeline, std::string path, const cv::Size& size, double rate_hz)
      : path_(std::move(path)),
        pipeline_(std::move(pipeline)),
        images_(gst_bin_get_by_name(GST_BIN(pipeline_.get()), "images")),
        watch_(pipeline_.get()) {
    const GstElementPointer file(gst_bin_get_by_name(GST_BIN(pipeline_.get()), "file"));
    g_object_set(file.get(), "location", path_.c_str(), nullptr);
    gst_video_info_set_format(&info_, GST_VIDEO_FORMAT_BGR, size.width, size.height);
    info_.fps_n = static_cast<int>(std::lround(kRateParts * rate_hz));
    info_.fps_d = kRateParts;
    const GstCapsPointer caps(gst_video_info_to_caps(&info_));
    gst_app_src_set_caps(source(), caps.get());
    gst_element_set_state(pipeline_.get(), GST_STATE_PLAYING);
  }
  ~Encoder() { gst_element_set_state(pipeline_.get(), GST_STATE_NULL); }
  Encoder(const Encoder&) = delete;
  Encoder& operator=(const Encoder&) = delete;

  void Write(const cv::Mat& image) {
    looks_ = 0;
    WaitForRoom();
    GstBufferPointer buffer = BufferOf(image, info_);
    if (!buffer) throw InputError(path_ + ": no memory for an image");
    GST_BUFFER_PTS(buffer.get()) = TimeOf(count_);
    GST_BUFFER_DURATION(buffer.get()) = TimeOf(count_ + 1) - TimeOf(count_);
    ++count_;
    gst_app_src_push_buffer(source(), buffer.release());
  }

  void Finish() {
    looks_ = 0;
    gst_app_src_end_of_stream(source());
    while (!watch_.has_ended()) Look();
  }

 private:
  GstAppSrc* source() const { return GST_APP_SRC(images_.get()); }
  GstClockTime TimeOf(guint64 image) const {
    return gst_util_uint64_scale(image, GST_SECOND * info_.fps_d, info_.fps_n);
  }
  // Images must not pile up before the encoder, and its errors must be noticed.
  void WaitForRoom() {
    constexpr guint64 kQueued = 4;
    watch_.Poll();
    ThrowFault();
    while (gst_app_src_get_current_level_buffers(source()) >= kQueued) Look();
  }
  void Look() {
    constexpr int kMost = 60'000;
    watch_.Poll(std::chrono::milliseconds(1));
    ThrowFault();
    if (++looks_ > kMost) throw InputError(path_ + ": cannot be written: no progress for 60 s");
  }
  void ThrowFault() const {
    if (watch_.fault().empty()) return;
    throw InputError(fmt::format("{}: cannot be written: {}", path_, watch_.fault()));
  }

  std::string path_;
  GstElementPointer pipeline_;
  GstElementPointer images_;
  GstWatch watch_;
  GstVideoInfo info_{};
  guint64 count_ = 0;
  int looks_ = 0;  // without progress, one millisecond each
};

VideoFile::VideoFile(const std::string& stem, double rate_hz, VideoFormat format)
    : stem_(stem),
      rate_hz_(std::round(std::clamp(rate_hz, 1.0, 240.0) * kRateParts) / kRateParts),
      format_(format) {}

VideoFile::~VideoFile() {
  try {
    Close();
  } catch (const InputError&) {  // callers that want the error call Close themselves
  }
}

void VideoFile::Write(const cv::Mat& image) {
  if (!encoder_) Open(image.size());
  if (image.size() != size_) throw InputError(path_ + ": expected images of one size");
  encoder_->Write(image);
}

void VideoFile::Close() {
  if (const auto encoder = std::exchange(encoder_, nullptr)) encoder->Finish();
}

void VideoFile::Open(const cv::Size& size) {
  size_ = size;
  const std::filesystem::path folder = std::filesystem::absolute(stem_).parent_path();
  if (!std::filesystem::is_directory(folder)) {
    throw InputError(stem_ + ": cannot be written: there is no folder " + folder.string());
  }
  if (format_ == VideoFormat::kMp4 && OpenAs(VideoFormat::kMp4, size)) return;
  if (OpenAs(VideoFormat::kAvi, size)) return;
  throw InputError(path_ +
                   ": cannot be written: GStreamer has no encoder (its \"good\" plugins); "
                   "images (--annotate=images) need none");
}

bool VideoFile::OpenAs(VideoFormat format, const cv::Size& size) {
  path_ = stem_ + (format == VideoFormat::kMp4 ? ".mp4" : ".avi");
  GstElementPointer pipeline;
  try {
    pipeline = ParsePipeline(PipelineText(format), path_);
  } catch (const InputError&) {
    return false;
  }
  encoder_ = std::make_unique<Encoder>(std::move(pipeline), path_, size, rate_hz_);
  return true;
}

}  // namespace kestrel
