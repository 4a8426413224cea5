#include "verify/film_cells.h"

#include "render/first_hits.h"

#include <algorithm>
#include <map>
#include <tbb/parallel_for.h>
#include <tuple>
#include <utility>

namespace etendue {

std::vector<MeanMoments> FilmCells::sums(const MomentImage& image) const {
  std::vector<MeanMoments> of_cells(cells.size());
  for (std::size_t k = 0; k < cell_of_pixel.size(); ++k)
    of_cells[std::size_t(cell_of_pixel[k])] += image.pixels[k];
  return of_cells;
}

std::vector<std::int32_t> materials_seen(const Scene& scene) {
  const Camera& camera = scene.camera;
  std::vector<std::int32_t> seen(std::size_t(camera.width_px) * std::size_t(camera.height_px));
  tbb::parallel_for(0, camera.height_px, [&](int y) {
    for (int x = 0; x < camera.width_px; ++x) {
      const Hit<float> hit = centre_hit(scene, x, y).hit;
      seen[std::size_t(y) * std::size_t(camera.width_px) + std::size_t(x)] =
          hit.geometry < 0 ? -1 : scene.geometry.material[std::size_t(hit.geometry)];
    }
  });
  return seen;
}

FilmCells film_cells(int width, int height, const std::vector<std::int32_t>& material_of_pixel,
                     std::vector<char> has_rare_hits, int margin_px) {
  std::vector<char> is_near_rare(material_of_pixel.size(), 0);
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      const std::int32_t material = material_of_pixel[std::size_t(y * width + x)];
      if (material < 0 || !has_rare_hits[std::size_t(material)]) continue;
      for (int near_y = std::max(0, y - margin_px); near_y <= std::min(height - 1, y + margin_px); ++near_y)
        for (int near_x = std::max(0, x - margin_px); near_x <= std::min(width - 1, x + margin_px); ++near_x)
          is_near_rare[std::size_t(near_y * width + near_x)] = 1;
    }
  FilmCells film{.cells = {}, .cell_of_pixel = {}, .has_rare_hits = std::move(has_rare_hits)};
  std::map<std::tuple<std::int32_t, std::int32_t, char>, std::int32_t> cell_of;
  const int columns = blocks_along(width);
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      const std::size_t pixel = film.cell_of_pixel.size();
      const std::int32_t block = y / block_side * columns + x / block_side,
                         material = material_of_pixel[pixel];
      const char is_rare = is_near_rare[pixel];
      const auto [place, is_new] =
          cell_of.try_emplace({block, material, is_rare}, std::int32_t(film.cells.size()));
      if (is_new) film.cells.push_back({block, material, is_rare != 0, 0});
      ++film.cells[std::size_t(place->second)].pixels;
      film.cell_of_pixel.push_back(place->second);
    }
  return film;
}

}  // namespace etendue
