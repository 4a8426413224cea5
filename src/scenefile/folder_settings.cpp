#include "scenefile/folder_settings.h"

#include "scenefile/dialect.h"
#include "scenefile/text_file.h"

#include <algorithm>
#include <fmt/format.h>
#include <nlohmann/json.hpp>
#include <system_error>

namespace etendue {
namespace {

namespace fs = std::filesystem;
constexpr std::string_view what_is_expected = "expected {\"dialect\": \"nori-eth\"}, or another dialect";

/// The place of `"text"`; the whole file where it is not written so.
Location place_of_setting(const std::shared_ptr<const SourceFile>& source, const std::string& text) {
  const std::size_t found = source->text.find('"' + text + '"');
  return found == std::string::npos ? Location{source} : Location{source, found + 1, text.size()};
}

FolderSettings read_settings(const fs::path& file) {
  const auto source = read_text_file(file);
  nlohmann::json json;
  try {
    json = nlohmann::json::parse(source->text);
  } catch (const nlohmann::json::parse_error& error) {
    throw InputError({source, std::min(error.byte > 0 ? error.byte - 1 : 0, source->text.size() - 1), 1},
                     "not well-formed JSON", what_is_expected);
  } catch (const nlohmann::json::exception&) {
    throw InputError({source}, "it has a number that does not fit", what_is_expected);
  }
  if (!json.is_object()) throw InputError({source}, "not a JSON object", what_is_expected);
  FolderSettings settings{file, std::nullopt};
  for (const auto& [key, value] : json.items()) {
    if (key != "dialect")
      throw InputError(place_of_setting(source, key), fmt::format("unknown key '{}'", key),
                       known_names(key, {"dialect"}));
    if (!value.is_string())
      throw InputError(place_of_setting(source, key), "'dialect' must be text", what_is_expected);
    const auto name = value.get<std::string>();
    settings.dialect = find_dialect(name);
    if (!settings.dialect)
      throw InputError(place_of_setting(source, name), fmt::format("unknown dialect '{}'", name),
                       known_names(name, dialect_names()));
  }
  return settings;
}

}  // namespace

std::optional<FolderSettings> folder_settings_of(const fs::path& scene_file) {
  std::error_code error;
  const fs::path beside = scene_file.parent_path() / "etendue.json";  // Named as the scene is.
  if (fs::is_regular_file(beside, error)) return read_settings(beside);
  for (fs::path folder = fs::absolute(scene_file, error).lexically_normal().parent_path();
       folder != folder.parent_path();) {
    folder = folder.parent_path();
    const fs::path file = folder / "etendue.json";
    if (fs::is_regular_file(file, error)) return read_settings(file);
  }
  return std::nullopt;
}

}  // namespace etendue
