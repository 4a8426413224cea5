// Pieces of HTML pages: text that stays text, files as a part of the page.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

namespace etendue {

/// With what HTML reads as markup written out.
std::string html_text(std::string_view text);

/// The bytes of a PNG, or a file of them, as the src of an img; empty where there are none.
std::string png_data_uri(std::string_view bytes);
std::string png_in_page(const std::filesystem::path& file);

/// Head, style and <body> of a page.
std::string html_head(std::string_view title);

}  // namespace etendue
