// The squares that pilots render stand all over the image, each in a tile of its own.
//
// Seen to fail when: they stand at equal distances in the order of tiles; a column of tiles is left out.
#include "render/pilot_squares.h"

#include <algorithm>
#include <array>
#include <gtest/gtest.h>
#include <map>
#include <set>
#include <utility>

namespace etendue {
namespace {

constexpr int tile_px = LightCut::tile_px;

/// How many squares stand in each cell of that many tiles.
std::map<std::pair<int, int>, int> counts(const std::vector<PixelRectangle>& squares, int columns, int rows) {
  std::map<std::pair<int, int>, int> counts;
  for (const PixelRectangle& square : squares)
    ++counts[{square.x_begin / (tile_px * columns), square.y_begin / (tile_px * rows)}];
  return counts;
}

TEST(PilotSquares, StandInTilesOfTheirOwnWithinTheImage) {
  for (const auto& [width, height, count] :
       {std::array{256, 256, 64}, {1280, 720, 900}, {1279, 717, 900}, {65536, 8, 60}, {8, 8192, 64}}) {
    const std::vector<PixelRectangle> squares = pilot_squares(width, height, count);
    EXPECT_EQ(squares.size(), std::size_t(count)) << width;
    EXPECT_EQ(counts(squares, 1, 1).size(), squares.size()) << width;
    for (const PixelRectangle& square : squares) {
      EXPECT_EQ(square.width(), PilotSquares::side_px);
      EXPECT_EQ(square.height(), PilotSquares::side_px);
      EXPECT_TRUE(square.x_begin >= 0 && square.y_begin >= 0 && square.x_end <= width &&
                  square.y_end <= height);
      EXPECT_EQ(square.x_begin / tile_px, (square.x_end - 1) / tile_px);
      EXPECT_EQ(square.y_begin / tile_px, (square.y_end - 1) / tile_px);
    }
  }
}

TEST(PilotSquares, AreSpreadEvenly) {
  // 32 x 32 tiles: each cell of 1/64 of the image has one square, whichever way it is cut.
  const std::vector<PixelRectangle> squares = pilot_squares(256, 256, 64);
  for (const auto& [columns, rows] : {std::pair{32, 1}, {16, 1}, {8, 2}, {4, 4}, {2, 8}, {1, 16}, {1, 32}}) {
    const int cells = 32 / columns * (32 / rows);
    const auto in = counts(squares, columns, rows);
    EXPECT_EQ(in.size(), std::size_t(cells)) << columns;
    for (const auto& [cell, count] : in) EXPECT_EQ(count, 64 / cells) << columns;
  }
  // 160 x 90 tiles, about 100 squares in each ninth.
  const auto in = counts(pilot_squares(1280, 720, 900), 160 / 3 + 1, 30);
  EXPECT_EQ(in.size(), 9u);
  for (const auto& [cell, count] : in) EXPECT_NEAR(count, 100, 10);
}

TEST(PilotSquares, AreAsManyAsThereIsRoomFor) {
  EXPECT_EQ(pilot_squares(256, 128, 10000).size(), 512u);
  EXPECT_EQ(pilot_squares(8, 8, 10).size(), 1u);
  EXPECT_EQ(pilot_squares(1, 1, 10).size(), 0u);
}

}  // namespace
}  // namespace etendue
