// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/core/codec/bmp_codec.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstdlib>

namespace kestrel {
namespace {

constexpr std::size_t kFileHead = 14;
constexpr std::size_t kMinHead = kFileHead + 40;
constexpr std::size_t kMasks = kMinHead;  // position of the masks in a header with bit fields
constexpr std::size_t kPaletteEntry = 4;  // BGR and an unused byte

struct BmpHead {
  std::uint32_t pixels;   // offset of the pixels
  std::uint32_t palette;  // offset of the palette
  std::int32_t width;
  std::int32_t height;  // negative: the upper row comes first
  std::uint32_t bits;   // per pixel
  std::uint32_t compression;
  std::uint32_t colors;  // number of colours in the palette
};

std::uint32_t LittleEndian32(const EncodedImage& image, std::size_t at) {
  if (at + 4 > image.bytes.size()) FailAsCutOff(image);
  std::uint32_t value = 0;
  for (std::size_t i = 4; i-- > 0;) {
    value = value << 8 | static_cast<unsigned char>(image.bytes[at + i]);
  }
  return value;
}

bool HasUsualMasks(const EncodedImage& image) {
  return LittleEndian32(image, kMasks) == 0xff0000 && LittleEndian32(image, kMasks + 4) == 0xff00 &&
         LittleEndian32(image, kMasks + 8) == 0xff;
}

BmpHead ReadHead(const EncodedImage& image) {
  constexpr std::uint32_t kPlain = 0, kBitFields = 3;
  const auto number = [&](std::size_t at) { return LittleEndian32(image, at); };
  BmpHead head{number(10),
               static_cast<std::uint32_t>(kFileHead) + number(14),
               static_cast<std::int32_t>(number(18)),
               static_cast<std::int32_t>(number(22)),
               number(28) & 0xffff,
               number(30),
               number(46)};
  if (head.bits == 8 && head.colors == 0) head.colors = 256;
  const bool is_plain =
      head.compression == kPlain && (head.bits == 8 || head.bits == 24 || head.bits == 32);
  const bool has_fields = head.compression == kBitFields && head.bits == 32 && HasUsualMasks(image);
  if (number(14) < kMinHead - kFileHead || (!is_plain && !has_fields) || head.colors > 256 ||
      head.width < 0 || head.height == INT32_MIN) {
    FailToDecode(image,
                 "is a BMP of a rare kind, expected 8, 24 or 32 bits a pixel, not compressed");
  }
  return head;
}

// Colours missing in the file are black.
class Palette {
 public:
  Palette(const EncodedImage& image, const BmpHead& head) {
    for (std::size_t i = 0; i < head.colors; ++i) {
      const std::uint32_t bgr = LittleEndian32(image, head.palette + kPaletteEntry * i);
      cv::Vec3b& color = colors_[i];
      for (int k = 0; k < 3; ++k) color[k] = static_cast<std::uint8_t>(bgr >> 8 * k);
      is_gray_ = is_gray_ && color[0] == color[1] && color[0] == color[2];
    }
  }
  bool is_gray() const { return is_gray_; }
  const cv::Vec3b& operator[](unsigned char index) const { return colors_[index]; }

 private:
  std::array<cv::Vec3b, 256> colors_{};
  bool is_gray_ = true;
};

cv::Mat DecodeRows(const EncodedImage& image, const BmpHead& head, int type, const auto& pixel_at) {
  cv::Mat pixels = NewPixels(image, head.width, std::abs(head.height), type);
  const std::size_t size = head.bits / 8;
  const std::size_t step = (pixels.cols * size + 3) / 4 * 4;
  const std::size_t height = pixels.rows;
  if (head.pixels > image.bytes.size() || (image.bytes.size() - head.pixels) / step < height) {
    FailAsCutOff(image);
  }
  for (std::size_t i = 0; i < height; ++i) {
    const auto* row =
        reinterpret_cast<const unsigned char*>(image.bytes.data()) + head.pixels + i * step;
    unsigned char* output = pixels.ptr(static_cast<int>(head.height < 0 ? i : height - 1 - i));
    for (int u = 0; u < pixels.cols; ++u) pixel_at(row + u * size, output + u * pixels.elemSize());
  }
  return pixels;
}

}  // namespace

bool IsBmp(std::string_view bytes) { return bytes.starts_with("BM"); }

cv::Mat DecodeBmp(const EncodedImage& image) {
  const BmpHead head = ReadHead(image);
  const auto copy = [](const unsigned char* from, unsigned char* to) { std::copy_n(from, 3, to); };
  if (head.bits != 8) return DecodeRows(image, head, CV_8UC3, copy);
  const Palette palette(image, head);
  const int channels = palette.is_gray() ? 1 : 3;
  return DecodeRows(image, head, CV_8UC(channels), [&](const auto* from, auto* to) {
    std::copy_n(palette[*from].val, channels, to);
  });
}

}  // namespace kestrel
