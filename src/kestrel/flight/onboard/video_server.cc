// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/flight/onboard/video_server.h"

#include <atomic>
#include <chrono>
#include <gst/app/gstappsrc.h>
#include <gst/rtsp-server/rtsp-server.h>
#include <mutex>
#include <thread>

#include <fmt/format.h>

#include "kestrel/core/base/error.h"
#include "kestrel/core/base/thread_setup.h"
#include "kestrel/io/recording/media/gstreamer.h"

namespace kestrel {
namespace {

constexpr char kUser[] = "kestrel", kRole[] = "viewer";
constexpr guint kMostClients = 8;

// Encoders in the order in which they are tried: of the Raspberry Pi, of Jetson boards, of Intel's
// and AMD's graphics, and software. Each sends a whole image once a second.
struct Encoder {
  const char* element;
  const char* text;
};
constexpr Encoder kEncoders[] = {
    {"v4l2h264enc",
     "v4l2h264enc extra-controls=\"controls,video_bitrate=1500000,h264_i_frame_period=15\" ! "
     "video/x-h264,level=(string)4"},
    {"nvv4l2h264enc",
     "nvvidconv ! video/x-raw(memory:NVMM),format=NV12 ! nvv4l2h264enc bitrate=1500000 "
     "iframeinterval=15 insert-sps-pps=true"},
    {"vaapih264enc", "vaapih264enc rate-control=cbr bitrate=1500 keyframe-period=15"},
    {"x264enc",
     "x264enc tune=zerolatency speed-preset=ultrafast threads=1 key-int-max=15 bitrate=1500"},
};

// Whether it encodes an image: an element may be there without its hardware.
bool Works(const Encoder& encoder) {
  constexpr Duration kLongest = std::chrono::seconds(3), kLook = std::chrono::milliseconds(10);
  GstElementFactory* const factory = gst_element_factory_find(encoder.element);
  if (factory == nullptr) return false;
  gst_object_unref(factory);
  try {
    const GstElementPointer pipeline = ParsePipeline(
        fmt::format("videotestsrc num-buffers=1 ! video/x-raw,format=I420,width=320,height=240 ! "
                    "videoconvert ! {} ! fakesink",
                    encoder.text),
        encoder.element);
    GstWatch watch(pipeline.get());
    gst_element_set_state(pipeline.get(), GST_STATE_PLAYING);
    for (const Time start = Now(); !watch.has_ended() && watch.fault().empty();) {
      if (Now() - start > kLongest) break;
      watch.Poll(kLook);
    }
    gst_element_set_state(pipeline.get(), GST_STATE_NULL);
    return watch.has_ended() && watch.fault().empty();
  } catch (const InputError&) {
    return false;
  }
}

const Encoder& FindEncoder() {
  for (const Encoder& encoder : kEncoders) {
    if (Works(encoder)) return encoder;
  }
  throw InputError("video: GStreamer has no encoder of H.264, expected gstreamer1.0-plugins-ugly");
}

}  // namespace

class VideoServer::Impl {
 public:
  explicit Impl(const VideoServerOptions& options) {
    gst_init(nullptr, nullptr);
    const Encoder& encoder = FindEncoder();
    encoder_ = encoder.element;
    context_ = g_main_context_new();
    loop_ = g_main_loop_new(context_, FALSE);
    server_ = gst_rtsp_server_new();
    gst_rtsp_server_set_address(server_, options.address.c_str());
    gst_rtsp_server_set_service(server_, std::to_string(options.port).c_str());
    Mount("/" + options.path, encoder, !options.password.empty());
    if (!options.password.empty()) Require(options.password);
    listening_ = gst_rtsp_server_attach(server_, context_);
    if (listening_ == 0) {
      Release();
      throw InputError(
          fmt::format("video: cannot listen at {} port {}, expected a free port of this "
                      "computer",
                      options.address, options.port));
    }
    ForgetGoneClients();
    thread_ = std::thread([this] {
      SetUpThisThread("rtsp", {});
      g_main_loop_run(loop_);
    });
  }
  Impl(const Impl&) = delete;
  Impl& operator=(const Impl&) = delete;
  ~Impl() {
    const auto remove = [](GstRTSPServer*, GstRTSPClient*, gpointer) {
      return GST_RTSP_FILTER_REMOVE;
    };
    gst_rtsp_server_client_filter(server_, remove, nullptr);
    g_main_loop_quit(loop_);
    thread_.join();
    g_source_destroy(cleaning_);
    g_source_unref(cleaning_);
    if (GSource* source = g_main_context_find_source_by_id(context_, listening_)) {
      g_source_destroy(source);
    }
    Release();
  }

  bool IsWatched() const { return is_watched_; }
  Duration delay() const { return delay_; }
  int port() const { return gst_rtsp_server_get_bound_port(server_); }
  const std::string& encoder() const { return encoder_; }

  // Half of a pair of colours at an odd edge cannot be encoded.
  void Show(const cv::Mat& image, Time captured) {
    const std::lock_guard lock(mutex_);
    if (video_ == nullptr) return;
    auto* const video = GST_APP_SRC(video_);
    const cv::Mat even = image(cv::Rect(0, 0, image.cols / 2 * 2, image.rows / 2 * 2));
    if (even.size() != size_) SetSize(even.size(), video);
    const bool is_busy = gst_app_src_get_current_level_buffers(video) > 0;
    const std::int64_t running_ns =
        ToNanoseconds(captured) -
        static_cast<std::int64_t>(gst_element_get_base_time(GST_ELEMENT(video)));
    if (GST_STATE(video) != GST_STATE_PLAYING || is_busy || running_ns < 0) return;
    GstBufferPointer buffer = BufferOf(even, info_);
    if (!buffer) return;
    GST_BUFFER_PTS(buffer.get()) = static_cast<GstClockTime>(running_ns);
    gst_app_src_push_buffer(video, buffer.release());
  }

 private:
  void Mount(const std::string& path, const Encoder& encoder, bool has_password) {
    GstRTSPMediaFactory* const factory = gst_rtsp_media_factory_new();
    gst_rtsp_media_factory_set_launch(
        factory, fmt::format("( appsrc name=video is-live=true format=time ! videoconvert ! "
                             "video/x-raw,format=I420 ! {} ! "
                             "rtph264pay name=pay0 pt=96 config-interval=-1 )",
                             encoder.text)
                     .c_str());
    gst_rtsp_media_factory_set_shared(factory, TRUE);
    gst_rtsp_media_factory_set_latency(factory, 0);
    g_signal_connect(factory, "media-configure", G_CALLBACK(Begin), this);
    if (has_password) {
      gst_rtsp_media_factory_add_role(factory, kRole, GST_RTSP_PERM_MEDIA_FACTORY_ACCESS,
                                      G_TYPE_BOOLEAN, TRUE, GST_RTSP_PERM_MEDIA_FACTORY_CONSTRUCT,
                                      G_TYPE_BOOLEAN, TRUE, nullptr);
    }
    GstRTSPMountPoints* const mounts = gst_rtsp_server_get_mount_points(server_);
    gst_rtsp_mount_points_add_factory(mounts, path.c_str(), factory);
    g_object_unref(mounts);
  }

  void Require(const std::string& password) {
    GstRTSPAuth* const auth = gst_rtsp_auth_new();
    GstRTSPToken* const token =
        gst_rtsp_token_new(GST_RTSP_TOKEN_MEDIA_FACTORY_ROLE, G_TYPE_STRING, kRole, nullptr);
    char* const basic = gst_rtsp_auth_make_basic(kUser, password.c_str());
    gst_rtsp_auth_add_basic(auth, basic, token);
    g_free(basic);
    gst_rtsp_token_unref(token);
    gst_rtsp_server_set_auth(server_, auth);
    g_object_unref(auth);
  }

  // A client that vanishes, as with the radio, would be sent to for ever.
  void ForgetGoneClients() {
    GstRTSPSessionPool* const pool = gst_rtsp_server_get_session_pool(server_);
    gst_rtsp_session_pool_set_max_sessions(pool, kMostClients);
    g_object_unref(pool);
    constexpr guint kPeriod_s = 5;
    cleaning_ = g_timeout_source_new_seconds(kPeriod_s);
    const auto clean = [](gpointer server) -> gboolean {
      GstRTSPSessionPool* const sessions =
          gst_rtsp_server_get_session_pool(static_cast<GstRTSPServer*>(server));
      gst_rtsp_session_pool_cleanup(sessions);
      g_object_unref(sessions);
      return G_SOURCE_CONTINUE;
    };
    g_source_set_callback(cleaning_, clean, server_, nullptr);
    g_source_attach(cleaning_, context_);
  }

  // The first client has come.
  static void Begin(GstRTSPMediaFactory* /*factory*/, GstRTSPMedia* media, gpointer impl) {
    auto* const self = static_cast<Impl*>(impl);
    const GstElementPointer bin(gst_rtsp_media_get_element(media));
    const GstElementPointer payloader(gst_bin_get_by_name(GST_BIN(bin.get()), "pay0"));
    const std::unique_ptr<GstPad, GstReleaser> pad(
        gst_element_get_static_pad(payloader.get(), "sink"));
    gst_pad_add_probe(pad.get(), GST_PAD_PROBE_TYPE_BUFFER, Measure, impl, nullptr);
    g_signal_connect(media, "unprepared", G_CALLBACK(End), impl);
    const std::lock_guard lock(self->mutex_);
    if (self->video_ != nullptr) gst_object_unref(self->video_);
    self->video_ = gst_bin_get_by_name(GST_BIN(bin.get()), "video");
    self->media_ = media;
    self->size_ = {};
    self->is_watched_ = true;
  }

  // The last client has left.
  static void End(GstRTSPMedia* media, gpointer impl) {
    auto* const self = static_cast<Impl*>(impl);
    const std::lock_guard lock(self->mutex_);
    if (self->media_ != media) return;
    gst_object_unref(self->video_);
    self->video_ = nullptr;
    self->media_ = nullptr;
    self->is_watched_ = false;
  }

  // Encoders shift the times of the buffers, and the segment says by how much.
  static GstPadProbeReturn Measure(GstPad* pad, GstPadProbeInfo* info, gpointer impl) {
    auto* const self = static_cast<Impl*>(impl);
    GstEvent* const event = gst_pad_get_sticky_event(pad, GST_EVENT_SEGMENT, 0);
    if (event == nullptr) return GST_PAD_PROBE_OK;
    const GstSegment* segment = nullptr;
    gst_event_parse_segment(event, &segment);
    const guint64 running_ns = gst_segment_to_running_time(
        segment, GST_FORMAT_TIME, GST_BUFFER_PTS(GST_PAD_PROBE_INFO_BUFFER(info)));
    gst_event_unref(event);
    const GstElementPointer payloader(gst_pad_get_parent_element(pad));
    if (running_ns == GST_CLOCK_TIME_NONE || !payloader) return GST_PAD_PROBE_OK;
    const guint64 captured_ns = gst_element_get_base_time(payloader.get()) + running_ns;
    self->delay_ = Now() - TimeFromNanoseconds(static_cast<std::int64_t>(captured_ns));
    return GST_PAD_PROBE_OK;
  }

  void SetSize(const cv::Size& size, GstAppSrc* video) {
    size_ = size;
    gst_video_info_set_format(&info_, GST_VIDEO_FORMAT_BGR, size.width, size.height);
    const GstCapsPointer caps(gst_video_info_to_caps(&info_));
    gst_app_src_set_caps(video, caps.get());
  }

  void Release() {
    {
      const std::lock_guard lock(mutex_);
      if (video_ != nullptr) gst_object_unref(video_);
      video_ = nullptr;
      media_ = nullptr;
    }
    g_object_unref(server_);
    g_main_loop_unref(loop_);
    g_main_context_unref(context_);
  }

  std::string encoder_;
  GMainContext* context_ = nullptr;
  GMainLoop* loop_ = nullptr;
  GstRTSPServer* server_ = nullptr;
  guint listening_ = 0;
  GSource* cleaning_ = nullptr;
  std::thread thread_;
  std::atomic<bool> is_watched_{false};
  std::atomic<Duration> delay_{Duration::zero()};

  std::mutex mutex_;             // guards what follows
  GstElement* video_ = nullptr;  // where the images go; null: no client
  GstRTSPMedia* media_ = nullptr;
  GstVideoInfo info_{};
  cv::Size size_;
};

VideoServer::VideoServer(const VideoServerOptions& options)
    : impl_(std::make_unique<Impl>(options)) {}
VideoServer::~VideoServer() = default;
bool VideoServer::IsWatched() const { return impl_->IsWatched(); }
void VideoServer::Show(const cv::Mat& image, Time captured) { impl_->Show(image, captured); }
Duration VideoServer::delay() const { return impl_->delay(); }
int VideoServer::port() const { return impl_->port(); }
const std::string& VideoServer::encoder() const { return impl_->encoder(); }

}  // namespace kestrel
