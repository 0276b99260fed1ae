// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/core/codec/pnm_codec.h"

#include <algorithm>
#include <cctype>
#include <cstdint>
#include <utility>

namespace kestrel {
namespace {

constexpr std::uint32_t kMaxValue = 65535;

bool IsSpace(char c) { return std::isspace(static_cast<unsigned char>(c)) != 0; }
bool IsDigit(char c) { return std::isdigit(static_cast<unsigned char>(c)) != 0; }

// Reads numbers as text, separated by blanks and comments (from # to the end of the line).
class PnmText {
 public:
  explicit PnmText(const EncodedImage& image) : image_(image), rest_(image.bytes.substr(2)) {}

  std::uint32_t Number(std::uint32_t max) {
    SkipBlanks();
    std::uint64_t number = 0;
    std::size_t digits = 0;
    for (; digits < rest_.size() && IsDigit(rest_[digits]) && number <= max; ++digits) {
      number = 10 * number + static_cast<std::uint64_t>(rest_[digits] - '0');
    }
    if (rest_.empty()) FailAsCutOff(image_);
    if (digits == 0 || number > max) {
      FailToDecode(image_,
                   "cannot be decoded as an image: PGM or PPM with a number that is none, "
                   "or too large");
    }
    rest_.remove_prefix(digits);
    return static_cast<std::uint32_t>(number);
  }
  // The bytes after the single blank that follows the last number.
  std::string_view Binary() const { return rest_.substr(std::min<std::size_t>(1, rest_.size())); }

 private:
  void SkipBlanks() {
    while (!rest_.empty() && (IsSpace(rest_[0]) || rest_[0] == '#')) {
      rest_.remove_prefix(rest_[0] == '#' ? std::min(rest_.find('\n'), rest_.size()) : 1);
    }
  }

  const EncodedImage& image_;
  std::string_view rest_;
};

// Converts RGB to BGR.
template <class Value>
void TurnColors(cv::Mat* pixels) {
  pixels->forEach<cv::Vec<Value, 3>>(
      [](cv::Vec<Value, 3>& color, const int*) { std::swap(color[0], color[2]); });
}

template <class Value>
void ReadText(PnmText* text, std::uint32_t max, cv::Mat* pixels) {
  auto* values = pixels->ptr<Value>();
  const std::size_t count = pixels->total() * pixels->channels();
  for (std::size_t i = 0; i < count; ++i) values[i] = static_cast<Value>(text->Number(max));
}

// Reads big-endian values.
template <class Value>
void ReadBinary(std::string_view bytes, cv::Mat* pixels) {
  auto* values = pixels->ptr<Value>();
  const std::size_t count = pixels->total() * pixels->channels();
  for (std::size_t i = 0; i < count; ++i) {
    std::uint32_t value = 0;
    for (std::size_t k = 0; k < sizeof(Value); ++k) {
      value = value << 8 | static_cast<unsigned char>(bytes[i * sizeof(Value) + k]);
    }
    values[i] = static_cast<Value>(value);
  }
}

template <class Value>
cv::Mat DecodeValues(const EncodedImage& image, PnmText* text, cv::Size size, std::uint32_t max) {
  const bool is_color = image.bytes[1] == '3' || image.bytes[1] == '6';
  const bool is_text = image.bytes[1] < '5';
  cv::Mat pixels = NewPixels(image, size.width, size.height,
                             CV_MAKETYPE(cv::DataType<Value>::depth, is_color ? 3 : 1));
  if (is_text) {
    ReadText<Value>(text, max, &pixels);
  } else {
    const std::string_view bytes = text->Binary();
    if (bytes.size() < pixels.total() * pixels.elemSize()) FailAsCutOff(image);
    ReadBinary<Value>(bytes, &pixels);
  }
  if (is_color) TurnColors<Value>(&pixels);
  return pixels;
}

}  // namespace

bool IsPnm(std::string_view bytes) {
  return bytes.size() > 2 && bytes[0] == 'P' &&
         std::string_view("2356").find(bytes[1]) != std::string_view::npos && IsSpace(bytes[2]);
}

cv::Mat DecodePnm(const EncodedImage& image) {
  constexpr std::uint32_t kMaxSide = 1 << 20;
  PnmText text(image);
  const auto width = static_cast<int>(text.Number(kMaxSide));
  const auto height = static_cast<int>(text.Number(kMaxSide));
  const std::uint32_t max = text.Number(kMaxValue);
  return max <= 255 ? DecodeValues<std::uint8_t>(image, &text, {width, height}, max)
                    : DecodeValues<std::uint16_t>(image, &text, {width, height}, max);
}

}  // namespace kestrel
