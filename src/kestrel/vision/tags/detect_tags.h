// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <string>
#include <vector>

#include <Eigen/Core>
#include <opencv2/core.hpp>

namespace kestrel {

// A tag in an image.
struct TagDetection {
  std::string family;  // "tag36h11", "aruco_4x4_50", ...
  int id = 0;
  // Corners of the square where its black and white borders meet, px; integer coordinates are the
  // centres of pixels. Clockwise in the image, from the upper left corner of the tag as its library
  // draws it: the order of OpenCV's detectMarkers. libapriltag has it in reverse, p[3] to p[0].
  std::array<Eigen::Vector2d, 4> corners_px;
  // Mean distance of the bits from the threshold between black and white, gray values: that of the
  // white or of the black bits, whichever is smaller. The definition is libapriltag's, whose
  // decode_sharpening, 0.25 unless it is changed, makes its margins larger. Up to 127, but for
  // cells of a few pixels, which are sharpened here, too.
  double decision_margin = 0;
};

// Returns the names of all families that DetectTags finds: the AprilTag families of libapriltag by
// its names, and the dictionaries of OpenCV, as "aruco_4x4_50". OpenCV's own names
// ("DICT_4X4_50") are known, too.
const std::vector<std::string>& TagFamilies();

// Finds all tags of some families in an image, without a calibration. Returns them by family, in
// the order of 'families', then by id; a tag that is there twice is listed twice. 'image':
// CV_8UC1, or CV_8UC3 in the order BGR, of any size. Throws InputError for an image that is empty
// or of another type, and for the name of a family that is not known.
//
// Families of 16 bits ("tag16h5", "aruco_4x4_50") have ids as plain as a window: such things are
// taken for them now and then. A tag that a fisheye lens bends strongly is not found:
// TagBoardDetector knows the lens. It is also the one for a loop over images, as this makes all its
// memory anew.
std::vector<TagDetection> DetectTags(const cv::Mat& image,
                                     const std::vector<std::string>& families);

}  // namespace kestrel
