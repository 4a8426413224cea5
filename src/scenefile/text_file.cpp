#include "scenefile/text_file.h"

#include "scenefile/file_format.h"

#include <algorithm>
#include <boost/locale/utf.hpp>
#include <cerrno>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <fmt/format.h>
#include <iterator>

namespace etendue {
namespace {

namespace utf = boost::locale::utf;

[[noreturn]] void fail(const std::filesystem::path& file, std::string_view problem,
                       std::string_view hint = {}) {
  throw InputError({std::make_shared<SourceFile>(SourceFile{file.string(), {}}), 0, 1}, problem, hint);
}

std::string read_bytes(const std::filesystem::path& file, std::size_t most_bytes) {
  std::error_code error;
  if (std::filesystem::is_directory(file, error)) fail(file, "this is a folder, not a file");
  const std::unique_ptr<std::FILE, int (*)(std::FILE*)> stream(std::fopen(file.c_str(), "rb"), &std::fclose);
  if (!stream) fail(file, fmt::format("cannot open the file: {}", std::strerror(errno)));
  std::string bytes;
  char buffer[1 << 16];
  while (const std::size_t count = std::fread(buffer, 1, sizeof buffer, stream.get())) {
    bytes.append(buffer, count);
    if (bytes.size() > most_bytes)
      fail(file, fmt::format("the file is larger than {} MiB", most_bytes >> 20),
           "a scene file holds text; geometry belongs into mesh files");
  }
  if (std::ferror(stream.get())) fail(file, fmt::format("cannot read the file: {}", std::strerror(errno)));
  if (bytes.empty()) fail(file, "the file is empty");
  return bytes;
}

struct Encoding {
  int unit_bytes;  ///< 1: UTF-8, 2: UTF-16, 4: UTF-32.
  bool is_big_endian;
  std::size_t mark_bytes;
};

/// By the byte order mark or the zeros of the first character, as XML 1.0, appendix F, does for '<'.
Encoding detect_encoding(std::string_view bytes) {
  using namespace std::string_view_literals;
  if (bytes.starts_with("\xEF\xBB\xBF"sv)) return {1, false, 3};
  if (bytes.starts_with("\xFF\xFE\0\0"sv)) return {4, false, 4};
  if (bytes.starts_with("\0\0\xFE\xFF"sv)) return {4, true, 4};
  if (bytes.starts_with("\xFF\xFE"sv)) return {2, false, 2};
  if (bytes.starts_with("\xFE\xFF"sv)) return {2, true, 2};
  if (bytes.size() < 4) return {1, false, 0};
  const bool zero[4] = {bytes[0] == 0, bytes[1] == 0, bytes[2] == 0, bytes[3] == 0};
  if (zero[0] && zero[1] && zero[2] && !zero[3]) return {4, true, 0};
  if (!zero[0] && zero[1] && zero[2] && zero[3]) return {4, false, 0};
  if (zero[0] && !zero[1]) return {2, true, 0};
  if (!zero[0] && zero[1] && !zero[2]) return {2, false, 0};
  return {1, false, 0};
}

template <class Unit>
std::basic_string<Unit> to_units(std::string_view bytes, bool is_big_endian) {
  std::basic_string<Unit> units;
  for (std::size_t at = 0; at + sizeof(Unit) <= bytes.size(); at += sizeof(Unit)) {
    std::uint32_t unit = 0;
    for (std::size_t i = 0; i < sizeof(Unit); ++i)
      unit = unit << 8 | static_cast<unsigned char>(bytes[at + (is_big_endian ? i : sizeof(Unit) - 1 - i)]);
    units.push_back(static_cast<Unit>(unit));
  }
  return units;
}

template <class Unit>
std::string to_utf8(const std::filesystem::path& file, std::string_view bytes, bool is_big_endian) {
  if (bytes.size() % sizeof(Unit) != 0)
    fail(file, fmt::format("the UTF-{} text ends inside a character", 8 * sizeof(Unit)));
  const std::basic_string<Unit> units = to_units<Unit>(bytes, is_big_endian);
  std::string text;
  for (auto at = units.begin(); at != units.end();) {
    const auto begin = at;
    const utf::code_point character = utf::utf_traits<Unit>::decode(at, units.end());
    if (character == utf::illegal || character == utf::incomplete)
      fail(file, fmt::format("byte {} is not valid UTF-{}", (begin - units.begin()) * sizeof(Unit),
                             8 * sizeof(Unit)));
    utf::utf_traits<char>::encode(character, std::back_inserter(text));
  }
  return text;
}

bool declares_latin1(std::string_view text) {
  const std::size_t begin = text.find_first_not_of(" \t\r\n");
  if (begin == std::string_view::npos || text.substr(begin, 5) != "<?xml") return false;
  std::string declaration(text.substr(begin, text.find("?>", begin) - begin));
  for (char& c : declaration)
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  return declaration.find("iso-8859-1") != std::string::npos ||
         declaration.find("latin1") != std::string::npos;
}

/// Where `text` stops being UTF-8; its size where it does not.
std::size_t valid_utf8(std::string_view text) {
  const char* const end = text.data() + text.size();
  for (const char* at = text.data(); at != end;) {
    const char* const begin = at;
    const utf::code_point character = utf::utf_traits<char>::decode(at, end);
    if (character == utf::illegal || character == utf::incomplete)
      return static_cast<std::size_t>(begin - text.data());
  }
  return text.size();
}

std::string latin1_to_utf8(std::string_view bytes) {
  std::string text;
  for (const char byte : bytes)
    utf::utf_traits<char>::encode(static_cast<unsigned char>(byte), std::back_inserter(text));
  return text;
}

}  // namespace

std::string as_utf8(std::string_view bytes) {
  return valid_utf8(bytes) == bytes.size() ? std::string(bytes) : latin1_to_utf8(bytes);
}

std::shared_ptr<const SourceFile> read_text_file(const std::filesystem::path& file, std::size_t most_bytes) {
  std::string bytes = read_bytes(file, most_bytes);
  if (const std::string_view format = format_of_content(bytes); !format.empty())
    fail(file, fmt::format("this is {}", format),
         "read here is the XML of the Nori family, as docs/scene_format.md has it");
  const Encoding encoding = detect_encoding(bytes);
  const auto source =
      std::make_shared<SourceFile>(SourceFile{file.string(), bytes.substr(encoding.mark_bytes)});
  if (encoding.unit_bytes == 2)
    source->text = to_utf8<char16_t>(file, source->text, encoding.is_big_endian);
  else if (encoding.unit_bytes == 4)
    source->text = to_utf8<char32_t>(file, source->text, encoding.is_big_endian);
  else if (encoding.mark_bytes == 0 && declares_latin1(bytes))
    source->text = latin1_to_utf8(bytes);
  if (source->text.empty()) fail(file, "the file is empty");

  if (const std::size_t nul = source->text.find('\0'); nul != std::string::npos)
    throw InputError({source, nul, 1}, "a NUL character: this is no text file");
  if (const std::size_t invalid = valid_utf8(source->text); invalid != source->text.size())
    throw InputError({source, invalid, 1}, "not valid UTF-8", "save the file as UTF-8");
  return source;
}

}  // namespace etendue
