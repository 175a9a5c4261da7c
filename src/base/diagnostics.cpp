#include "base/diagnostics.hpp"

#include <algorithm>

namespace loopwright {

void Diagnostics::add(Diagnostic d) {
  int& count = d.severity == Severity::error ? errors_ : warnings_;
  if (count++ < most_kept) list_.push_back(std::move(d));
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
    out << (d.severity == Severity::error ? " error: " : " warning: ") << d.message << '\n';
  }
  const int left_out = diagnostics.errors() + diagnostics.warnings() - static_cast<int>(sorted.size());
  if (left_out > 0) out << diagnostics.file() << ": " << left_out << " further diagnostics not shown\n";
  return out;
}

}  // namespace loopwright
