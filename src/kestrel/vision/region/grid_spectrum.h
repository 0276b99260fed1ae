// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <vector>

namespace kestrel {

// A square grid of cells with several real channels, those of one cell side by side.
struct FeatureGrid {
  FeatureGrid(int side_, int channels_)
      : side(side_), channels(channels_), values(std::size_t(side_) * side_ * channels_) {}

  float* Cell(int x, int y) { return &values[(std::size_t(y) * side + x) * channels]; }
  const float* Cell(int x, int y) const { return &values[(std::size_t(y) * side + x) * channels]; }

  int side, channels;
  std::vector<float> values;
};

// The Fourier transform of a FeatureGrid: half of its bins, as the others are their conjugates.
struct GridSpectrum {
  GridSpectrum(int side_, int channels_)
      : side(side_),
        channels(channels_),
        values(std::size_t(side_) * (side_ / 2 + 1) * 2 * channels_) {}

  int bins() const { return side * (side / 2 + 1); }
  // The bins in rows of side / 2 + 1; of each first the real parts of all channels, then the
  // imaginary ones.
  float* Bin(int bin) { return &values[std::size_t(bin) * 2 * channels]; }
  const float* Bin(int bin) const { return &values[std::size_t(bin) * 2 * channels]; }

  int side, channels;
  std::vector<float> values;
};

// The two-dimensional Fourier transform of all channels at once. Does not allocate.
class GridTransform {
 public:
  // 'side': a power of two. 'channels': an even number; the grids that are transformed have as
  // many.
  GridTransform(int side, int channels);

  // Overwrites 'grid'.
  void Forward(FeatureGrid* grid, GridSpectrum* spectrum) const;
  // The inverse of Forward.
  void Inverse(const GridSpectrum& spectrum, FeatureGrid* grid) const;

 private:
  // Transforms cells whose first half of the channels is the real part of a complex value, and the
  // second half the imaginary part.
  void TransformComplex(FeatureGrid* grid, float sign) const;

  int side_, channels_;
  std::vector<float> cosines_, sines_;  // for the angles i / side of a turn
  std::vector<int> reversed_;           // i with its bits in reverse order
};

}  // namespace kestrel
