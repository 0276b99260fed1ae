// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/core/image/border_tracing.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <limits>
#include <span>

#include "kestrel/core/base/robust_statistics.h"

namespace kestrel {
namespace {

// Directions of a step, clockwise in the image (y down).
enum Direction { kRight = 0, kDown = 1, kLeft = 2, kUp = 3 };
constexpr int kStepX[4] = {1, 0, -1, 0};
constexpr int kStepY[4] = {0, 1, 0, -1};

// Pixels ahead of a vertex on the left and on the right of the walking direction, relative to the
// pixel whose upper left corner the vertex is.
constexpr int kLeftX[4] = {0, 0, -1, -1};
constexpr int kLeftY[4] = {-1, 0, 0, -1};
constexpr int kRightX[4] = {0, -1, -1, 0};
constexpr int kRightY[4] = {0, 0, -1, -1};

// Returns the pixels of a word whose left and right neighbours are bright; with 'narrow' one of
// them suffices.
std::uint64_t BesideBright(const std::uint64_t* bright, int word, int words, bool narrow) {
  const std::uint64_t next = word + 1 < words ? bright[word + 1] : 0;
  const std::uint64_t left = bright[word] << 1 | bright[word - 1] >> 63;
  const std::uint64_t right = bright[word] >> 1 | next << 63;
  return narrow ? left | right : left & right;
}

// Number of steps of a walk between comparisons of its border's size with the limit.
constexpr std::size_t kCheckInterval = 32;

// Bounding box of points.
struct Extent {
  static constexpr std::int16_t kMost = std::numeric_limits<std::int16_t>::max();
  GridPoint min{kMost, kMost};
  GridPoint max{-1, -1};

  void Add(std::span<const GridPoint> points) {
    for (const GridPoint& point : points) {
      min = {std::min(min.x, point.x), std::min(min.y, point.y)};
      max = {std::max(max.x, point.x), std::max(max.y, point.y)};
    }
  }
  int Longer() const { return std::max(max.x - min.x, max.y - min.y); }
  int Shorter() const { return std::min(max.x - min.x, max.y - min.y); }
};

// The state that determines the next step of a walk, in one number: the four pixels around a
// vertex, row by row, and the direction of arrival.
constexpr unsigned kSituations = 16 * 4;
constexpr unsigned Situation(unsigned upper_pair, unsigned lower_pair, unsigned direction) {
  return 16 * lower_pair + 4 * upper_pair + direction;
}

// kForth walks with the dark pixels on the right. Dark areas are 8-connected: a dark pixel ahead on
// the left turns the walk left, even where it touches the right one only at the vertex; with none
// on either side the walk turns right. kBack is the mirror image.
enum class Sense { kForth, kBack };
constexpr unsigned NextDirection(unsigned situation, Sense sense) {
  const unsigned direction = situation % 4;
  const auto is_dark = [situation](int x, int y) { return (situation >> (5 + 2 * y + x)) & 1; };
  const unsigned is_left = is_dark(kLeftX[direction], kLeftY[direction]);
  const unsigned is_right = is_dark(kRightX[direction], kRightY[direction]);
  const unsigned is_neither = (is_left | is_right) ^ 1;
  const unsigned quarters =
      sense == Sense::kForth ? 3 * is_left + is_neither : is_right + 3 * is_neither;
  return (direction + quarters) % 4;
}

constexpr std::array<std::uint8_t, kSituations> NextDirections(Sense sense) {
  std::array<std::uint8_t, kSituations> next{};
  for (unsigned i = 0; i < kSituations; ++i) {
    next[i] = static_cast<std::uint8_t>(NextDirection(i, sense));
  }
  return next;
}

// A vertex (from bit 32 on) and the bit number of its pixel, in one number, so that a step is a
// single addition.
std::uint64_t Place(int x, int y, std::ptrdiff_t stride) {
  return (static_cast<std::uint64_t>(y * 65536 + x) << 32) +
         static_cast<std::uint64_t>(y * stride + x);
}
GridPoint VertexOf(std::uint64_t place) {
  return std::bit_cast<GridPoint>(static_cast<std::uint32_t>(place >> 32));
}
std::uint32_t BitOf(std::uint64_t place) { return static_cast<std::uint32_t>(place); }

// Area within a closed walk, by Green's theorem: only steps along y sweep area.
std::int32_t SignedArea(std::span<const GridPoint> points) {
  std::int32_t area = 0;
  for (std::size_t i = 0; i + 1 < points.size(); ++i) {
    area += points[i].x * (points[i + 1].y - points[i].y);
  }
  return area + points.back().x * (points.front().y - points.back().y);
}

// Returns the median over places along a border of the gray value of the second pixel on its left
// minus that of the first on its right.
int ContrastAcross(const cv::Mat& image, const GridPoint* points, std::size_t count) {
  constexpr std::size_t kPlaces = 8;
  std::array<int, kPlaces> contrast;
  std::size_t seen = 0;
  for (std::size_t i = 0; i < kPlaces; ++i) {
    const std::size_t at = i * count / kPlaces;
    const GridPoint& from = points[at];
    const GridPoint& to = points[at + 1 < count ? at + 1 : 0];
    const cv::Point step(to.x - from.x, to.y - from.y);
    const cv::Point to_left(step.y, -step.x);
    const cv::Point dark(from.x - static_cast<int>(step.x < 0 || step.y > 0),
                         from.y - static_cast<int>(step.x < 0 || step.y < 0));
    const cv::Point bright = dark + 2 * to_left;
    if (!cv::Rect({0, 0}, image.size()).contains(bright)) continue;
    contrast[seen++] = image.at<std::uint8_t>(bright) - image.at<std::uint8_t>(dark);
  }
  if (seen == 0) return 0;
  return MedianInPlace(std::span(contrast).first(seen));
}

}  // namespace

// Walks along the borders of a binary image.
class BorderWalks {
 public:
  BorderWalks(const BitImage& dark, BitImage* traced)
      : images_{.above = reinterpret_cast<const std::uint8_t*>(dark.row(-1)),
                .below = reinterpret_cast<const std::uint8_t*>(dark.row(0)),
                .traced = reinterpret_cast<std::uint8_t*>(traced->row(0))},
        stride_(std::ptrdiff_t{64} * dark.words_per_row()),
        forth_(MakeTurns(Sense::kForth, stride_)),
        back_(MakeTurns(Sense::kBack, stride_)) {}

  // Walks around the border that contains the upper edge of pixel (x, y). Returns the number of
  // points that it wrote to the front of 'room'; 0 if it gave up because the border is too large
  // for 'max_extent' or the room, or was given up before. May return a border that is slightly too
  // large.
  std::size_t WalkAround(int x, int y, int max_extent, std::span<GridPoint> room) const;

 private:
  // Position of a walk and its next step.
  struct Walk {
    std::uint64_t place;
    std::uint64_t step;
    unsigned direction;
  };

  // The next step after the last one, for walks of one sense.
  struct Turns {
    std::array<std::uint8_t, kSituations> direction;
    std::array<std::uint64_t, kSituations> step;
  };

  static Turns MakeTurns(Sense sense, std::ptrdiff_t stride) {
    static constexpr std::array<std::uint8_t, kSituations> kNext[] = {NextDirections(Sense::kForth),
                                                                      NextDirections(Sense::kBack)};
    Turns turns{.direction = kNext[static_cast<int>(sense)], .step = {}};
    std::array<std::uint64_t, 4> steps;
    for (int d = 0; d < 4; ++d) steps[d] = Place(kStepX[d], kStepY[d], stride);
    for (unsigned i = 0; i < kSituations; ++i) turns.step[i] = steps[turns.direction[i]];
    return turns;
  }

  // The images that a walk reads and marks, addressed by bytes. Two pixels in two words are then as
  // easy to read as in one, and a mark seldom waits for the previous one.
  static_assert(std::endian::native == std::endian::little);
  struct WalkedImages {
    const std::uint8_t* above;  // dark pixels, from the row above the first
    const std::uint8_t* below;  // the same from the first row
    std::uint8_t* traced;

    // Returns pixel 'right' and the one before it.
    static unsigned Pair(const std::uint8_t* pixels, std::uint32_t right) {
      std::uint16_t bits;
      std::memcpy(&bits, pixels + right / 8 - 1, sizeof(bits));
      return (unsigned{bits} >> (right % 8 + 7)) & 3;
    }

    // Chooses the next step after a walk has taken one.
    void Turn(const Turns& turns, Walk* walk) const {
      const std::uint32_t bit = BitOf(walk->place);
      const unsigned now = Situation(Pair(above, bit), Pair(below, bit), walk->direction);
      walk->direction = turns.direction[now];
      walk->step = turns.step[now];
    }

    // Marks the upper edge of the pixel at 'place' if 'is_walked'. Returns whether it was marked
    // before. Branch-free, because in texture every second branch would be mispredicted.
    bool Mark(std::uint64_t place, bool is_walked) const {
      const unsigned mark = unsigned{is_walked} << (BitOf(place) % 8);
      std::uint8_t& marks = traced[BitOf(place) / 8];
      const unsigned before = marks;
      marks = static_cast<std::uint8_t>(before | mark);
      return (before & mark) != 0;
    }
  };

  WalkedImages images_;
  std::ptrdiff_t stride_;
  Turns forth_;
  Turns back_;
};

// Walks a border in both directions at once: a step waits for the one before it, but not for the
// other walk. A closed walk on a grid has an even number of steps, so both meet after half of them.
// The backward walk fills the room from its end.
std::size_t BorderWalks::WalkAround(int x, int y, int max_extent, std::span<GridPoint> room) const {
  const WalkedImages images = images_;  // a copy, which marks cannot change
  const std::uint64_t start = Place(x, y, stride_);
  Walk forth{.place = start, .step = Place(1, 0, stride_), .direction = kRight};
  Walk back{.place = start, .step = 0, .direction = kLeft};
  images.Turn(back_, &back);
  GridPoint* const end = room.data() + room.size();
  GridPoint* front = room.data();
  GridPoint* tail = end;
  Extent seen;
  for (bool met = false; !met;) {
    // Checks the limits only after several steps, because a step is short.
    const std::size_t steps = std::min<std::size_t>(kCheckInterval, (tail - front) / 2);
    GridPoint* const last = front + steps;
    bool walked = steps == 0;  // no room, or on a border that was given up before
    while (front < last && !met && !walked) {
      *front++ = VertexOf(forth.place);
      walked = images.Mark(forth.place, forth.direction == kRight);
      forth.place += forth.step;
      images.Turn(forth_, &forth);

      const unsigned came = back.direction;
      back.place += back.step;
      *--tail = VertexOf(back.place);
      walked |= images.Mark(back.place, came == kLeft);
      images.Turn(back_, &back);
      met = forth.place == back.place && (forth.direction ^ came) == 2;  // opposite directions
    }
    if (walked) return 0;
    seen.Add(std::span(front - 1, 1));
    seen.Add(std::span(tail, 1));
    if (seen.Longer() > max_extent) return 0;
  }
  return std::copy(tail, end, front) - room.data();
}

void BorderTracer::Reserve(int width, int height) {
  constexpr std::size_t kLeast = 4096;
  const std::size_t pixels = static_cast<std::size_t>(width) * height;
  points_.resize(std::max(points_.size(), pixels / 2 + kLeast));
  borders_.reserve(pixels / 64 + kLeast / 64);
  strengths_.reserve(borders_.capacity());
  traced_.Reset(width, height);
}

void BorderTracer::Trace(const BinaryImage& binary, const cv::Rect& region,
                         const BorderLimits& limits) {
  Clear();
  const BitImage& dark = binary.dark;
  Reserve(dark.width(), dark.height());
  const BorderWalks walks(dark, &traced_);
  const int first_word = region.x / 64;
  const int last_word = (region.x + region.width + 63) / 64;
  for (int y = region.y; y < region.y + region.height; ++y) {
    const std::uint64_t* above = dark.row(y - 1);
    const std::uint64_t* here = dark.row(y);
    const std::uint64_t* bright = binary.bright.row(std::max(y - 2, -1));
    const std::uint64_t* traced = traced_.row(y);
    for (int word = first_word; word < last_word; ++word) {
      std::uint64_t candidates = here[word] & ~above[word] & bright[word];
      if (candidates == 0) continue;
      candidates &= BesideBright(bright, word, dark.words_per_row(), limits.narrow);
      // One of a run of neighbouring candidates suffices.
      std::uint64_t starts = candidates & ~(candidates << 1);
      while ((starts &= ~traced[word]) != 0) {
        TraceFrom(walks, 64 * word + std::countr_zero(starts), y, limits);
        starts &= starts - 1;
      }
    }
  }
}

void BorderTracer::KeepStrongest(const cv::Mat& image, std::size_t most) {
  strengths_.clear();
  for (const Border& border : borders_) {
    strengths_.push_back({ContrastAcross(image, begin(border), border.count), border});
  }
  const std::size_t kept = std::min(most, borders_.size());
  std::partial_sort(strengths_.begin(), strengths_.begin() + static_cast<std::ptrdiff_t>(kept),
                    strengths_.end(),
                    [](const Strength& a, const Strength& b) { return a.contrast > b.contrast; });
  borders_.resize(kept);
  for (std::size_t i = 0; i < kept; ++i) borders_[i] = strengths_[i].border;
}

// Returns the room for the points of one more border; empty when there is none.
std::span<GridPoint> BorderTracer::Room() {
  if (borders_.size() == borders_.capacity()) return {};
  return std::span(points_).subspan(used_);
}

void BorderTracer::TraceFrom(const BorderWalks& walks, int x, int y, const BorderLimits& limits) {
  const std::span<GridPoint> room = Room();
  const std::size_t count = walks.WalkAround(x, y, limits.max_extent, room);
  if (count == 0 || count < limits.min_count) return;
  Extent extent;
  extent.Add(room.first(count));
  if (extent.Longer() > limits.max_extent || extent.Shorter() < limits.min_extent) return;
  borders_.push_back({.first = used_,
                      .count = count,
                      .signed_area = SignedArea(room.first(count)),
                      .min = extent.min,
                      .max = extent.max});
  used_ += count;
}

}  // namespace kestrel
