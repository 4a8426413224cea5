#include "film/part_covariances.h"

namespace etendue {

void PartCovariances::add(int x, int y, std::span<const Color<double>> image, const Color<double>* parts,
                          std::size_t stride, std::span<double> sums) {
  double* const row = &means_[(std::size_t(y) * width_ + std::size_t(x)) * row_size()];
  for (std::size_t r = 0; r < image.size(); ++r) {
    const double count = ++row[0], whole = luminance(image[r]);
    const double before = whole - row[1];
    row[1] += before / count;
    const double after = whole - row[1];
    sums[0] += before * after;
    for (std::size_t k = 0; k < parts_; ++k) {
      const double deviation = luminance(parts[k * stride + r]) - row[k + 2];
      row[k + 2] += deviation / count;
      sums[k + 1] += deviation * after;
    }
  }
}

}  // namespace etendue
