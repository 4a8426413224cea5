// A scene file's text as UTF-8, whatever Unicode encoding it came in.
#pragma once

#include "base/error.h"

#include <filesystem>
#include <memory>
#include <string>
#include <string_view>

namespace etendue {

/// Reads a text file: UTF-8, UTF-16 or UTF-32 with or without a byte order mark (without: told by the zero
/// bytes of the first character), or ISO-8859-1 where an XML declaration says so. The result has no byte
/// order mark. Throws InputError for a folder, a file that cannot be read, is empty, is larger than
/// `most_bytes`, holds a NUL character, or is not in the encoding it seems to be.
std::shared_ptr<const SourceFile> read_text_file(const std::filesystem::path& file,
                                                 std::size_t most_bytes = std::size_t{256} << 20);

/// The same text where it is UTF-8; else read as ISO-8859-1, in which everything is text.
std::string as_utf8(std::string_view bytes);

}  // namespace etendue
