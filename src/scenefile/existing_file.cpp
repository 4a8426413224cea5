#include "scenefile/existing_file.h"

#include <fmt/format.h>
#include <system_error>

namespace etendue {

std::filesystem::path existing_file(const Parameters& parameters, std::string_view name,
                                    const std::filesystem::path& directory, std::string_view wanted) {
  const std::string stated = parameters.text(name);
  const std::filesystem::path file = directory / stated;
  std::error_code error;
  const std::filesystem::file_status status = std::filesystem::status(file, error);
  if (!std::filesystem::exists(status))
    throw InputError(parameters.location(name), fmt::format("'{}' is not there", stated),
                     fmt::format("looked for {}; paths are relative to the scene file", file.string()));
  if (std::filesystem::is_directory(status))
    throw InputError(parameters.location(name), fmt::format("'{}' is a folder", stated),
                     fmt::format("give the name of {}", wanted));
  return file;
}

}  // namespace etendue
