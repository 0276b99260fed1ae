// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <condition_variable>
#include <cstdint>
#include <cstring>
#include <deque>
#include <gst/app/gstappsrc.h>
#include <gst/rtsp-server/rtsp-server.h>
#include <mutex>
#include <string>
#include <thread>
#include <utility>

#include <fmt/format.h>
#include <opencv2/core.hpp>

#include "kestrel/core/base/random.h"
#include "kestrel/core/base/time.h"

namespace kestrel {

// How a camera's video comes: its encoder, and the line.
struct TestVideoLine {
  Duration delay = std::chrono::milliseconds(0);   // from the capture of an image to its packets
  Duration jitter = std::chrono::milliseconds(0);  // largest addition to that, of each image
  double loss = 0;                                 // share of the packets that are lost
  std::string encoder =
      "x264enc tune=zerolatency speed-preset=ultrafast key-int-max=10 bitrate=600 ! "
      "rtph264pay name=pay0 pt=96 config-interval=-1";
  std::string user = {};  // empty: everybody may see it
  std::string password = {};
  std::uint64_t seed = 1;
};

// A camera that serves images by RTSP, with a clock of its own: GStreamer's server.
class TestRtspServer {
 public:
  explicit TestRtspServer(TestVideoLine line, int port = 0)
      : line_(std::move(line)), random_(line_.seed) {
    gst_init(nullptr, nullptr);
    context_ = g_main_context_new();
    loop_ = g_main_loop_new(context_, FALSE);
    server_ = gst_rtsp_server_new();
    gst_rtsp_server_set_service(server_, std::to_string(port).c_str());
    MountStream();
    if (!line_.user.empty()) RequireUser();
    source_id_ = gst_rtsp_server_attach(server_, context_);
    port_ = gst_rtsp_server_get_bound_port(server_);
    serving_ = std::thread([this] { g_main_loop_run(loop_); });
    sending_ = std::thread([this] { Send(); });
  }
  TestRtspServer(const TestRtspServer&) = delete;
  TestRtspServer& operator=(const TestRtspServer&) = delete;
  ~TestRtspServer() {
    {
      const std::lock_guard lock(mutex_);
      is_over_ = true;
    }
    changed_.notify_all();
    sending_.join();
    const auto remove = [](GstRTSPServer*, GstRTSPClient*, gpointer) {
      return GST_RTSP_FILTER_REMOVE;
    };
    gst_rtsp_server_client_filter(server_, remove, nullptr);
    g_main_loop_quit(loop_);
    serving_.join();
    if (GSource* source = g_main_context_find_source_by_id(context_, source_id_)) {
      g_source_destroy(source);
    }
    if (video_ != nullptr) gst_object_unref(video_);
    g_object_unref(server_);
    g_main_loop_unref(loop_);
    g_main_context_unref(context_);
  }

  int port() const { return port_; }
  std::string address() const { return fmt::format("rtsp://127.0.0.1:{}/main", port_); }

  // Sends a gray image after the delay of the line.
  void Push(const cv::Mat& image, Time captured) {
    const std::lock_guard lock(mutex_);
    const Time due = captured + line_.delay +
                     Duration(static_cast<std::int64_t>(random_.Uniform() * line_.jitter.count()));
    waiting_.push_back({image.clone(), captured, due});
    changed_.notify_all();
  }

 private:
  struct Waiting {
    cv::Mat image;
    Time captured, due;
  };

  void MountStream() {
    GstRTSPMediaFactory* factory = gst_rtsp_media_factory_new();
    gst_rtsp_media_factory_set_launch(
        factory, fmt::format("( appsrc name=video is-live=true format=time ! videoconvert ! "
                             "video/x-raw,format=I420 ! {} )",
                             line_.encoder)
                     .c_str());
    gst_rtsp_media_factory_set_shared(factory, TRUE);
    gst_rtsp_media_factory_set_latency(factory, 0);
    g_signal_connect(factory, "media-configure", G_CALLBACK(Configure), this);
    if (!line_.user.empty()) {
      gst_rtsp_media_factory_add_role(factory, "viewer", GST_RTSP_PERM_MEDIA_FACTORY_ACCESS,
                                      G_TYPE_BOOLEAN, TRUE, GST_RTSP_PERM_MEDIA_FACTORY_CONSTRUCT,
                                      G_TYPE_BOOLEAN, TRUE, nullptr);
    }
    GstRTSPMountPoints* mounts = gst_rtsp_server_get_mount_points(server_);
    gst_rtsp_mount_points_add_factory(mounts, "/main", factory);
    g_object_unref(mounts);
  }

  void RequireUser() {
    GstRTSPAuth* auth = gst_rtsp_auth_new();
    GstRTSPToken* token =
        gst_rtsp_token_new(GST_RTSP_TOKEN_MEDIA_FACTORY_ROLE, G_TYPE_STRING, "viewer", nullptr);
    char* basic = gst_rtsp_auth_make_basic(line_.user.c_str(), line_.password.c_str());
    gst_rtsp_auth_add_basic(auth, basic, token);
    g_free(basic);
    gst_rtsp_token_unref(token);
    gst_rtsp_server_set_auth(server_, auth);
    g_object_unref(auth);
  }

  // A client has come.
  static void Configure(GstRTSPMediaFactory* /*factory*/, GstRTSPMedia* media, gpointer server) {
    auto* self = static_cast<TestRtspServer*>(server);
    GstElement* bin = gst_rtsp_media_get_element(media);
    GstElement* payloader = gst_bin_get_by_name(GST_BIN(bin), "pay0");
    GstPad* pad = gst_element_get_static_pad(payloader, "src");
    const auto packets =
        static_cast<GstPadProbeType>(GST_PAD_PROBE_TYPE_BUFFER | GST_PAD_PROBE_TYPE_BUFFER_LIST);
    gst_pad_add_probe(pad, packets, Lose, server, nullptr);
    gst_object_unref(pad);
    gst_object_unref(payloader);
    const std::lock_guard lock(self->mutex_);
    if (self->video_ != nullptr) gst_object_unref(self->video_);
    self->video_ = gst_bin_get_by_name(GST_BIN(bin), "video");
    self->size_ = {};
    gst_object_unref(bin);
  }

  static GstPadProbeReturn Lose(GstPad* /*pad*/, GstPadProbeInfo* info, gpointer server) {
    auto* self = static_cast<TestRtspServer*>(server);
    const double loss = self->line_.loss;
    if ((info->type & GST_PAD_PROBE_TYPE_BUFFER_LIST) == 0) {
      return self->losses_.Chance(loss) ? GST_PAD_PROBE_DROP : GST_PAD_PROBE_OK;
    }
    GstBufferList* list = gst_buffer_list_make_writable(GST_PAD_PROBE_INFO_BUFFER_LIST(info));
    for (guint i = gst_buffer_list_length(list); i-- > 0;) {
      if (self->losses_.Chance(loss)) gst_buffer_list_remove(list, i, 1);
    }
    info->data = list;
    return GST_PAD_PROBE_OK;
  }

  void Send() {
    std::unique_lock lock(mutex_);
    while (!is_over_) {
      if (waiting_.empty()) {
        changed_.wait(lock);
        continue;
      }
      const Time now = Now();
      if (waiting_.front().due > now) {
        changed_.wait_for(lock, waiting_.front().due - now);
        continue;
      }
      const Waiting next = std::move(waiting_.front());
      waiting_.pop_front();
      if (video_ != nullptr) SendTo(GST_APP_SRC(video_), next);
    }
  }

  void SendTo(GstAppSrc* video, const Waiting& next) {
    const Duration since =
        next.captured.time_since_epoch() -
        Duration(static_cast<std::int64_t>(gst_element_get_base_time(GST_ELEMENT(video))));
    if (GST_STATE(video) != GST_STATE_PLAYING || since.count() < 0) return;
    if (next.image.size() != size_) {
      size_ = next.image.size();
      GstCaps* caps = gst_caps_new_simple(
          "video/x-raw", "format", G_TYPE_STRING, "GRAY8", "width", G_TYPE_INT, size_.width,
          "height", G_TYPE_INT, size_.height, "framerate", GST_TYPE_FRACTION, 20, 1, nullptr);
      gst_app_src_set_caps(video, caps);
      gst_caps_unref(caps);
    }
    // GStreamer's rows begin at multiples of four bytes.
    const int stride = (size_.width + 3) / 4 * 4;
    GstBuffer* buffer =
        gst_buffer_new_allocate(nullptr, static_cast<gsize>(stride) * size_.height, nullptr);
    for (int y = 0; y < size_.height; ++y) {
      gst_buffer_fill(buffer, static_cast<gsize>(stride) * y, next.image.ptr(y),
                      static_cast<gsize>(size_.width));
    }
    GST_BUFFER_PTS(buffer) = static_cast<GstClockTime>(since.count());
    gst_app_src_push_buffer(video, buffer);
  }

  TestVideoLine line_;
  GMainContext* context_ = nullptr;
  GMainLoop* loop_ = nullptr;
  GstRTSPServer* server_ = nullptr;
  guint source_id_ = 0;
  int port_ = 0;
  Random losses_{7};  // used by the encoder's thread
  std::thread serving_;
  std::thread sending_;

  std::mutex mutex_;  // guards what follows
  std::condition_variable changed_;
  Random random_;
  std::deque<Waiting> waiting_;
  bool is_over_ = false;
  GstElement* video_ = nullptr;  // where the images go; null: no client
  cv::Size size_;
};

}  // namespace kestrel
