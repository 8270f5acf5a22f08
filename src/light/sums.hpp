// Sums over rays, and the means and standard errors that follow from them.
#pragma once

#include "path.hpp"

#include <keeler/statistics/measured.hpp>

#include <algorithm>
#include <cmath>

namespace keeler::light {

struct RayMoments {
  double sum = 0.0, squares = 0.0;

  void add(double value) {
    sum += value;
    squares += value * value;
  }
  void operator+=(const RayMoments& other) {
    sum += other.sum;
    squares += other.squares;
  }

  /// Returns the mean over `rays` independent rays. Precondition: more than one.
  Estimate estimate(double rays) const {
    const double mean = sum / rays;
    return {mean, std::sqrt(std::max(0.0, squares / rays - mean * mean) / (rays - 1.0))};
  }
};

struct RaySums {
  RayMoments all, single, multiple, passed;
  double rays = 0.0, hits = 0.0;

  void add(const PathLight& path) {
    all.add(path.single + path.multiple);
    single.add(path.single);
    multiple.add(path.multiple);
    passed.add(path.hits == 0 ? 1.0 : 0.0);
    rays += 1.0;
    hits += path.hits;
  }
  void operator+=(const RaySums& other) {
    all += other.all;
    single += other.single;
    multiple += other.multiple;
    passed += other.passed;
    rays += other.rays;
    hits += other.hits;
  }
};

} // namespace keeler::light
