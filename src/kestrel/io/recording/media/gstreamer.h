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

// Smart pointers that own GStreamer's objects.
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

// Returns GStreamer's pipeline for a camera: a device (/dev/video0, with the caps 'device_caps', or
// its own choice if that is empty), an address (see video_address.h) or the text of a pipeline. It
// ends in an appsink.
std::string CameraPipelineText(const std::string& camera, const std::string& device_caps);

// Returns the pipeline of a text. Throws InputError that begins with 'name' when the text is not
// valid or an element is not installed.
GstElementPointer ParsePipeline(const std::string& text, const std::string& name);

// Throws InputError that begins with 'name' when the pipeline has no appsink.
GstElementPointer FindAppSink(GstElement* pipeline, const std::string& name);

// Sets the pixel format that an appsink accepts.
void SetPixelFormat(GstElement* sink, PixelFormat format);

// Returns the next image in the sink; null when none comes within 'timeout'.
GstSamplePointer PullSample(GstElement* sink, Duration timeout);

// Copies a sample's pixels into 'image', which has their size and format. Returns false when they
// cannot be read.
bool CopyPixels(GstSample* sample, const GstVideoInfo& info, cv::Mat* image);

// Returns a buffer with the pixels of a BGR image. 'info': the format BGR, of the image's size.
// Null when there is no memory.
GstBufferPointer BufferOf(const cv::Mat& image, const GstVideoInfo& info);

// Watches the messages of a pipeline.
class GstWatch {
 public:
  explicit GstWatch(GstElement* pipeline) : bus_(gst_element_get_bus(pipeline)) {}

  // Takes the messages; when there are none it waits up to 'timeout'.
  void Poll(Duration timeout = {});

  // The first error, in one line; empty when there is none.
  const std::string& fault() const { return fault_; }
  bool has_ended() const { return has_ended_; }

 private:
  void Take(GstMessage* message);

  GstBusPointer bus_;
  std::string missing_;  // a capability that no plugin of GStreamer has
  std::string fault_;
  bool has_ended_ = false;
};

}  // namespace kestrel
