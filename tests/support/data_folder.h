// Where files of others lie that tests read: they are not part of the project.
#pragma once

#include <cstdlib>
#include <filesystem>

namespace etendue::test {

/// $ETENDUE_TEST_DATA, or ../shared/data beside the project. It may be absent: tests skip then.
inline std::filesystem::path data_folder() {
  const char* given = std::getenv("ETENDUE_TEST_DATA");
  return given ? std::filesystem::path(given) : std::filesystem::path(ETENDUE_SOURCE_DIR) / "../shared/data";
}

}  // namespace etendue::test
