// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include <opencv2/core.hpp>

#include "kestrel/vision/landing/landing_pattern.h"
#include "kestrel/vision/landing/location/pattern_view.h"
#include "kestrel/vision/landing/score/print_doubts.h"

namespace kestrel {

// Compares where an image has ink and white with where the print has them. The result does not
// depend on shadows: white in a shadow is brighter than ink in full light, so the order of gray
// values stays. In each of eight directions around the print, the level of its ink and a low
// quantile of its white are the scale on which a place is dark.
class InkComparison {
 public:
  explicit InkComparison(const LandingPattern& pattern);

  // Half the side of the square that a view must cover, m.
  double extent_m() const { return extent_m_; }

  // Sets the ink doubts of PrintDoubts. 'view': of the pattern's frame (x along an arm) on 'image'.
  // Returns the share of ring and cross that is in view, 0 to 1. Does not allocate.
  double Doubt(const cv::Mat& image, const PatternView& view, PrintDoubts* doubts) const;

 private:
  static constexpr int kArms = LandingPattern::kArms;
  static constexpr int kSectors = 2 * kArms;  // every second one lies around an arm
  // Between two arms: lines on which a spoke may lie, and arcs of another ring.
  static constexpr int kLines = 5, kArcs = 7;
  // Places on an arm, and on the ring in a sector; across their strokes.
  static constexpr int kAlongArm = 11, kAroundSector = 12, kAcross = 2;
  static constexpr int kAroundRows = 32, kPerRow = 6;  // places of another ring around
  static constexpr std::size_t kMaxPrintPlaces = 1024;
  static constexpr std::size_t kMaxPlaces = kMaxPrintPlaces + kAroundRows * kPerRow;

  // A run of consecutive places.
  struct Range {
    std::size_t begin = 0, end = 0;
    std::size_t size() const { return end - begin; }
  };
  struct Levels;
  struct Darkness;

  void AddPlaces();
  void AddInk();
  void AddWhite();
  void AddAround();
  void AddLines(int quadrant);
  void AddPlace(double x_m, double y_m);
  template <typename Holds>
  Range AddGrid(const Holds& holds);
  using Grays = std::array<float, kMaxPlaces>;
  // Index of a place on the ring beyond the end of an arm.
  std::size_t BeyondArm(int arm) const { return ring_[2 * arm].begin + kAroundSector; }
  Levels MeasureLevels(const Grays& gray) const;
  using EdgeRowsOfArms = std::array<int, kArms>;
  EdgeRowsOfArms EdgeRows(const PatternView& view) const;
  Darkness MeasureDarkness(const Grays& gray, const Levels& levels,
                           const EdgeRowsOfArms& edge_rows) const;
  void HideInHighlights(const Grays& gray, const Levels& levels, const EdgeRowsOfArms& edge_rows,
                        Darkness* darkness) const;
  // Set the doubts about arms and the white between them, about the ring, and about the white
  // around it.
  void DoubtCross(const Darkness& darkness, PrintDoubts* doubts) const;
  void DoubtRing(const Darkness& darkness, PrintDoubts* doubts) const;
  void DoubtBoard(const Darkness& darkness, PrintDoubts* doubts) const;
  // Another ring around the print, or inside of its own: 0 none, 1 as dark as ink.
  double RingAround(const Darkness& darkness) const;
  double RingInside(const Darkness& darkness) const;

  LandingPattern pattern_;
  double extent_m_;
  std::vector<float> x_m_, y_m_;
  std::vector<std::uint8_t> sector_;
  std::array<Range, kArms> arm_;      // from the middle of the print outwards
  std::array<Range, kSectors> ring_;  // counter-clockwise
  std::size_t ink_end_ = 0;           // the places before this index are on arms and ring
  std::size_t print_end_ = 0;         // and those from this one on are places of another ring
  // White between two arms: 'hub_' near the middle of the print, 'quadrant_' all of it.
  std::array<Range, kArms> hub_, quadrant_;
  std::array<Range, kSectors> board_;                                       // white around the ring
  std::array<std::array<std::vector<std::uint16_t>, kLines>, kArms> line_;  // indices of places
  std::array<std::array<std::vector<std::uint16_t>, kArcs>, kArms> arc_;    // the same
};

}  // namespace kestrel
