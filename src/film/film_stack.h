// The replicates of all pixels so far, kept so that passes of any size add up to the bits of one.
#pragma once

#include "film/film.h"

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace etendue {

/// Replicates [first, last) of every pixel.
struct FilmBlock {
  std::uint64_t first, last;
  Film film;
};

/// Films over aligned power-of-two blocks of replicate indices, as few as hold [first(), last()): [0, 11) as
/// [0, 8), [8, 10), [10, 11). From these the sum of combine_replicates over the whole range follows to the
/// bit. Replicates are added by passes over all pixels: until a pass is committed nothing changes, and it may
/// be given up.
class FilmStack {
 public:
  /// Throws InputError unless width and height are positive.
  FilmStack(int width, int height, std::uint64_t first = 0);
  /// Of a stack that was `blocks()`. Throws InputError where they are not the blocks of one range, or differ
  /// in size.
  explicit FilmStack(std::vector<FilmBlock> blocks);

  int width() const { return width_; }
  int height() const { return height_; }
  std::uint64_t first() const { return first_; }
  std::uint64_t last() const { return last_; }  ///< What is committed; first() at the beginning.
  const std::vector<FilmBlock>& blocks() const { return blocks_; }

  /// Begins the pass [last(), end), end > last().
  void begin_pass(std::uint64_t end);
  /// The means of the pass's replicates of a pixel. Threads may add different pixels at once.
  void add(int x, int y, std::span<const Color<double>> means);
  /// The pass becomes part of the film. Pixels that were not added have count 0, which only the first pass
  /// may leave.
  void commit_pass();

  /// All that is committed; count 0 where nothing is.
  PixelStatistics pixel(int x, int y) const;
  /// The film of these, where a single block holds all: nothing is left of the stack then.
  std::optional<Film> take_single() &&;

 private:
  int width_, height_;
  std::uint64_t first_, last_, end_of_pass_;
  std::vector<FilmBlock> blocks_;
  std::size_t kept_ = 0;  ///< Of blocks_, by the pass; the others are in its first block.
  std::vector<FilmBlock> of_pass_;
  std::vector<Film> spare_;  ///< Of blocks that went up in others: fresh memory costs as much as rendering.
};

}  // namespace etendue
