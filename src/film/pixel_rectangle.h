// A rectangle of pixels.
#pragma once

namespace etendue {

/// The ends are exclusive.
struct PixelRectangle {
  int x_begin, y_begin, x_end, y_end;

  int width() const { return x_end - x_begin; }
  int height() const { return y_end - y_begin; }
};

}  // namespace etendue
