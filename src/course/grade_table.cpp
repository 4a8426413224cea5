#include "course/grade_table.h"

#include "course/html_text.h"

#include <filesystem>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace etendue {

namespace {

using nlohmann::json;

/// In one line: what ended it, or the mistakes by their names, and what else befell.
std::string found_in(const json& result) {
  if (!result.contains("diagnosis")) return result["why"].get<std::string>();
  std::string text;
  for (const json& one : result["diagnosis"]["findings"])
    text += (text.empty() ? "" : ", ") + one["name"].get<std::string>();
  if (result["diagnosis"]["is_unknown"] == true) text += text.empty() ? "unknown" : ", unknown";
  const std::string befell = result["why"].get<std::string>();
  return text.empty() || befell.empty() ? text + befell : text + "; " + befell;
}

std::string group_of(const json& result) {
  return result.contains("group") ? std::to_string(result["group"].get<int>()) : "";
}

double sum_of_points(const Rubric& rubric, const json& result) {
  double sum = 0;
  for (const RubricPart& part : rubric) sum += points_of(part, result);
  return sum;
}

std::string student_name(const json& result) {
  return std::filesystem::path(result["folder"].get<std::string>()).filename().string();
}

std::string csv_field(const std::string& text) {
  if (text.find_first_of(",\"\n") == std::string::npos) return text;
  std::string quoted = "\"";
  for (const char c : text) quoted += c == '"' ? "\"\"" : std::string(1, c == '\n' ? ' ' : c);
  return quoted + "\"";
}

}  // namespace

std::string grade_csv(const Rubric& rubric, const std::vector<json>& results) {
  std::string csv = "folder,group,outcome";
  for (const RubricPart& part : rubric) csv += fmt::format(",{} ({:g})", csv_field(part.title), part.points);
  csv += ",sum so far,found\n";
  for (const json& result : results) {
    csv += fmt::format("{},{},{}", csv_field(student_name(result)), group_of(result),
                       result["outcome"].get<std::string>());
    for (const RubricPart& part : rubric)
      csv += part.is_written ? "," : fmt::format(",{:g}", points_of(part, result));
    csv += fmt::format(",{:g},{}\n", sum_of_points(rubric, result), csv_field(found_in(result)));
  }
  return csv;
}

std::string grade_page(const Rubric& rubric, const std::vector<json>& results,
                       const std::vector<std::string>& reports) {
  std::string html = html_head("Light integrators: points") +
                     "<h1>Light integrators</h1>\n<div class=\"scroll\">"
                     "<table><tr><th>folder</th><th>group</th><th>outcome</th>";
  for (const RubricPart& part : rubric)
    html += fmt::format("<th>{} ({:g})</th>", html_text(part.title), part.points);
  html += "<th>sum so far</th><th>found</th></tr>\n";
  for (std::size_t i = 0; i < results.size(); ++i) {
    const json& result = results[i];
    const std::string outcome = result["outcome"].get<std::string>();
    html += fmt::format("<tr><td><a href=\"{}\">{}</a></td><td>{}</td><td class=\"{}\">{}</td>",
                        html_text(reports[i]), html_text(student_name(result)), group_of(result),
                        outcome == "right" ? "right" : "wrong", outcome);
    for (const RubricPart& part : rubric)
      html += part.is_written ? "<td class=\"quiet\">to read</td>"
                              : fmt::format("<td>{:g}</td>", points_of(part, result));
    html += fmt::format("<td>{:g}</td><td>{}</td></tr>\n", sum_of_points(rubric, result),
                        html_text(found_in(result)));
  }
  return html +
         "</table></div>\n<p class=\"quiet\">Written answers are a person's to read. Whether two groups "
         "have the same results is not judged.</p>\n</body>\n</html>\n";
}

}  // namespace etendue
