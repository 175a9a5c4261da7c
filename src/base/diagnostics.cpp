#include "base/diagnostics.hpp"

#include <algorithm>
#include <array>

namespace loopwright {

void Diagnostics::add(Diagnostic d) {
  int& count = d.severity == Severity::error     ? errors_
               : d.severity == Severity::warning ? warnings_
                                                 : advice_;
  if (count++ >= most_kept) return;
  const auto source = std::lower_bound(sources_.begin(), sources_.end(), d.at.line,
                                       [](const auto& mark, int line) { return mark.first < line; });
  if (d.at.line > 0 && source != sources_.end() && source->first == d.at.line)
    d.message += " [source: " + source->second + "]";
  list_.push_back(std::move(d));
}

std::string_view to_string(Severity severity) {
  constexpr std::array<std::string_view, 3> words{"warning", "error", "advice"};
  return words[static_cast<std::size_t>(severity)];
}

std::ostream& operator<<(std::ostream& out, const Diagnostics& diagnostics) {
  std::vector<Diagnostic> sorted = diagnostics.list();
  std::stable_sort(sorted.begin(), sorted.end(), [](const Diagnostic& a, const Diagnostic& b) {
    return std::pair(a.at.line, a.at.column) < std::pair(b.at.line, b.at.column);
  });
  for (const Diagnostic& d : sorted) {
    out << diagnostics.file() << ':';
    if (d.at.line > 0) out << d.at.line << ':';
    if (d.at.line > 0 && d.at.column > 0) out << d.at.column << ':';
    out << ' ' << to_string(d.severity) << ": " << d.message << '\n';
  }
  const int left_out =
      diagnostics.errors() + diagnostics.warnings() + diagnostics.advice() - static_cast<int>(sorted.size());
  if (left_out > 0) out << diagnostics.file() << ": " << left_out << " further diagnostics not shown\n";
  return out;
}

}  // namespace loopwright
