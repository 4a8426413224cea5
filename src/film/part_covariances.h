// Which parts of an image its variance comes from: the covariance of each part with the whole.
#pragma once

#include "base/color.h"

#include <cstddef>
#include <span>
#include <vector>

namespace etendue {

/// The replicates of all pixels so far, of an image and of parts of it, by their luminances. The variance of
/// a sum of parts is the sum of their covariances with it, though the parts' noises are correlated.
class PartCovariances {
 public:
  PartCovariances() = default;  ///< Of no parts.
  PartCovariances(int width, int height, std::size_t parts)
      : width_(std::size_t(width)), parts_(parts), means_(width_ * std::size_t(height) * row_size()) {}

  /// Takes in more replicates of a pixel. Threads may add different pixels at once.
  /// \param image their means \param parts of the first part; that of the next is `stride` further on, and so
  /// on \param sums get the sums of products of deviations: of the image with itself, and of each part with
  /// it
  void add(int x, int y, std::span<const Color<double>> image, const Color<double>* parts, std::size_t stride,
           std::span<double> sums);

 private:
  std::size_t row_size() const { return parts_ + 2; }
  std::size_t width_ = 0, parts_ = 0;
  std::vector<double> means_;  ///< Of each pixel: count, mean of the image, mean of each part.
};

}  // namespace etendue
