// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <variant>
#include <vector>

#include <Eigen/Core>

namespace kestrel {

// A shape on a plane: rings, discs and bars, added to and erased from one another in order. It is
// known by the signed distance to its edge instead of by pixels, so that it can be painted at any
// scale with exact edges. Metres in general; any unit when all that is drawn has the same.
class Drawing {
 public:
  struct Ring {
    Eigen::Vector2d center;
    double outer_radius;
    double inner_radius = 0;  // 0: a disc
  };
  // A rectangle, 'half_length' to both sides of 'center' along the unit vector 'axis'.
  struct Bar {
    Eigen::Vector2d center;
    Eigen::Vector2d axis;
    double half_length;
    double half_width;
  };
  using Shape = std::variant<Ring, Bar>;

  struct Edge {
    double distance;         // to the edge, negative inside; its size never exceeds the true one
    Eigen::Vector2d normal;  // unit vector in which the distance grows
  };

  Drawing& Add(const Shape& shape);
  Drawing& Erase(const Shape& shape);

  bool empty() const { return steps_.empty(); }

  // The nearest edge as seen from 'point'; from far outside (more than the size of the drawing) a
  // circle around all of it. A drawing without any shape has its edge at infinity.
  Edge NearestEdge(const Eigen::Vector2d& point) const;

 private:
  struct Step {
    Shape shape;
    bool erase;
  };

  std::vector<Step> steps_;
  // A circle around everything that was added.
  Eigen::Vector2d bound_center_ = Eigen::Vector2d::Zero();
  double bound_radius_ = -1;
};

// Part of a box 'width' wide around a point at 'distance' outside of a straight edge that lies
// inside of it.
double Coverage(double distance, double width);

}  // namespace kestrel
