// Bytes as an image file: all its pixels or an error, nothing else.
#include "base/error.h"
#include "image/color_file.h"
#include "support/memory_file.h"

#include <cstdlib>

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const etendue::test::MemoryFile file(data, size);
  try {
    const etendue::ColorImage image = etendue::read_colors(file.path());
    if (image.rgb.size() != 3 * std::size_t(image.width) * std::size_t(image.height)) std::abort();
  } catch (const etendue::InputError&) {
  } catch (const etendue::ColorRequestError&) {
  }
  return 0;
}
