#include "lab/study/pareto.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <numeric>
#include <span>

#include "content/files/file_io.h"
#include "lab/console/print.h"
#include "lab/files/csv.h"

namespace pliant {
namespace {

// Appends a comma and the value.
void put_value(std::string& csv, const StudyValue& value) {
  if (const auto* words = std::get_if<std::string>(&value)) {
    csv += ',' + csv_text(*words);
  } else if (const auto* number = std::get_if<double>(&value)) {
    if (std::isfinite(*number))
      put(csv, *number);
    else
      csv += ',';
  } else if (const auto* count = std::get_if<std::int64_t>(&value)) {
    csv += fmt::format(",{}", *count);
  } else {
    csv += std::get<bool>(value) ? ",1" : ",0";
  }
}

}  // namespace

std::vector<std::size_t> pareto_front(const std::vector<ParetoRow>& rows) {
  std::vector<std::size_t> order;
  for (std::size_t i = 0; i < rows.size(); ++i)
    if (std::isfinite(rows[i].error) && std::isfinite(rows[i].cost)) order.push_back(i);
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    return rows[a].cost != rows[b].cost ? rows[a].cost < rows[b].cost : rows[a].resolved() < rows[b].resolved();
  });
  std::vector<std::size_t> front;
  for (const std::size_t i : order)
    if (front.empty() || rows[i].resolved() < rows[front.back()].resolved()) front.push_back(i);
  return front;
}

std::vector<std::vector<std::size_t>> fronts(const ParetoTable& table, const std::vector<std::size_t>& rows) {
  std::vector<std::string> groups;
  std::vector<std::vector<std::size_t>> parts;
  for (const std::size_t i : rows) {
    const std::string group = table.front_by_group ? table.rows[i].group : "";
    const auto found = std::find(groups.begin(), groups.end(), group);
    if (found == groups.end()) {
      groups.push_back(group);
      parts.push_back({i});
    } else {
      parts[static_cast<std::size_t>(found - groups.begin())].push_back(i);
    }
  }
  for (std::vector<std::size_t>& part : parts) {
    std::vector<ParetoRow> own;
    for (const std::size_t i : part) own.push_back(table.rows[i]);
    std::vector<std::size_t> front;
    for (const std::size_t i : pareto_front(own)) front.push_back(part[i]);
    part = std::move(front);
  }
  return parts;
}

std::vector<std::vector<std::size_t>> fronts(const ParetoTable& table) {
  std::vector<std::size_t> all(table.rows.size());
  std::iota(all.begin(), all.end(), std::size_t{0});
  return fronts(table, all);
}

std::string to_csv(const ParetoTable& table) {
  std::vector<bool> best(table.rows.size());
  for (const auto& front : fronts(table))
    for (const std::size_t i : front) best[i] = true;
  std::string csv = "group,label";
  for (const std::string& name : table.more) csv += ',' + csv_text(name);
  csv += ',' + csv_text(table.error_name) + ',' + csv_text(table.cost_name) + ",on_front\n";
  for (std::size_t i = 0; i < table.rows.size(); ++i) {
    const ParetoRow& row = table.rows[i];
    csv += csv_text(row.group) + ',' + csv_text(row.label);
    for (const StudyValue& value : row.more) put_value(csv, value);
    if (std::isfinite(row.error))
      put(csv, row.error);
    else
      csv += ",failed";
    put(csv, row.cost);
    csv += best[i] ? ",1\n" : ",0\n";
  }
  return csv;
}

nlohmann::ordered_json to_json(const ParetoTable& table) {
  nlohmann::ordered_json json;
  json["study"] = table.study;
  json["title"] = table.title;
  json["cost"] = table.cost_axis;
  json["error"] = table.error_axis;
  for (const ParetoRow& row : table.rows) {
    nlohmann::ordered_json entry{{"group", row.group}, {"label", row.label}};
    for (std::size_t k = 0; k < table.more.size(); ++k)
      std::visit([&](const auto& value) { entry[table.more[k]] = value; }, row.more[k]);
    entry[table.error_name] = row.error;  // not finite: null
    entry[table.cost_name] = row.cost;
    json["rows"].push_back(std::move(entry));
  }
  for (const auto& front : fronts(table))
    for (const std::size_t i : front)
      json["front"].push_back({{"group", table.rows[i].group}, {"label", table.rows[i].label}});
  json["shows"] = table.sentences;
  return json;
}

std::string two_digits(double value) {
  if (!(std::abs(value) >= 99.5)) return fmt::format("{:.2g}", value);
  const double digit = std::pow(10.0, std::floor(std::log10(std::abs(value))) - 1);
  std::string digits = fmt::format("{:.0f}", std::round(value / digit) * digit);
  for (std::size_t at = digits.size(); at > (value < 0 ? 4 : 3);) digits.insert(at -= 3, ",");
  return digits;
}

Error interrupted(const char* verb) {
  return {verb, "was interrupted and wrote nothing", "run it again"};
}

Status write_text(OutputFolder& out, const std::string& name, const std::string& text) {
  const auto* bytes = reinterpret_cast<const std::uint8_t*>(text.data());
  return write_file(out.stage(name), std::span(bytes, text.size()));
}

Status write_json(OutputFolder& out, const std::string& name, const nlohmann::ordered_json& json) {
  return write_text(out, name, json.dump(2, ' ', true) + "\n");
}

Status write_study(OutputFolder& out, const ParetoTable& table) {
  return write_study(out, table, nlohmann::ordered_json::object());
}

Status write_study(OutputFolder& out, const ParetoTable& table, const nlohmann::ordered_json& further) {
  nlohmann::ordered_json json = to_json(table);
  json.erase("shows");
  json.update(further);
  json["shows"] = table.sentences;
  if (const Status done = write_text(out, table.study + ".csv", to_csv(table)); !done) return done;
  if (const Status done = write_json(out, table.study + ".json", json); !done) return done;
  if (const Status done = plot_pareto(out, table.study, table); !done) return done;
  print("{}: {}\n", table.study, table.title);
  print("front of {} rows: {:>32} {:>32}\n", table.rows.size(), table.error_axis, table.cost_axis);
  for (const auto& front : fronts(table))
    for (const std::size_t i : front) {
      const ParetoRow& row = table.rows[i];
      print("  {:<40} {:>12.3g} {:>12.3g}\n", row.group == row.label ? row.label : row.group + ' ' + row.label,
            row.error, row.cost);
    }
  for (const std::string& sentence : table.sentences) print("{}\n", sentence);
  return Done{};
}

}  // namespace pliant
