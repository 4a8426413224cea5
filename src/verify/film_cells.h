// The film in cells: the pixels of one block that show one material, beside others or not.
#pragma once

#include "scene/scene.h"
#include "verify/moment_image.h"

#include <cstdint>
#include <vector>

namespace etendue {

struct FilmCell {
  std::int32_t block;     ///< Rows of blocks from the top.
  std::int32_t material;  ///< -1: none is seen.
  /// A lobe's hits may be too rare for an image's own samples to tell: on glossy materials, and where they
  /// are so near that a pixel's filter may show them.
  bool has_rare_hits;
  int pixels;
};

struct FilmCells {
  std::vector<FilmCell> cells;
  std::vector<std::int32_t> cell_of_pixel;  ///< Rows from the top.
  std::vector<char> has_rare_hits;          ///< Of each material.

  /// Sums over the pixels of each cell.
  std::vector<MeanMoments> sums(const MomentImage& image) const;
};

/// The material that each pixel shows through its middle, -1 where it shows none; rows from the top.
std::vector<std::int32_t> materials_seen(const Scene& scene);

/// \param has_rare_hits of each material
/// \param margin_px how far around them pixels show them
FilmCells film_cells(int width, int height, const std::vector<std::int32_t>& material_of_pixel,
                     std::vector<char> has_rare_hits, int margin_px);

}  // namespace etendue
