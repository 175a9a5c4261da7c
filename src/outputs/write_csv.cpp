#include "outputs/write_csv.hpp"

#include <cmath>
#include <iostream>

#include "outputs/atomic_file.hpp"

namespace loopwright {
namespace {

std::string quoted(const std::string& text) {
  if (text.find_first_of(",\"\r\n") == std::string::npos) return text;
  std::string out = "\"";
  for (const char c : text) {
    if (c == '"') out += '"';
    out += c;
  }
  return out + '"';
}

void put(std::ostream& out, const Table& table) {
  for (std::size_t c = 0; c < table.columns.size(); ++c)
    out << (c > 0 ? "," : "") << quoted(table.columns[c]);
  out << '\n';
  for (const auto& row : table.rows) {
    for (std::size_t c = 0; c < row.size(); ++c)
      out << (c > 0 ? "," : "") << (std::isnan(row[c]) ? std::string() : number_text(row[c]));
    out << '\n';
  }
}

}  // namespace

void write_csv(const std::filesystem::path& path, const Table& table) {
  for (const auto& row : table.rows)
    if (row.size() != table.columns.size())
      throw std::invalid_argument("write_csv: a row is not as long as the header");
  if (path == "-") {
    put(std::cout, table);
    std::cout.flush();
    if (!std::cout) throw FileError("cannot write the table to standard output");
    return;
  }
  AtomicFile file(path);
  put(file.stream(), table);
  file.commit();
}

}  // namespace loopwright
