#include "scenefile/scene_files.h"

#include "base/content_hash.h"
#include "scenefile/dialect.h"

#include <cerrno>
#include <cstdio>
#include <fmt/format.h>
#include <memory>
#include <set>
#include <string>
#include <string_view>
#include <system_error>
#include <variant>
#include <vector>

namespace etendue {
namespace {

void add_files(const Object& object, const std::filesystem::path& directory,
               std::set<std::filesystem::path>& known, std::vector<std::filesystem::path>& files) {
  for (const Property& property : object.properties)
    if (const std::string* name = std::get_if<std::string>(&property.value);
        name && property.name == "filename")
      if (const auto [file, is_new] = known.insert(directory / *name); is_new) files.push_back(*file);
  for (const Object& child : object.children) add_files(child, directory, known, files);
}

/// The size comes behind the content, so that no two sequences of files read as the same bytes.
void add_size(ContentHash& hash, std::uint64_t size) { hash.add(&size, sizeof size); }

void add_text(ContentHash& hash, std::string_view text) {
  hash.add(text.data(), text.size());
  add_size(hash, text.size());
}

/// Reads through `buffer`: to make one for each of many small files costs more than to read them.
void add_content(ContentHash& hash, const std::filesystem::path& file, std::vector<char>& buffer) {
  const std::unique_ptr<std::FILE, int (*)(std::FILE*)> stream(std::fopen(file.c_str(), "rbe"), std::fclose);
  const auto fail = [&] {
    throw InputError(
        fmt::format("{}: cannot read: {}", file.string(), std::generic_category().message(errno)));
  };
  if (!stream) fail();
  std::uint64_t size = 0;
  while (const std::size_t count = std::fread(buffer.data(), 1, buffer.size(), stream.get())) {
    hash.add(buffer.data(), count);
    size += count;
  }
  if (std::ferror(stream.get())) fail();
  add_size(hash, size);
}

}  // namespace

std::vector<std::filesystem::path> files_named_by(const SceneDesc& description) {
  std::set<std::filesystem::path> known;
  std::vector<std::filesystem::path> files;
  add_files(description.root, description.directory, known, files);
  for (const std::filesystem::path& library : description.material_libraries)
    if (known.insert(library).second) files.push_back(library);
  return files;
}

std::uint64_t scene_hash(const SceneDesc& description) {
  ContentHash hash;
  add_text(hash, dialect_name(description.dialect));
  add_text(hash, description.root.location.source->text);
  std::vector<char> buffer(std::size_t(1) << 20);
  for (const std::filesystem::path& file : files_named_by(description)) add_content(hash, file, buffer);
  return hash.digest();
}

}  // namespace etendue
