// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/core/codec/webp_codec.h"

#include <cstdint>
#include <webp/decode.h>

namespace kestrel {

bool IsWebp(std::string_view bytes) {
  return bytes.starts_with("RIFF") && bytes.size() > 12 && bytes.substr(8, 4) == "WEBP";
}

cv::Mat DecodeWebp(const EncodedImage& image) {
  const auto* bytes = reinterpret_cast<const std::uint8_t*>(image.bytes.data());
  const std::size_t size = image.bytes.size();
  WebPBitstreamFeatures features;
  const VP8StatusCode status = WebPGetFeatures(bytes, size, &features);
  if (status == VP8_STATUS_NOT_ENOUGH_DATA) FailAsCutOff(image);
  if (status != VP8_STATUS_OK) FailToDecode(image, "cannot be decoded as an image: broken WebP");
  if (features.has_animation != 0) FailToDecode(image, "is an animation, expected one image");
  const bool has_alpha = features.has_alpha != 0;
  cv::Mat pixels = NewPixels(image, features.width, features.height, has_alpha ? CV_8UC4 : CV_8UC3);
  const auto decode = has_alpha ? WebPDecodeBGRAInto : WebPDecodeBGRInto;
  if (decode(bytes, size, pixels.data, pixels.total() * pixels.elemSize(),
             static_cast<int>(pixels.step)) == nullptr) {
    FailToDecode(image, "cannot be decoded as an image: WebP that is cut off or broken");
  }
  return pixels;
}

}  // namespace kestrel
