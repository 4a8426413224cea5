#include "scenefile/existing_file.h"

#include <algorithm>
#include <fmt/format.h>
#include <string>
#include <system_error>

namespace etendue {
namespace {

namespace fs = std::filesystem;

bool is_same_but_for_capitals(std::string_view a, std::string_view b) {
  const auto small = [](char c) { return c >= 'A' && c <= 'Z' ? char(c - 'A' + 'a') : c; };
  return std::equal(a.begin(), a.end(), b.begin(), b.end(),
                    [&](char x, char y) { return small(x) == small(y); });
}

/// The entry of `folder` that differs from `name` in capitals only; empty where there is none.
fs::path entry_like(const fs::path& folder, const std::string& name) {
  std::error_code error;
  for (fs::directory_iterator entry(folder.empty() ? "." : folder, error), end; !error && entry != end;
       entry.increment(error))
    if (is_same_but_for_capitals(entry->path().filename().string(), name)) return entry->path().filename();
  return {};
}

/// What `stated` may mean in `directory`, as scenes of other systems have it: with backslashes between
/// folders, or with other capitals. Empty where no such file is there.
std::string meant_path(std::string stated, const fs::path& directory) {
  std::replace(stated.begin(), stated.end(), '\\', '/');
  fs::path found;
  std::error_code error;
  for (const fs::path& part : fs::path(stated)) {
    if (part.is_absolute() || part == "." || part == ".." || fs::exists(directory / found / part, error)) {
      found /= part;
      continue;
    }
    const fs::path near = entry_like(directory / found, part.string());
    if (near.empty()) return {};
    found /= near;
  }
  return found.string();
}

std::string what_to_do(const std::string& stated, const fs::path& directory, std::string_view relative_to) {
  const std::string meant = meant_path(stated, directory);
  const bool has_backslashes = stated.find('\\') != std::string::npos;
  if (!meant.empty())
    return fmt::format("did you mean '{}'? {}", meant,
                       has_backslashes ? "folders are parted by /, not by the backslash of Windows"
                                       : "capitals count in the names of files");
  return fmt::format("looked for {}; paths are relative to {}{}", (directory / stated).string(), relative_to,
                     has_backslashes ? ", and folders are parted by /, not by a backslash" : "");
}

}  // namespace

std::filesystem::path existing_file(const std::string& stated, const Location& where,
                                    const std::filesystem::path& directory, std::string_view wanted,
                                    std::string_view relative_to) {
  const std::filesystem::path file = directory / stated;
  std::error_code error;
  const std::filesystem::file_status status = std::filesystem::status(file, error);
  if (!std::filesystem::exists(status))
    throw InputError(where, fmt::format("'{}' is not there", stated),
                     what_to_do(stated, directory, relative_to));
  if (std::filesystem::is_directory(status))
    throw InputError(where, fmt::format("'{}' is a folder", stated),
                     fmt::format("give the name of {}", wanted));
  return file;
}

std::filesystem::path existing_file(const Parameters& parameters, std::string_view name,
                                    const std::filesystem::path& directory, std::string_view wanted) {
  return existing_file(parameters.text(name), parameters.location(name), directory, wanted, "the scene file");
}

}  // namespace etendue
