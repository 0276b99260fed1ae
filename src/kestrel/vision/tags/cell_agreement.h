// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <span>
#include <vector>

#include "kestrel/vision/search/pad_samples.h"
#include "kestrel/vision/tags/tag_family.h"

namespace kestrel {

// Agreement of the gray values of a tag's cells with its bits.
struct TagAgreement {
  double evidence = 0;  // natural logarithm of how much likelier the tag is than other bits
  int seen = 0;         // number of data cells in view
  int wrong = 0;        // those among them that look like the other colour
};

// Returns how much a data cell of a tag tells (nats): the length of the shortest description of its
// picture, by the share of vertices that are corners or by its straight edges, over its data cells.
// A stripe, a block or a letter tells little, however many cells it has, because windows and prints
// show them as well; so does a checker. At most log 2, for a picture at random.
double CellInformation(const TagGrid& grid, const std::vector<bool>& is_data);

// Compares gray values of all cells of a tag, of 'cell_px' each and negative where out of view,
// with its bits. A cell is held against the white and the black cells around it, so that the edge
// of a shadow over the tag does not matter. A match counts by CellInformation, less where the cells
// are so small that lens and pixels make them alike. 'is_data': as TagModel's.
TagAgreement CompareCells(const TagGrid& grid, const std::vector<bool>& is_data, double cell_px,
                          std::span<const float> gray, DimSample dim = DimSample::kWrong);

}  // namespace kestrel
