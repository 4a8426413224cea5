#include "film/film_stack.h"

#include "base/error.h"

#include <algorithm>
#include <bit>
#include <cassert>
#include <fmt/format.h>
#include <iterator>
#include <utility>

namespace etendue {
namespace {

struct Range {
  std::uint64_t first, last;
  friend bool operator==(const Range&, const Range&) = default;
};

/// The aligned power-of-two blocks, as few as there can be, that make up [first, last).
std::vector<Range> aligned_blocks(std::uint64_t first, std::uint64_t last) {
  std::vector<Range> blocks;
  while (first < last) {
    std::uint64_t size = std::bit_floor(last - first);
    if (first != 0) size = std::min(size, first & (~first + 1));
    blocks.push_back({first, first + size});
    first += size;
  }
  return blocks;
}

/// The sum over [first, last) of a pixel, in the order of combine_replicates, from blocks whose ranges are
/// nodes of its tree, and from the means of replicates `means_first` and on.
PixelStatistics sum(std::span<const FilmBlock> blocks, int x, int y, std::span<const Color<double>> means,
                    std::uint64_t means_first, std::uint64_t first, std::uint64_t last) {
  if (!means.empty() && first >= means_first)
    return combine_replicates(means.subspan(first - means_first, last - first), first);
  for (const FilmBlock& block : blocks)
    if (block.first == first && block.last == last) return block.film.at(x, y);
  const std::uint64_t split = replicate_split(first, last);
  return combine(sum(blocks, x, y, means, means_first, first, split),
                 sum(blocks, x, y, means, means_first, split, last));
}

}  // namespace

FilmStack::FilmStack(int width, int height, std::uint64_t first)
    : width_(width), height_(height), first_(first), last_(first), end_of_pass_(first) {
  check_film_size(width, height);
}

FilmStack::FilmStack(std::vector<FilmBlock> blocks) : blocks_(std::move(blocks)) {
  if (blocks_.empty()) throw InputError("a film without replicates");
  width_ = blocks_.front().film.width();
  height_ = blocks_.front().film.height();
  first_ = blocks_.front().first;
  last_ = end_of_pass_ = blocks_.back().last;
  const std::vector<Range> expected = aligned_blocks(first_, last_);
  const bool is_one_range = std::equal(blocks_.begin(), blocks_.end(), expected.begin(), expected.end(),
                                       [&](const FilmBlock& block, const Range& range) {
                                         return Range{block.first, block.last} == range &&
                                                block.film.width() == width_ &&
                                                block.film.height() == height_;
                                       });
  if (!is_one_range)
    throw InputError(fmt::format("the parts of a film do not make up replicates {} to {}", first_, last_));
}

void FilmStack::begin_pass(std::uint64_t end) {
  assert(end > last_);
  end_of_pass_ = end;
  const std::vector<Range> blocks = aligned_blocks(first_, end);
  kept_ = 0;
  while (kept_ < std::min(blocks_.size(), blocks.size()) &&
         blocks[kept_] == Range{blocks_[kept_].first, blocks_[kept_].last})
    ++kept_;
  for (FilmBlock& block : of_pass_) spare_.push_back(std::move(block.film));
  of_pass_.clear();
  if (blocks_.empty()) spare_.clear();  // Old pixels would stay where the first pass adds none.
  for (std::size_t k = kept_; k < blocks.size(); ++k) {
    if (spare_.empty()) spare_.emplace_back(width_, height_);
    of_pass_.push_back({blocks[k].first, blocks[k].last, std::move(spare_.back())});
    spare_.pop_back();
  }
}

void FilmStack::add(int x, int y, std::span<const Color<double>> means) {
  assert(means.size() == end_of_pass_ - last_);
  const auto taken = std::span(blocks_).subspan(kept_);
  for (FilmBlock& block : of_pass_)
    block.film.at(x, y) = sum(taken, x, y, means, last_, block.first, block.last);
}

void FilmStack::commit_pass() {
  for (std::size_t k = kept_; k < blocks_.size(); ++k) spare_.push_back(std::move(blocks_[k].film));
  blocks_.erase(blocks_.begin() + std::ptrdiff_t(kept_), blocks_.end());
  std::move(of_pass_.begin(), of_pass_.end(), std::back_inserter(blocks_));
  of_pass_.clear();
  last_ = end_of_pass_;
}

std::optional<Film> FilmStack::take_single() && {
  if (blocks_.size() != 1) return std::nullopt;
  return std::move(blocks_.front().film);
}

PixelStatistics FilmStack::pixel(int x, int y) const {
  return blocks_.empty() ? PixelStatistics{} : sum(blocks_, x, y, {}, 0, first_, last_);
}

}  // namespace etendue
