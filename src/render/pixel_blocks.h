// A tile as a sequence of blocks: many samples of one pixel, or few of each of some pixels close together.
#pragma once

#include "integrator/sample_block.h"
#include "render/kernel.h"
#include "render/pixel_order.h"
#include "render/replicate_sum.h"
#include "sampler/replicates.h"

#include <algorithm>
#include <bit>
#include <span>
#include <vector>

namespace etendue {

class PixelBlocks {
 public:
  PixelBlocks(const TileJob& job, std::size_t layers) : job_(job), pixels_(pixels_in_order(job.unit)) {
    const std::size_t images = 1 + layers;
    job.means->resize(images * image_size());
    sums_.resize(images);
  }

  /// Which sample of its pixel stands at position `i` of the block.
  std::int64_t replicate_of(int i) const {
    return job_.unit.first_replicate + (first_sample_ + i % samples_in_block_) / per_replicate_;
  }
  std::int64_t index_of(int i) const { return (first_sample_ + i % samples_in_block_) % per_replicate_; }

  /// Fills in who the next block's samples are; false at the end of the tile.
  bool next(SampleBlock& block) {
    if (first_pixel_ == pixels_.size()) return false;
    per_replicate_ = pixels_[first_pixel_].samples_per_replicate;
    samples_ = job_.unit.replicates * per_replicate_;
    samples_in_block_ = std::min(samples_ - first_sample_, block_capacity);
    const std::size_t most = std::bit_floor(std::size_t(block_capacity / samples_in_block_));
    last_pixel_ = first_pixel_ + 1;
    while (last_pixel_ < pixels_.size() && last_pixel_ - first_pixel_ < most &&
           pixels_[last_pixel_].samples_per_replicate == per_replicate_ && samples_ <= block_capacity)
      ++last_pixel_;
    block.is_one_pixel = last_pixel_ - first_pixel_ == 1;
    block.count = 0;
    for (const PixelToRender& pixel : pixels_of_block()) fill_pixel(block, pixel);
    block.padded_count = (block.count + widest_lanes - 1) / widest_lanes * widest_lanes;
    for (int i = block.count; i < block.padded_count; ++i) {
      const int last = block.count - 1;
      block.pixel_x[i] = block.pixel_x[last];
      block.pixel_y[i] = block.pixel_y[last];
      block.path.stream_lo[i] = block.path.stream_lo[last];
      block.path.stream_hi[i] = block.path.stream_hi[last];
      block.path.index[i] = block.path.index[last];
    }
    return true;
  }

  /// Takes in the block's radiance, and moves on.
  void take_means(const SampleBlock& block) {
    take_means(block.radiance, 0);
    for (std::size_t k = 0; k < block.layers.size(); ++k) take_means(block.layers[k], k + 1);
    first_sample_ += samples_in_block_;
    if (first_sample_ < samples_) return;
    first_sample_ = 0;
    first_pixel_ = last_pixel_;
  }

 private:
  static_assert(block_capacity % widest_lanes == 0);

  std::span<const PixelToRender> pixels_of_block() const {
    return std::span(pixels_).subspan(first_pixel_, last_pixel_ - first_pixel_);
  }

  void take_means(const ColorColumn& radiance, std::size_t image) {
    ReplicateColorSum& sum = sums_[image];
    int i = 0;
    for (const PixelToRender& pixel : pixels_of_block())
      for_each_run([&](int replicate, int index, int count) {
        sum.r.add(&radiance.r[i], count, index);
        sum.g.add(&radiance.g[i], count, index);
        sum.b.add(&radiance.b[i], count, index);
        i += count;
        if (index + count < per_replicate_) return;
        const double scale = 1.0 / per_replicate_;
        mean_at(image, pixel, replicate) = {sum.r.take() * scale, sum.g.take() * scale, sum.b.take() * scale};
      });
  }

  std::size_t image_size() const { return pixels_.size() * std::size_t(job_.unit.replicates); }
  Color<double>& mean_at(std::size_t image, const PixelToRender& pixel, int replicate) {
    const PixelRectangle& area = job_.unit.pixels;
    const int number = (pixel.y - area.y_begin) * area.width() + pixel.x - area.x_begin;
    return (*job_.means)[image * image_size() + std::size_t(number) * std::size_t(job_.unit.replicates) +
                         std::size_t(replicate)];
  }

  /// f(replicate of the unit, index of the first sample in it, count) over this block's samples of one pixel.
  template <class Function>
  void for_each_run(Function&& f) const {
    int sample = first_sample_;
    const int end = first_sample_ + samples_in_block_;
    while (sample < end) {
      const int replicate = sample / per_replicate_, index = sample % per_replicate_;
      const int count = std::min(end - sample, per_replicate_ - index);
      f(replicate, index, count);
      sample += count;
    }
  }

  void fill_pixel(SampleBlock& block, const PixelToRender& pixel) {
    for_each_run([&](int replicate, int index, int count) {
      const ReplicatePlace place =
          replicate_place(job_.settings->replicates_by, job_.settings->seed, pixel.x, pixel.y,
                          job_.unit.first_replicate + replicate, per_replicate_);
      for (int k = 0; k < count; ++k) {
        const int i = block.count + k;
        block.pixel_x[i] = pixel.x;
        block.pixel_y[i] = pixel.y;
        block.path.stream_lo[i] = std::uint32_t(place.stream);
        block.path.stream_hi[i] = std::uint32_t(place.stream >> 32);
        block.path.index[i] = place.first_index + std::uint32_t(index + k);
      }
      block.count += count;
    });
  }

  const TileJob& job_;
  const std::vector<PixelToRender> pixels_;       ///< Of the unit.
  int samples_ = 0, per_replicate_ = 1;           ///< Of a pixel of the current block, in the unit.
  std::size_t first_pixel_ = 0, last_pixel_ = 0;  ///< Those of the current block: [first, last).
  int first_sample_ = 0, samples_in_block_ = 0;
  std::vector<ReplicateColorSum> sums_;  ///< Of the image and of each layer.
};

}  // namespace etendue
