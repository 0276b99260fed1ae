// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/core/image/local_threshold.h"

#include <algorithm>
#include <array>
#include <cstring>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "kestrel/core/image/local_threshold.cc"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace kestrel {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

struct Smaller {
  template <class V>
  static V Apply(V a, V b) {
    return hn::Min(a, b);
  }
  template <class D, class V>
  static V ApplyPair(D, V even, V odd) {
    return hn::Min(even, odd);
  }
  static std::uint8_t Scalar(int a, int b, int c, int d) {
    return static_cast<std::uint8_t>(std::min({a, b, c, d}));
  }
};

struct Larger {
  template <class V>
  static V Apply(V a, V b) {
    return hn::Max(a, b);
  }
  template <class D, class V>
  static V ApplyPair(D, V even, V odd) {
    return hn::Max(even, odd);
  }
  static std::uint8_t Scalar(int a, int b, int c, int d) {
    return static_cast<std::uint8_t>(std::max({a, b, c, d}));
  }
};

// Rounds up over the rows and down over the columns, so that the mean has no bias.
struct Average {
  template <class V>
  static V Apply(V a, V b) {
    return hn::AverageRound(a, b);
  }
  template <class D, class V>
  static V ApplyPair(D, V even, V odd) {
    return hn::ShiftRight<1>(hn::Add(even, odd));
  }
  static std::uint8_t Scalar(int a, int b, int c, int d) {
    return static_cast<std::uint8_t>((((a + c + 1) >> 1) + ((b + d + 1) >> 1)) >> 1);
  }
};

// out[i] = Op over the pixels 2 i and 2 i + 1 of two rows, for i < count.
template <class Op>
void HalveRow(const std::uint8_t* HWY_RESTRICT upper, const std::uint8_t* HWY_RESTRICT lower,
              std::size_t count, std::uint8_t* HWY_RESTRICT out) {
  std::size_t i = 0;
#if HWY_TARGET != HWY_SCALAR  // one lane cannot be read as two bytes
  const hn::ScalableTag<std::uint8_t> d8;
  const hn::Repartition<std::uint16_t, decltype(d8)> d16;
  const hn::Half<decltype(d8)> d8_half;
  const std::size_t lanes = hn::Lanes(d16);
  const auto low_byte = hn::Set(d16, 0x00FF);
  for (; i + lanes <= count; i += lanes) {
    const auto column = Op::Apply(hn::LoadU(d8, upper + 2 * i), hn::LoadU(d8, lower + 2 * i));
    const auto pairs = hn::BitCast(d16, column);
    const auto result = Op::ApplyPair(d16, hn::And(pairs, low_byte), hn::ShiftRight<8>(pairs));
    hn::StoreU(hn::DemoteTo(d8_half, hn::BitCast(hn::RebindToSigned<decltype(d16)>(), result)),
               d8_half, out + i);
  }
#endif
  for (; i < count; ++i) {
    out[i] = Op::Scalar(upper[2 * i], upper[2 * i + 1], lower[2 * i], lower[2 * i + 1]);
  }
}

void HalveRowMinimum(const std::uint8_t* upper, const std::uint8_t* lower, std::size_t count,
                     std::uint8_t* out) {
  HalveRow<Smaller>(upper, lower, count, out);
}
void HalveRowMaximum(const std::uint8_t* upper, const std::uint8_t* lower, std::size_t count,
                     std::uint8_t* out) {
  HalveRow<Larger>(upper, lower, count, out);
}
void HalveRowMean(const std::uint8_t* upper, const std::uint8_t* lower, std::size_t count,
                  std::uint8_t* out) {
  HalveRow<Average>(upper, lower, count, out);
}

// Smallest, largest and sum of three rows.
void CombineRows(const std::uint8_t* HWY_RESTRICT a, const std::uint8_t* HWY_RESTRICT b,
                 const std::uint8_t* HWY_RESTRICT c, std::size_t count, bool largest,
                 std::uint8_t* HWY_RESTRICT out) {
  if (largest) {
    for (std::size_t i = 0; i < count; ++i) {
      const std::uint8_t ab = a[i] > b[i] ? a[i] : b[i];
      out[i] = ab > c[i] ? ab : c[i];
    }
  } else {
    for (std::size_t i = 0; i < count; ++i) {
      const std::uint8_t ab = a[i] < b[i] ? a[i] : b[i];
      out[i] = ab < c[i] ? ab : c[i];
    }
  }
}

// Column sums over three rows, and the mean of nine values from three neighbouring sums.
void SumRows(const std::uint8_t* HWY_RESTRICT a, const std::uint8_t* HWY_RESTRICT b,
             const std::uint8_t* HWY_RESTRICT c, std::size_t count,
             std::uint16_t* HWY_RESTRICT out) {
  for (std::size_t i = 0; i < count; ++i) out[i] = static_cast<std::uint16_t>(a[i] + b[i] + c[i]);
}
void MeanOfSums(const std::uint16_t* HWY_RESTRICT a, const std::uint16_t* HWY_RESTRICT b,
                const std::uint16_t* HWY_RESTRICT c, std::size_t count,
                std::uint8_t* HWY_RESTRICT out) {
  for (std::size_t i = 0; i < count; ++i) {
    // 7282 / 65536 is 1 / 9, exact for all sums of nine bytes.
    out[i] = static_cast<std::uint8_t>((std::uint32_t{a[i]} + b[i] + c[i]) * 7282u >> 16);
  }
}

// Computes thresholds from the statistics of the boxes. Those of boxes with too little contrast are
// replaced.
void ThresholdRow(const std::uint8_t* HWY_RESTRICT minimum,
                  const std::uint8_t* HWY_RESTRICT maximum, const std::uint8_t* HWY_RESTRICT mean,
                  const std::uint8_t* HWY_RESTRICT dark_instead,
                  const std::uint8_t* HWY_RESTRICT bright_instead, std::size_t count,
                  int min_contrast, bool black, std::uint8_t* HWY_RESTRICT dark,
                  std::uint8_t* HWY_RESTRICT bright) {
  const auto least = static_cast<std::uint8_t>(min_contrast < 255 ? min_contrast : 255);
  for (std::size_t i = 0; i < count; ++i) {
    const std::uint8_t contrast = maximum[i] - minimum[i];
    const std::uint8_t margin = (contrast >> 4) + 1;
    const std::uint8_t below_mean = mean[i] > margin ? mean[i] - margin : 0;
    const std::uint8_t below = black ? minimum[i] + (contrast >> 2) : below_mean;
    const std::uint8_t above = (mean[i] & maximum[i]) + ((mean[i] ^ maximum[i]) >> 1);
    dark[i] = contrast >= least ? below : dark_instead[i];
    bright[i] = contrast >= least ? above : bright_instead[i];
  }
}

}  // namespace HWY_NAMESPACE
}  // namespace kestrel
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace kestrel {
namespace {

HWY_EXPORT(HalveRowMinimum);
HWY_EXPORT(HalveRowMaximum);
HWY_EXPORT(HalveRowMean);
HWY_EXPORT(CombineRows);
HWY_EXPORT(SumRows);
HWY_EXPORT(MeanOfSums);
HWY_EXPORT(ThresholdRow);

// Pyramid levels between the tiles of the fine and of the coarse box.
constexpr int kCoarseLevels = 2;

void HalveRows(const std::uint8_t* const upper[3], const std::uint8_t* const lower[3],
               std::size_t offset, TileImage* out) {
  HWY_DYNAMIC_DISPATCH(HalveRowMinimum)(upper[0], lower[0], out->columns, &out->minimum[offset]);
  HWY_DYNAMIC_DISPATCH(HalveRowMaximum)(upper[1], lower[1], out->columns, &out->maximum[offset]);
  HWY_DYNAMIC_DISPATCH(HalveRowMean)(upper[2], lower[2], out->columns, &out->mean[offset]);
}

void Halve(const cv::Mat& image, TileImage* out) {
  out->Reset(image.cols / 2, image.rows / 2);
  for (int y = 0; y < out->rows; ++y) {
    const std::uint8_t* upper = image.ptr(2 * y);
    const std::uint8_t* lower = image.ptr(2 * y + 1);
    const std::uint8_t* const uppers[3] = {upper, upper, upper};
    const std::uint8_t* const lowers[3] = {lower, lower, lower};
    HalveRows(uppers, lowers, static_cast<std::size_t>(y) * out->columns, out);
  }
}

void Halve(const TileImage& in, TileImage* out) {
  out->Reset(in.columns / 2, in.rows / 2);
  for (int y = 0; y < out->rows; ++y) {
    const std::size_t upper = static_cast<std::size_t>(2 * y) * in.columns;
    const std::size_t lower = upper + in.columns;
    const std::uint8_t* const uppers[3] = {&in.minimum[upper], &in.maximum[upper], &in.mean[upper]};
    const std::uint8_t* const lowers[3] = {&in.minimum[lower], &in.maximum[lower], &in.mean[lower]};
    HalveRows(uppers, lowers, static_cast<std::size_t>(y) * out->columns, out);
  }
}

// Repeats each of 'count' bytes as many times as the word has bytes.
template <typename Word>
void RepeatBytes(const std::uint8_t* in, std::size_t count, std::uint8_t* out) {
  constexpr Word kOnes = static_cast<Word>(0x0101010101010101u);
  for (std::size_t i = 0; i < count; ++i) {
    const Word word = static_cast<Word>(in[i] * kOnes);
    std::memcpy(out + i * sizeof(Word), &word, sizeof(Word));
  }
}

void Repeat(const std::uint8_t* in, std::size_t count, int times, std::uint8_t* out) {
  if (times == 2) RepeatBytes<std::uint16_t>(in, count, out);
  if (times == 4) RepeatBytes<std::uint32_t>(in, count, out);
  if (times == 8) RepeatBytes<std::uint64_t>(in, count, out);
}

// Number of columns of a box row that are combined at a time, to keep intermediate rows on the
// stack.
constexpr int kBlock = 512;

// A block of a row with one column on its left and right, where the image border is repeated.
template <typename T>
struct BlockRow {
  std::array<T, kBlock + 2> values;
  // Columns 'first' to 'last' of the image were computed at Index(first) on.
  void RepeatBorder(int start, int end, int columns) {
    if (start == 0) values[0] = values[1];
    if (end == columns) values[end - start + 1] = values[end - start];
  }
};

// Computes the statistics over 3 x 3 tiles. The border tiles are repeated.
void Box(const TileImage& in, TileImage* out) {
  out->Reset(in.columns, in.rows);
  BlockRow<std::uint8_t> low;
  BlockRow<std::uint8_t> high;
  BlockRow<std::uint16_t> sum;
  for (int y = 0; y < in.rows; ++y) {
    const auto offset = [&in](int row) { return static_cast<std::size_t>(row) * in.columns; };
    const std::size_t rows[3] = {offset(std::max(y - 1, 0)), offset(y),
                                 offset(std::min(y + 1, in.rows - 1))};
    for (int start = 0; start < in.columns; start += kBlock) {
      const int end = std::min(start + kBlock, in.columns);
      const int first = std::max(start - 1, 0);
      const int count = std::min(end + 1, in.columns) - first;
      const int index = first - start + 1;
      const auto combine = [&](const std::vector<std::uint8_t>& values, bool largest,
                               std::uint8_t* into) {
        HWY_DYNAMIC_DISPATCH(CombineRows)
        (&values[rows[0] + first], &values[rows[1] + first], &values[rows[2] + first], count,
         largest, into + index);
      };
      combine(in.minimum, false, low.values.data());
      combine(in.maximum, true, high.values.data());
      HWY_DYNAMIC_DISPATCH(SumRows)
      (&in.mean[rows[0] + first], &in.mean[rows[1] + first], &in.mean[rows[2] + first], count,
       sum.values.data() + index);
      low.RepeatBorder(start, end, in.columns);
      high.RepeatBorder(start, end, in.columns);
      sum.RepeatBorder(start, end, in.columns);
      const std::uint8_t* l = low.values.data();
      const std::uint8_t* h = high.values.data();
      const std::uint16_t* m = sum.values.data();
      const std::size_t at = rows[1] + start;
      HWY_DYNAMIC_DISPATCH(CombineRows)
      (l, l + 1, l + 2, end - start, false, &out->minimum[at]);
      HWY_DYNAMIC_DISPATCH(CombineRows)
      (h, h + 1, h + 2, end - start, true, &out->maximum[at]);
      HWY_DYNAMIC_DISPATCH(MeanOfSums)(m, m + 1, m + 2, end - start, &out->mean[at]);
    }
  }
}

}  // namespace

void TileImage::Reset(int new_columns, int new_rows) {
  // Rows without columns would be read as if they had one.
  const bool empty = new_columns == 0 || new_rows == 0;
  columns = empty ? 0 : new_columns;
  rows = empty ? 0 : new_rows;
  const std::size_t count = static_cast<std::size_t>(columns) * rows;
  minimum.resize(count);
  maximum.resize(count);
  mean.resize(count);
}

void TilePyramid::Build(const cv::Mat& image, int last_level) {
  image_ = image;
  if (last_level >= 1) Halve(image, &levels_[1]);
  for (int level = 2; level <= last_level; ++level) Halve(levels_[level - 1], &levels_[level]);
}

cv::Mat TilePyramid::ImageAt(int level) const {
  if (level == 0) return image_;
  const TileImage& tiles = levels_[level];
  return cv::Mat(tiles.rows, tiles.columns, CV_8UC1, const_cast<std::uint8_t*>(tiles.mean.data()));
}

void LocalThreshold::Measure(const TilePyramid& pyramid, int image_level, int tile_level) {
  tile_px_ = 1 << (tile_level - image_level);
  Box(pyramid.level(tile_level), &fine_box_);
  Box(pyramid.level(tile_level + kCoarseLevels), &coarse_box_);
}

int LocalThreshold::ContrastQuantile(double share) const {
  // Boxes overlap their neighbours, so every second row suffices.
  std::array<int, 256> histogram{};
  std::size_t count = 0;
  for (int y = 0; y < fine_box_.rows; y += 2) {
    const std::size_t row = static_cast<std::size_t>(y) * fine_box_.columns;
    for (std::size_t i = row; i < row + fine_box_.columns; ++i, ++count) {
      ++histogram[fine_box_.maximum[i] - fine_box_.minimum[i]];
    }
  }
  double below = share * static_cast<double>(count);
  int contrast = 0;
  while (contrast < 255 && (below -= histogram[contrast]) >= 0) ++contrast;
  return contrast;
}

void LocalThreshold::ChooseThresholds(int min_contrast, Dark what) {
  const bool black = what == Dark::kBlack;
  const std::size_t columns = fine_box_.columns;
  // A row of coarse thresholds per fine tile. The initial values leave pixels undecided.
  row_.Resize(3 * columns);
  std::uint8_t* const dark_row = row_.dark.data();
  std::uint8_t* const bright_row = row_.bright.data();
  coarse_.Resize(coarse_box_.minimum.size());
  std::fill(dark_row, dark_row + columns, 0);
  std::fill(bright_row, bright_row + columns, 255);
  for (int y = 0; y < coarse_box_.rows; ++y) {
    const std::size_t at = static_cast<std::size_t>(y) * coarse_box_.columns;
    HWY_DYNAMIC_DISPATCH(ThresholdRow)
    (&coarse_box_.minimum[at], &coarse_box_.maximum[at], &coarse_box_.mean[at], dark_row,
     bright_row, coarse_box_.columns, min_contrast, black, &coarse_.dark[at], &coarse_.bright[at]);
  }
  fine_.Resize(fine_box_.minimum.size());
  int coarse_y = -1;
  for (int y = 0; y < fine_box_.rows; ++y) {
    if (const int row = std::min(y >> kCoarseLevels, coarse_box_.rows - 1);
        row != coarse_y && row >= 0) {
      coarse_y = row;
      const std::size_t coarse_columns = coarse_box_.columns;
      const std::size_t at = static_cast<std::size_t>(row) * coarse_columns;
      Repeat(&coarse_.dark[at], coarse_columns, 1 << kCoarseLevels, dark_row);
      Repeat(&coarse_.bright[at], coarse_columns, 1 << kCoarseLevels, bright_row);
      const std::size_t covered = coarse_columns << kCoarseLevels;
      std::fill(dark_row + covered, dark_row + columns, dark_row[covered - 1]);
      std::fill(bright_row + covered, bright_row + columns, bright_row[covered - 1]);
    }
    const std::size_t at = static_cast<std::size_t>(y) * columns;
    HWY_DYNAMIC_DISPATCH(ThresholdRow)
    (&fine_box_.minimum[at], &fine_box_.maximum[at], &fine_box_.mean[at], dark_row, bright_row,
     columns, min_contrast, black, &fine_.dark[at], &fine_.bright[at]);
  }
}

// Expands the thresholds of a row of tiles to pixels. Columns right of the last tile repeat it.
void LocalThreshold::ExpandRow(int tile_row, int width) {
  const std::size_t columns = fine_box_.columns;
  const std::size_t at = static_cast<std::size_t>(tile_row) * columns;
  const auto expand = [&](const std::vector<std::uint8_t>& tiles, std::vector<std::uint8_t>* row) {
    Repeat(&tiles[at], columns, tile_px_, row->data());
    std::fill(row->begin() + static_cast<std::ptrdiff_t>(columns * tile_px_), row->begin() + width,
              tiles[at + columns - 1]);
  };
  expand(fine_.dark, &row_.dark);
  expand(fine_.bright, &row_.bright);
}

void LocalThreshold::Binarize(const cv::Mat& image, int min_contrast, BinaryImage* binary,
                              Dark what) {
  binary->dark.Reset(image.cols, image.rows);
  binary->bright.Reset(image.cols, image.rows);
  if (fine_box_.minimum.empty()) return;
  ChooseThresholds(min_contrast, what);
  row_.ResetRow(image.cols);
  int tile_row = -1;
  for (int y = 0; y < image.rows; ++y) {
    if (const int row = std::min(y / tile_px_, fine_box_.rows - 1); row != tile_row) {
      tile_row = row;
      ExpandRow(row, image.cols);
    }
    BinarizeRow(image.ptr(y), image.cols, row_, y, binary);
  }
}

}  // namespace kestrel
#endif  // HWY_ONCE
