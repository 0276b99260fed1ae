// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/io/recording/media/whole_pictures.h"

#include <cstdint>
#include <gst/rtp/gstrtpbuffer.h>
#include <memory>
#include <optional>
#include <string_view>
#include <utility>

#include "kestrel/io/recording/media/gstreamer.h"

namespace kestrel {
namespace {

// The state of a stream; both probes are called by its one thread.
struct Stream {
  std::optional<std::uint16_t> number;  // which the newest packet has
  GstClockTime packet_pts = GST_CLOCK_TIME_NONE;
  bool waits_for_key = true;
  GstClockTime damaged_until = 0;  // the pictures of the packets around a gap
};

void ReleaseStream(gpointer stream) { delete static_cast<Stream*>(stream); }

GstPadProbeReturn TakePacket(GstPad* /*pad*/, GstPadProbeInfo* info, gpointer data) {
  auto& stream = *static_cast<Stream*>(data);
  GstBuffer* buffer = GST_PAD_PROBE_INFO_BUFFER(info);
  GstRTPBuffer packet = GST_RTP_BUFFER_INIT;
  if (gst_rtp_buffer_map(buffer, GST_MAP_READ, &packet) == FALSE) return GST_PAD_PROBE_OK;
  const std::uint16_t number = gst_rtp_buffer_get_seq(&packet);
  gst_rtp_buffer_unmap(&packet);
  const auto before = std::exchange(stream.number, number);
  if (before && number != static_cast<std::uint16_t>(*before + 1)) {
    stream.waits_for_key = true;
    stream.damaged_until = GST_BUFFER_PTS(buffer);
  }
  return GST_PAD_PROBE_OK;
}

GstPadProbeReturn TakePicture(GstPad* /*pad*/, GstPadProbeInfo* info, gpointer data) {
  auto& stream = *static_cast<Stream*>(data);
  const GstBuffer* picture = GST_PAD_PROBE_INFO_BUFFER(info);
  const bool is_key = !GST_BUFFER_FLAG_IS_SET(picture, GST_BUFFER_FLAG_DELTA_UNIT);
  if (is_key && GST_BUFFER_PTS(picture) > stream.damaged_until) stream.waits_for_key = false;
  return stream.waits_for_key ? GST_PAD_PROBE_DROP : GST_PAD_PROBE_OK;
}

using GstPadPointer = std::unique_ptr<GstPad, GstReleaser>;

}  // namespace

void PassWholePicturesOnly(GstElement* depayloader) {
  GstElementFactory* factory = gst_element_get_factory(depayloader);
  if (factory == nullptr) return;
  const std::string_view kind =
      gst_element_factory_get_metadata(factory, GST_ELEMENT_METADATA_KLASS);
  if (kind.find("Depayloader") == std::string_view::npos) return;
  const GstPadPointer packets(gst_element_get_static_pad(depayloader, "sink"));
  const GstPadPointer pictures(gst_element_get_static_pad(depayloader, "src"));
  if (!packets || !pictures) return;
  auto* stream = new Stream;
  gst_pad_add_probe(packets.get(), GST_PAD_PROBE_TYPE_BUFFER, TakePacket, stream, ReleaseStream);
  gst_pad_add_probe(pictures.get(), GST_PAD_PROBE_TYPE_BUFFER, TakePicture, stream, nullptr);
}

}  // namespace kestrel
