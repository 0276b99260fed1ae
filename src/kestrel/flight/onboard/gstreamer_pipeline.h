// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "kestrel/core/base/time.h"
#include "kestrel/io/recording/frame.h"
#include "kestrel/io/recording/media/gstreamer.h"

namespace kestrel {

// Sets the exposure by "element.property" of a pipeline.
class GstExposureProperty {
 public:
  // 'unit_s': unit of the property. Throws InputError when the pipeline has no such element or
  // property.
  GstExposureProperty(GstElement* pipeline, const std::string& name, double unit_s);

  // Values outside of the property's range are clamped. Called by any thread.
  void Set(double exposure_s);

 private:
  GstElementPointer element_;
  GParamSpec* property_ = nullptr;
  double unit_s_;
};

// A pipeline of GStreamer that ends in an appsink. It gives out the newest frame, with times on the
// clock of Now(). Errors name 'camera'.
class GstreamerPipeline {
 public:
  // Throws InputError when 'text' is not a pipeline with an appsink.
  GstreamerPipeline(const std::string& text, const std::string& camera, PixelFormat format);
  ~GstreamerPipeline();
  GstreamerPipeline(const GstreamerPipeline&) = delete;
  GstreamerPipeline& operator=(const GstreamerPipeline&) = delete;

  // See GstExposureProperty.
  void UseExposureProperty(const std::string& name, double unit_s);

  // Throws InputError when it does not start.
  void Start();

  // Returns the newest frame that was not yet given out; null when none comes within 'timeout'.
  GstSamplePointer Pull(Duration timeout);

  // Returns the driver's time of the frame; nothing when the buffer has none.
  std::optional<Time> DriverTime(GstSample* sample) const;

  // Returns the time of the frame on the clock of its sender, by RTCP; nothing when there is none.
  static std::optional<Time> SenderTime(GstSample* sample);

  // True for a picture that refers to one that was lost on the way.
  static bool IsSmeared(GstSample* sample);

  // Returns the number of frames lost between the last one and this one: by the source's frame
  // numbers, else by the times.
  std::uint64_t MissedBefore(GstSample* sample);

  // Describes the error in one line; empty as long as there is none.
  std::string Fault();
  bool HasEnded() const;
  bool is_live() const { return is_live_; }

  // False when there is no property for it. Called by any thread.
  bool SetExposure(double exposure_s);

 private:
  void SetUpSink(PixelFormat format);
  void UseMonotonicClock();

  std::string camera_;
  GstElementPointer pipeline_;
  GstElementPointer sink_;
  GstWatch watch_;
  std::optional<GstExposureProperty> exposure_;
  bool is_live_ = true;
  guint64 last_number_ = GST_BUFFER_OFFSET_NONE;
  GstClockTime last_pts_ = GST_CLOCK_TIME_NONE;
};

}  // namespace kestrel
