// Summaries as JSON, CSV and HTML.

#include "summary.h"

#include <kaboum/base/xml_text.h>

#include <algorithm>
#include <array>
#include <sstream>

namespace kaboum::batch {
namespace {

constexpr std::array kStates{"done", "no", "failed", "timeout", "memory"};

/// A column: its title, key in the JSON and class.
struct Column {
  const char* title;
  const char* key;
  bool number;
};
constexpr std::array<Column, 15> kColumns{{{"file", "name", false},
                                           {"state", "state", false},
                                           {"verdict", "verdict", false},
                                           {"vertices before", "vertices_before", true},
                                           {"after", "vertices_after", true},
                                           {"ratio", "ratio", true},
                                           {"bodies", "bodies", true},
                                           {"distance", "distance", true},
                                           {"diagonal", "diagonal", true},
                                           {"bytes before", "input_bytes", true},
                                           {"after", "output_bytes", true},
                                           {"CPU s", "cpu_seconds", true},
                                           {"MB", "peak_megabytes", true},
                                           {"reason", "reason", false},
                                           {"options", "parameters", false}}};

/// Of a file, as a relative link.
std::string link_to(const std::string& path) {
  static constexpr const char* kDigits = "0123456789ABCDEF";
  std::string out;
  for (const char c : path) {
    const auto byte = static_cast<unsigned char>(c);
    if (std::isalnum(byte) != 0 || std::string("-._~/").find(c) != std::string::npos)
      out += c;
    else
      out += std::string("%") + kDigits[byte >> 4U] + kDigits[byte & 15U];
  }
  return out;
}

std::string text_of(const Json& value) {
  if (value.is_null()) return {};
  if (value.is_string()) return value.get<std::string>();
  if (!value.is_number_float()) return value.dump();
  std::ostringstream text;
  text.precision(6);
  text << value.get<double>();
  return text.str();
}

std::string quoted(const std::string& text) {
  if (text.find_first_of(",\"\r\n") == std::string::npos) return text;
  std::string out = "\"";
  for (const char c : text) out += c == '"' ? std::string("\"\"") : std::string(1, c);
  return out + "\"";
}

constexpr const char* kHead = R"(<meta name="viewport" content="width=device-width">
<style>
body { font: 14px/1.4 system-ui, sans-serif; margin: 1.5em; color: #222; }
table { border-collapse: collapse; }
th, td { padding: .3em .6em; border-bottom: 1px solid #ddd; text-align: left; vertical-align: top; }
th { position: sticky; top: 0; background: #fff; cursor: pointer; white-space: nowrap; }
td.n { text-align: right; font-variant-numeric: tabular-nums; }
td.s { font-weight: 600; } .done { color: #1a7f37; } .no { color: #9a6700; }
.failed, .timeout, .memory { color: #cf222e; }
img { width: 160px; height: 110px; object-fit: contain; display: block; }
</style>
)";

constexpr const char* kScript = R"(<script>
document.querySelectorAll('th').forEach((head, column) => head.addEventListener('click', () => {
  const body = document.querySelector('tbody'), up = head.dataset.up !== '1';
  head.dataset.up = up ? '1' : '0';
  const key = row => { const cell = row.cells[column];
    return cell.className === 'n' ? (cell.textContent === '' ? -Infinity : +cell.textContent) : cell.textContent; };
  [...body.rows].map(row => [key(row), row])
    .sort((a, b) => (a[0] < b[0] ? -1 : a[0] > b[0] ? 1 : 0) * (up ? 1 : -1))
    .forEach(entry => body.append(entry[1]));
}));
</script>
)";

void add_cell(std::string& page, const char* kind, std::string_view text) {
  page.append("<td");
  if (*kind != '\0') page.append(" class=\"").append(kind).append("\"");
  page.append(">").append(text).append("</td>");
}

void add_row(std::string& page, const Record& record, bool pictures) {
  const Json json = to_json(record);
  page.append("<tr>");
  if (pictures) {
    std::string image;
    if (!record.picture.empty())
      image.append("<img loading=\"lazy\" alt=\"\" src=\"")
          .append(link_to(record.picture))
          .append("\">");
    add_cell(page, "", image);
  }
  for (const Column& column : kColumns) {
    const std::string key = column.key;
    std::string text = escape_xml(text_of(json[key])), kind = column.number ? "n" : "";
    if (key == "state") kind.append("s ").append(text);
    if (key == "name" && record.has_result())
      text.insert(0, "<a href=\"" + link_to(record.output) + "\">").append("</a>");
    add_cell(page, kind.c_str(), text);
  }
  page.append("</tr>\n");
}

/// The rows of the page.
std::vector<const Record*> shown_of(std::span<const Record> records) {
  constexpr std::size_t kMost = 10'000;
  std::vector<const Record*> shown;
  shown.reserve(records.size());
  for (const Record& record : records) shown.push_back(&record);
  if (shown.size() <= kMost) return shown;
  std::stable_partition(shown.begin(), shown.end(), [](const Record* r) { return !r->done(); });
  shown.resize(kMost);
  return shown;
}

/// All but the rows.
Json head_of(const BatchResult& result) {
  Json counts = Json::object();
  for (const char* state : kStates) counts[state] = result.count(state);
  return {{"files", result.records.size() + result.to_do},
          {"states", counts},
          {"done_before", result.done_before},
          {"to_do", result.to_do}};
}

}  // namespace

std::size_t BatchResult::count(const char* state) const {
  return static_cast<std::size_t>(std::count_if(records.begin(), records.end(),
                                                [&](const Record& r) { return r.state == state; }));
}

std::string BatchResult::words() const {
  std::string text;
  for (const char* state : kStates)
    if (const std::size_t n = count(state); n > 0)
      text += (text.empty() ? "" : ", ") + std::to_string(n) + " " + state;
  if (done_before > 0) text += "; " + std::to_string(done_before) + " of them earlier";
  if (to_do > 0) text += (text.empty() ? "" : "; ") + std::to_string(to_do) + " to do";
  return text.empty() ? "no file" : text;
}

std::string BatchResult::json() const {
  std::string text = head_of(*this).dump(1);
  text.resize(text.rfind('\n'));  // goes on instead of ending
  text += ",\n \"rows\": [";
  const char* before = "\n";
  for (const Record& record : records) {
    text += before + to_json(record).dump(-1, ' ', false, Json::error_handler_t::replace);
    before = ",\n";
  }
  return text + "\n ]\n}\n";
}

std::string csv_of(const BatchResult& summary) {
  std::string text;
  const auto add = [&](const Json& row, const auto& cell) {
    bool first = true;
    for (const auto& [key, value] : row.items()) {
      if (value.is_array()) continue;  // the JSON has them
      if (!first) text += ',';
      text += cell(key, value);
      first = false;
    }
    text += '\n';
  };
  add(to_json(Record{}), [](const std::string& key, const Json&) { return key; });
  for (const Record& record : summary.records)
    add(to_json(record),
        [](const std::string&, const Json& value) { return quoted(text_of(value)); });
  return text;
}

std::string html_of(const BatchResult& summary, const std::string& title) {
  const std::vector<const Record*> shown = shown_of(summary.records);
  const bool pictures =
      std::any_of(shown.begin(), shown.end(), [](const Record* r) { return !r->picture.empty(); });
  std::string page = "<!DOCTYPE html>\n<html lang=\"en\"><meta charset=\"utf-8\"><title>" +
                     escape_xml(title) + "</title>\n" + kHead + "<h1>" + escape_xml(title) +
                     "</h1>\n<p>" + std::to_string(summary.records.size() + summary.to_do) +
                     " files: " + escape_xml(summary.words()) + ". ";
  if (shown.size() < summary.records.size())
    page += "Shown are " + std::to_string(shown.size()) +
            ", first those that are not done; summary.csv has all. ";
  page +=
      "Lengths are in the units of the files; a click on a title sorts.</p>\n<table><thead><tr>";
  if (pictures) page += "<th></th>";
  for (const Column& column : kColumns) page += std::string("<th>") + column.title + "</th>";
  page += "</tr></thead><tbody>\n";
  for (const Record* record : shown) add_row(page, *record, pictures);
  return page + "</tbody></table>\n" + kScript + "</html>\n";
}

}  // namespace kaboum::batch
