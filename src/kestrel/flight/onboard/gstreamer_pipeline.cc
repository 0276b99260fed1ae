// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/flight/onboard/gstreamer_pipeline.h"

#include <algorithm>
#include <cmath>
#include <gst/app/gstappsink.h>
#include <utility>

#include <fmt/format.h>

#include "kestrel/core/base/error.h"

namespace kestrel {
namespace {

using GstClockPointer = std::unique_ptr<GstClock, GstReleaser>;

// Returns the source's number of a frame; GST_BUFFER_OFFSET_NONE where it has none: if the offset
// counts bytes, its end is not one further.
guint64 FrameNumber(const GstBuffer* buffer) {
  const guint64 number = GST_BUFFER_OFFSET(buffer);
  return number + 1 == GST_BUFFER_OFFSET_END(buffer) ? number : GST_BUFFER_OFFSET_NONE;
}

}  // namespace

GstExposureProperty::GstExposureProperty(GstElement* pipeline, const std::string& name,
                                         double unit_s)
    : unit_s_(unit_s) {
  const std::size_t dot = name.find('.');
  const std::string element = name.substr(0, dot);
  element_.reset(gst_bin_get_by_name(GST_BIN(pipeline), element.c_str()));
  if (dot == std::string::npos || !element_) {
    throw InputError(fmt::format(
        "exposure_property is '{}', expected ELEMENT.PROPERTY with an element that the pipeline "
        "names (name={})",
        name, element));
  }
  property_ =
      g_object_class_find_property(G_OBJECT_GET_CLASS(element_.get()), name.c_str() + dot + 1);
  if (property_ == nullptr) {
    throw InputError(
        fmt::format("exposure_property is '{}': element {} has no such property", name, element));
  }
}

void GstExposureProperty::Set(double exposure_s) {
  const GType type = G_PARAM_SPEC_VALUE_TYPE(property_);
  const bool is_real = type == G_TYPE_DOUBLE || type == G_TYPE_FLOAT;
  const double units = exposure_s / unit_s_;
  GValue value = G_VALUE_INIT;
  g_value_init(&value, G_TYPE_DOUBLE);
  g_value_set_double(&value, is_real ? units : std::round(units));
  g_object_set_property(G_OBJECT(element_.get()), property_->name, &value);
  g_value_unset(&value);
}

GstreamerPipeline::GstreamerPipeline(const std::string& text, const std::string& camera,
                                     PixelFormat format)
    : camera_(camera),
      pipeline_(ParsePipeline(text, camera)),
      sink_(FindAppSink(pipeline_.get(), camera)),
      watch_(pipeline_.get()) {
  SetUpSink(format);
  UseMonotonicClock();
}

GstreamerPipeline::~GstreamerPipeline() { gst_element_set_state(pipeline_.get(), GST_STATE_NULL); }

void GstreamerPipeline::UseExposureProperty(const std::string& name, double unit_s) {
  exposure_.emplace(pipeline_.get(), name, unit_s);
}

GstSamplePointer GstreamerPipeline::Pull(Duration timeout) {
  return PullSample(sink_.get(), timeout);
}

std::optional<Time> GstreamerPipeline::DriverTime(GstSample* sample) const {
  const GstClockTime pts = GST_BUFFER_PTS(gst_sample_get_buffer(sample));
  if (!GST_CLOCK_TIME_IS_VALID(pts)) return std::nullopt;
  const GstClockTime running =
      gst_segment_to_running_time(gst_sample_get_segment(sample), GST_FORMAT_TIME, pts);
  if (!GST_CLOCK_TIME_IS_VALID(running)) return std::nullopt;
  const GstClockTime base = gst_element_get_base_time(pipeline_.get());
  return TimeFromNanoseconds(static_cast<std::int64_t>(base + running));
}

std::optional<Time> GstreamerPipeline::SenderTime(GstSample* sample) {
  const GstReferenceTimestampMeta* meta =
      gst_buffer_get_reference_timestamp_meta(gst_sample_get_buffer(sample), nullptr);
  if (meta == nullptr) return std::nullopt;
  return TimeFromNanoseconds(static_cast<std::int64_t>(meta->timestamp));
}

bool GstreamerPipeline::IsSmeared(GstSample* sample) {
  return GST_BUFFER_FLAG_IS_SET(gst_sample_get_buffer(sample), GST_BUFFER_FLAG_CORRUPTED) != FALSE;
}

std::uint64_t GstreamerPipeline::MissedBefore(GstSample* sample) {
  const GstBuffer* buffer = gst_sample_get_buffer(sample);
  const guint64 number = std::exchange(last_number_, FrameNumber(buffer));
  const GstClockTime time = std::exchange(last_pts_, GST_BUFFER_PTS(buffer));
  if (number != GST_BUFFER_OFFSET_NONE && last_number_ != GST_BUFFER_OFFSET_NONE) {
    return last_number_ > number ? last_number_ - number - 1 : 0;
  }
  const GstClockTime period = GST_BUFFER_DURATION(buffer);
  if (!GST_CLOCK_TIME_IS_VALID(time) || !GST_CLOCK_TIME_IS_VALID(last_pts_) ||
      !GST_CLOCK_TIME_IS_VALID(period) || period == 0 || last_pts_ <= time) {
    return 0;
  }
  return std::max<GstClockTime>((last_pts_ - time + period / 2) / period, 1) - 1;
}

bool GstreamerPipeline::HasEnded() const {
  return gst_app_sink_is_eos(GST_APP_SINK(sink_.get())) != FALSE;
}

std::string GstreamerPipeline::Fault() {
  watch_.Poll();
  return watch_.fault().empty() ? "" : fmt::format("{}: {}", camera_, watch_.fault());
}

bool GstreamerPipeline::SetExposure(double exposure_s) {
  if (exposure_) exposure_->Set(exposure_s);
  return exposure_.has_value();
}

void GstreamerPipeline::SetUpSink(PixelFormat format) {
  GstAppSink* sink = GST_APP_SINK(sink_.get());
  SetPixelFormat(sink_.get(), format);
  gst_app_sink_set_max_buffers(sink, 1);
  gst_app_sink_set_drop(sink, TRUE);
  gst_app_sink_set_emit_signals(sink, FALSE);
  gst_base_sink_set_sync(GST_BASE_SINK(sink), FALSE);
}

// Otherwise a source may bring its own clock, whose times are not those of Now().
void GstreamerPipeline::UseMonotonicClock() {
  const GstClockPointer clock(GST_CLOCK(g_object_new(
      GST_TYPE_SYSTEM_CLOCK, "name", "kestrel", "clock-type", GST_CLOCK_TYPE_MONOTONIC, nullptr)));
  gst_object_ref_sink(clock.get());
  gst_pipeline_use_clock(GST_PIPELINE(pipeline_.get()), clock.get());
}

// A source that is not live would deliver as fast as it can be read: the sink then keeps it to its
// pace.
void GstreamerPipeline::Start() {
  const GstStateChangeReturn paused = gst_element_set_state(pipeline_.get(), GST_STATE_PAUSED);
  is_live_ = paused == GST_STATE_CHANGE_NO_PREROLL;
  if (!is_live_) gst_base_sink_set_sync(GST_BASE_SINK(sink_.get()), TRUE);
  if (paused != GST_STATE_CHANGE_FAILURE &&
      gst_element_set_state(pipeline_.get(), GST_STATE_PLAYING) != GST_STATE_CHANGE_FAILURE) {
    return;
  }
  const std::string fault = Fault();
  gst_element_set_state(pipeline_.get(), GST_STATE_NULL);
  throw InputError(fault.empty() ? camera_ + ": the camera does not start" : fault);
}

}  // namespace kestrel
