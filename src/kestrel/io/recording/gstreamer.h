// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <gst/gst.h>
#include <gst/video/video.h>
#include <memory>
#include <string>
#include <string_view>

#include <opencv2/core.hpp>

#include "kestrel/core/base/time.h"
#include "kestrel/io/recording/frame.h"

namespace kestrel {

// Owners of GStreamer's objects.
struct GstReleaser {
  void operator()(GstBuffer* buffer) const { gst_buffer_unref(buffer); }
  void operator()(GstCaps* caps) const { gst_caps_unref(caps); }
  void operator()(GstSample* sample) const { gst_sample_unref(sample); }
  void operator()(GstMessage* message) const { gst_message_unref(message); }
  void operator()(GError* error) const { g_error_free(error); }
  template <class T>
  void operator()(T* object) const {
    gst_object_unref(object);
  }
};
using GstBufferPointer = std::unique_ptr<GstBuffer, GstReleaser>;
using GstBusPointer = std::unique_ptr<GstBus, GstReleaser>;
using GstCapsPointer = std::unique_ptr<GstCaps, GstReleaser>;
using GstElementPointer = std::unique_ptr<GstElement, GstReleaser>;
using GstMessagePointer = std::unique_ptr<GstMessage, GstReleaser>;
using GstSamplePointer = std::unique_ptr<GstSample, GstReleaser>;

// What a camera is to GStreamer: a device (/dev/video0, which is asked for 'device_caps'; empty:
// for what it likes), an address (rtsp://...) or a pipeline's text. Ends in an appsink.
std::string CameraPipelineText(const std::string& camera, const std::string& device_caps);

// The pipeline of a text. Throws InputError that begins with 'name' when there is none: a fault in
// the text, an element that is not installed.
GstElementPointer ParsePipeline(const std::string& text, const std::string& name);

// Throws InputError that begins with 'name' when the pipeline has none.
GstElementPointer FindAppSink(GstElement* pipeline, const std::string& name);

// The images that an appsink takes.
void SetPixelFormat(GstElement* sink, PixelFormat format);

// The newest image that nobody took yet; null when none comes within 'timeout'.
GstSamplePointer PullSample(GstElement* sink, Duration timeout);

// Copies a sample's pixels into 'image', which has their size and format; false when they cannot be
// read.
bool CopyPixels(GstSample* sample, const GstVideoInfo& info, cv::Mat* image);

// What a pipeline says of itself.
class GstWatch {
 public:
  explicit GstWatch(GstElement* pipeline) : bus_(gst_element_get_bus(pipeline)) {}

  // Takes what was said; waits up to 'timeout' where that is nothing.
  void Poll(Duration timeout = {});

  // The first thing that went wrong, in one line; empty as long as nothing did.
  const std::string& fault() const { return fault_; }
  bool has_ended() const { return has_ended_; }

 private:
  void Take(GstMessage* message);

  GstBusPointer bus_;
  std::string missing_;  // what no plugin of GStreamer can do
  std::string fault_;
  bool has_ended_ = false;
};

}  // namespace kestrel
