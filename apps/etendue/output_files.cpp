#include "output_files.h"

#include "base/error.h"
#include "base/temporary_file.h"
#include "scenefile/scene_files.h"

#include <cstdio>
#include <fmt/format.h>
#include <map>
#include <optional>
#include <sys/stat.h>
#include <system_error>
#include <utility>

namespace etendue::app {

namespace {

/// What all ways to an existing file have in common.
using FileId = std::pair<dev_t, ino_t>;
std::optional<FileId> id_of(const std::filesystem::path& file) {
  struct stat status {};
  if (stat(file.c_str(), &status) != 0) return std::nullopt;
  return FileId{status.st_dev, status.st_ino};
}

/// Also by another way to the same file, be it there or not.
bool is_same_file(const std::filesystem::path& a, const std::filesystem::path& b) {
  std::error_code error;
  const auto whole = [&](const std::filesystem::path& file) {
    return std::filesystem::weakly_canonical(std::filesystem::absolute(file, error), error);
  };
  return (whole(a) == whole(b) && !whole(a).empty()) || std::filesystem::equivalent(a, b, error);
}

}  // namespace

std::vector<std::filesystem::path> files_of(const SceneDesc& description,
                                            const std::filesystem::path& scene_file) {
  std::vector<std::filesystem::path> files = files_named_by(description);
  files.push_back(scene_file);
  if (!description.settings_file.empty()) files.push_back(description.settings_file);
  return files;
}

void check_overwrites_nothing(const std::vector<std::string>& written,
                              const std::vector<std::filesystem::path>& read) {
  // A file that is not there yet cannot be read; of the others there may be 200,000.
  std::map<FileId, std::string> there;
  for (const std::string& file : written)
    if (const std::optional<FileId> id = id_of(file)) there.emplace(*id, file);
  if (!there.empty())
    for (const std::filesystem::path& file : read)
      if (const std::optional<FileId> id = id_of(file); id && there.contains(*id))
        throw InputError(fmt::format(
            "{}: this file would be overwritten, and it is read\nwrite to another name", there.at(*id)));
  for (std::size_t i = 0; i < written.size(); ++i) {
    for (std::size_t k = 0; k < i; ++k)
      if (is_same_file(written[i], written[k]))
        throw InputError(fmt::format(
            "{}: this file would be written twice\ngive each output a name of its own", written[i]));
  }
}

void write_text_file(const std::filesystem::path& file, const std::string& text) {
  TemporaryFile out(file);
  out.write(text.data(), text.size());
  out.commit();
}

}  // namespace etendue::app
