// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>
#include <string>

#include <opencv2/core.hpp>

#include "kestrel/core/base/time.h"

namespace kestrel {

// Where a video is served, and to whom.
struct VideoServerOptions {
  std::string address = "127.0.0.1";
  int port = 8554;  // 0: any free one
  std::string path = "kestrel";
  std::string password = {};  // for the user "kestrel"; empty: everybody who reaches the address
};

// Serves images as H.264 by RTSP (GStreamer's server), encoded by the hardware where it can. It
// encodes only while somebody looks.
class VideoServer {
 public:
  // Throws InputError when the port is taken, or there is no encoder.
  explicit VideoServer(const VideoServerOptions& options);
  ~VideoServer();
  VideoServer(const VideoServer&) = delete;
  VideoServer& operator=(const VideoServer&) = delete;

  // True while a client plays the video. Called by any thread.
  bool IsWatched() const;

  // Sends an image (CV_8UC3, BGR), all of one size, with the time of its capture. It is dropped
  // when the encoder is busy. Called by one thread.
  void Show(const cv::Mat& image, Time captured);

  // Time from the capture of the newest image until it was encoded; 0 before the first one. Called
  // by any thread.
  Duration delay() const;

  int port() const;
  // Name of GStreamer's element that encodes.
  const std::string& encoder() const;

 private:
  class Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace kestrel
