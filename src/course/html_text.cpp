#include "course/html_text.h"

#include <cstdint>
#include <fmt/format.h>
#include <fstream>
#include <iterator>

namespace etendue {

namespace {

constexpr std::string_view style = R"(
  body { font: 16px/1.5 sans-serif; margin: 0 auto; padding: 1em; max-width: 60em; color: #222; background: #fff; }
  h1 { font-size: 1.5em; line-height: 1.2; } h2 { font-size: 1.2em; margin-top: 2em; }
  table { border-collapse: collapse; width: 100%; } td, th { text-align: left; vertical-align: top; padding: .3em .6em .3em 0; border-bottom: 1px solid #ddd; }
  .scroll { overflow-x: auto; }
  .right { color: #1b6e2c; } .wrong { color: #b3261e; font-weight: bold; } .tell { color: #6b5900; }
  .verdict { white-space: nowrap; }
  .found { border-left: 4px solid #b3261e; padding: .1em 0 .1em 1em; margin: 1em 0; }
  .found p { margin: .3em 0; } .found .what { font-weight: bold; } .quiet { color: #666; font-size: .9em; }
  pre { white-space: pre-wrap; overflow-wrap: anywhere; background: #f3f3f3; padding: .8em; font-size: .85em; }
  figure { margin: 1em 0; } .three { display: grid; grid-template-columns: repeat(auto-fit, minmax(220px, 1fr)); gap: .8em; }
  .three figure { margin: 0; } img { width: 100%; image-rendering: pixelated; display: block; background: #000; }
  figcaption { color: #666; font-size: .9em; } svg { width: 100%; min-width: 600px; height: auto; display: block; }
)";

}  // namespace

std::string html_text(std::string_view text) {
  std::string html;
  for (const char c : text) {
    if (c == '&')
      html += "&amp;";
    else if (c == '<')
      html += "&lt;";
    else if (c == '>')
      html += "&gt;";
    else if (c == '"')
      html += "&quot;";
    else
      html += c;
  }
  return html;
}

std::string png_data_uri(std::string_view bytes) {
  if (bytes.empty()) return "";
  constexpr std::string_view digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text = "data:image/png;base64,";
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    std::uint32_t three = 0;
    for (std::size_t k = 0; k < 3; ++k)
      three = three << 8 | (i + k < bytes.size() ? std::uint8_t(bytes[i + k]) : 0u);
    for (std::size_t k = 0; k < 4; ++k)
      text += i + k <= bytes.size() ? digits[three >> (18 - 6 * k) & 63] : '=';
  }
  return text;
}

std::string png_in_page(const std::filesystem::path& file) {
  std::ifstream in(file, std::ios::binary);
  return png_data_uri(std::string{std::istreambuf_iterator<char>(in), {}});
}

std::string html_head(std::string_view title) {
  return fmt::format(
      "<!doctype html>\n<html lang=\"en\">\n<meta charset=\"utf-8\">\n"
      "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n"
      "<title>{}</title>\n<style>{}</style>\n<body>\n",
      html_text(title), style);
}

}  // namespace etendue
