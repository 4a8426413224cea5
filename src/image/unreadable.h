// What the readers of image files throw to each other; who asked for the image hears it as an InputError.
#pragma once

#include <stdexcept>
#include <string>

namespace etendue {

/// What is wrong with a file, without its name: "it ends too early".
struct Unreadable : std::runtime_error {
  using std::runtime_error::runtime_error;
};

}  // namespace etendue
