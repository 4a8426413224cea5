// What an error says.
#pragma once

#include "base/error.h"

#include <string>

namespace etendue::test {

/// The message of the InputError that `run()` throws; empty where it throws none.
template <class Run>
std::string error_of(Run&& run) {
  try {
    run();
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

}  // namespace etendue::test
