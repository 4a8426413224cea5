#include "course/check_page.h"

#include "course/html_text.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace etendue {

namespace {

using nlohmann::json;

std::string text(const json& object, const char* key) {
  return object.contains(key) ? html_text(object[key].get<std::string>()) : "";
}

std::string verdict_cell(const json& property) {
  const std::string verdict = property["verdict"].get<std::string>();
  return fmt::format("<td class=\"verdict {}\">{}</td>", verdict == "cannot tell" ? "tell" : verdict,
                     verdict);
}

std::string properties_table(const json& result) {
  std::string rows;
  for (const json& one : result["properties"])
    rows += fmt::format("<tr>{}<td>{}</td><td>{}</td></tr>\n", verdict_cell(one), text(one, "name"),
                        text(one, "what"));
  return fmt::format(
      "<h2>Property by property</h2>\n<div class=\"scroll\"><table><tr><th>verdict</th><th>of</th><th>what "
      "was "
      "found</th></tr>\n{}</table></div>\n<p class=\"quiet\">A correct integrator fails one of these with a "
      "probability of {} at most.</p>\n",
      rows, result["level"].get<double>());
}

/// Those that are right, or those that are not.
std::string list_of_probes(const json& probes, bool are_right) {
  std::string items;
  for (const json& probe : probes)
    if (probe["is_right"] == are_right)
      items += fmt::format("<li>{}: {}</li>", text(probe, "name"), text(probe, "what"));
  return items.empty() ? "<p>none</p>" : "<ul>" + items + "</ul>";
}

std::string diagnosis_of(const json& result) {
  const json& diagnosis = result["diagnosis"];
  std::string html = "<h2>What is wrong</h2>\n";
  for (const json& one : diagnosis["findings"]) {
    const std::string how = text(one, "how");
    html += fmt::format(
        "<div class=\"found\"><p class=\"what\">{}</p>{}<p>{}</p><p class=\"quiet\">Read {}</p></div>\n",
        text(one, "what"), how.empty() ? "" : "<p>" + how + "</p>", text(one, "evidence"), text(one, "read"));
  }
  if (diagnosis["is_unknown"] == true)
    html += fmt::format(
        "<div class=\"found\"><p class=\"what\">{} wrong that no known mistake explains.</p><p>Wrong "
        "are:</p>{}<p>Right are:</p>{}</div>\n",
        diagnosis["findings"].empty() ? "Something is" : "Something else is",
        list_of_probes(result["probes"], false), list_of_probes(result["probes"], true));
  if (const std::string runner_up = text(diagnosis, "runner_up"); !runner_up.empty())
    html += fmt::format(
        "<p class=\"quiet\">The next best explanation of the single samples: {}. It explains {:.1f} % of the "
        "{} that are wrong, the best {:.1f} %. This is a rank, no probability.</p>\n",
        runner_up, 100 * diagnosis["share_runner_up"].get<double>(),
        diagnosis["samples_wrong"].get<std::int64_t>(), 100 * diagnosis["share_explained"].get<double>());
  return html;
}

/// What single samples are, over what they should be: a column a probe, a decade a step.
std::string plot_of(const json& result) {
  constexpr double width = 720, height = 330, left = 50, top = 12, bottom = 110, decades = 2;
  const json& probes = result["probes"];
  const double column = (width - left) / double(std::max<std::size_t>(probes.size(), 1));
  const double low = height - bottom, half = (low - top) / 2, zero = low + 14;
  const auto y_of = [&](double ratio) {
    if (!(ratio > 0)) return zero;
    return top + half - half * std::clamp(std::log10(ratio) / decades, -1.0, 1.0);
  };
  std::string svg = fmt::format(
      "<svg viewBox=\"0 0 {} {}\" role=\"img\" aria-label=\"Single samples over what they should be\">\n",
      width, height);
  for (int decade = -int(decades); decade <= int(decades); ++decade) {
    const double y = y_of(std::pow(10.0, decade));
    svg += fmt::format(
        "<line x1=\"{}\" x2=\"{}\" y1=\"{:.1f}\" y2=\"{:.1f}\" stroke=\"{}\"/><text x=\"{}\" y=\"{:.1f}\" "
        "font-size=\"12\" text-anchor=\"end\">{:g}</text>\n",
        left, width, y, y, decade == 0 ? "#1b6e2c" : "#ddd", left - 6, y + 4, std::pow(10.0, decade));
  }
  svg += fmt::format("<text x=\"{}\" y=\"{:.1f}\" font-size=\"12\" text-anchor=\"end\">≤ 0</text>\n",
                     left - 6, zero + 4);
  for (std::size_t probe = 0; probe < probes.size(); ++probe)
    svg += fmt::format(
        "<text transform=\"translate({:.1f} {:.1f}) rotate(-28)\" font-size=\"11\" "
        "text-anchor=\"end\">{}</text>\n",
        left + column * (double(probe) + 0.62), zero + 18, text(probes[probe], "name"));
  constexpr const char* colors[]{"#c0392b", "#2c8a4b", "#2455b8", "#8e44ad"};
  std::size_t index = 0;
  for (const json& point : result["points"]) {
    const double right = point["right"], found = point["found"];
    const int light = point["light"];
    // Spread by the golden ratio, so that points of one value are seen to be many.
    const double spread = std::fmod(0.618034 * double(++index), 1.0);
    const double x = left + column * (point["probe"].get<double>() + 0.1 + 0.8 * spread);
    const bool is_from_nothing = right == 0;
    svg += fmt::format("<circle cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"{}\" fill=\"{}\" fill-opacity=\"0.6\"/>\n", x,
                       is_from_nothing ? top : y_of(found / right), is_from_nothing ? 3.5 : 2.2,
                       colors[std::size_t(std::max(light, 0)) % 4]);
  }
  return fmt::format(
      "<h2>Single samples</h2>\n<figure><div class=\"scroll\">{}</svg></div><figcaption>Each dot is one "
      "sample of a probe: what came "
      "over what "
      "is right for the very same point on the light; a colour a light. All are on the green line where the "
      "code is right. At the upper edge: light where there should be none.</figcaption></figure>\n",
      svg);
}

std::string pictures_of(const std::filesystem::path& folder) {
  std::string html;
  for (const char* scene : {"area_sampling", "phong_plates"}) {
    struct Picture {
      const char *file, *caption;
    };
    std::string figures;
    for (const auto& [file, caption] :
         {Picture{"students", "yours"}, Picture{"light", "the program's"},
          Picture{"difference", "grey: alike; blue: yours is darker; red: brighter"}})
      if (const std::string png = png_in_page(folder / fmt::format("{}_{}.png", scene, file)); !png.empty())
        figures +=
            fmt::format("<figure><img alt=\"{0}, {1}\" src=\"{2}\"><figcaption>{1}</figcaption></figure>",
                        scene, caption, png);
    if (!figures.empty()) html += fmt::format("<h3>{}</h3>\n<div class=\"three\">{}</div>\n", scene, figures);
  }
  return html.empty() ? "" : "<h2>The exercise's scenes</h2>\n" + html;
}

std::string probes_of(const json& result) {
  std::string rows;
  for (const json& probe : result["probes"])
    rows += fmt::format("<tr><td>{}</td><td>{}</td></tr>\n", text(probe, "name"), text(probe, "what"));
  return "<h2>The probes</h2>\n<p>Small scenes; their files are in <code>build/check</code>, and "
         "<code>etendue "
         "render</code> shows them.</p>\n<div class=\"scroll\"><table>" +
         rows + "</table></div>\n";
}

}  // namespace

std::string check_page(const json& result, const std::filesystem::path& folder) {
  const std::string outcome = result["outcome"].get<std::string>();
  std::string html = html_head("Light integrator: " + outcome);
  html += fmt::format("<h1>Light integrator: <span class=\"{}\">{}</span></h1>\n<p class=\"quiet\">{}</p>\n",
                      outcome == "right" ? "right" : "wrong", html_text(outcome), text(result, "folder"));
  if (const std::string why = text(result, "why"); !why.empty()) html += "<p>" + why + "</p>\n";
  if (outcome == "ended" && !text(result, "at").empty())
    html += "<p>It was at: " + text(result, "at") + "</p>\n";
  if (outcome == "wrong") html += diagnosis_of(result);
  if (result.contains("properties")) {
    html += properties_table(result) + plot_of(result) + pictures_of(folder) + probes_of(result);
  }
  if (const std::string messages = text(result, "compiler"); !messages.empty())
    html += "<h2>The compiler</h2>\n<pre>" + messages + "</pre>\n";
  if (const std::string printed = text(result, "printed"); !printed.empty())
    html += "<h2>What the code printed</h2>\n<pre>" + printed + "</pre>\n";
  return html + "</body>\n</html>\n";
}

}  // namespace etendue
