// What a stage has to say about its input: errors, warnings and advice with the place that they are about.
// A wrong programme is a normal input, so stages collect diagnostics and return what can still be built.
#pragma once
#include <ostream>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace loopwright {

struct SourceLocation {
  int line = 0;    // 1-based; 0: the file as a whole
  int column = 0;  // 1-based, in bytes; 0: the line as a whole
  friend bool operator==(const SourceLocation&, const SourceLocation&) = default;
};

// advice: right as it stands, but a knitter would look twice; it never changes an exit status.
enum class Severity { warning, error, advice };

std::string_view to_string(Severity severity);  // "error", "warning", "advice"

struct Diagnostic {
  Severity severity = Severity::error;
  SourceLocation at;
  std::string message;  // says what is wrong and what to do about it
};

class Diagnostics {
 public:
  explicit Diagnostics(std::string file = {}) : file_(std::move(file)) {}

  void error(SourceLocation at, std::string message) { add({Severity::error, at, std::move(message)}); }
  void warning(SourceLocation at, std::string message) { add({Severity::warning, at, std::move(message)}); }
  void advise(SourceLocation at, std::string message) { add({Severity::advice, at, std::move(message)}); }
  void add(Diagnostic d);
  // What a line of the file was made from (knitout's `;!source:`): repeated, as it stands, after every
  // message about that line. Lines must come in rising order.
  void source_of(int line, std::string_view text) { sources_.emplace_back(line, text); }

  bool ok() const { return errors_ == 0; }
  int errors() const { return errors_; }
  int warnings() const { return warnings_; }
  int advice() const { return advice_; }
  const std::string& file() const { return file_; }
  // Kept diagnostics; past `most_kept` of one severity the rest are counted, not kept.
  const std::vector<Diagnostic>& list() const { return list_; }
  static constexpr int most_kept = 1000;

 private:
  std::string file_;
  std::vector<Diagnostic> list_;
  std::vector<std::pair<int, std::string>> sources_;  // by line
  int errors_ = 0, warnings_ = 0, advice_ = 0;
};

// Writes `FILE:LINE:COL: error: text` lines in the order of the file's lines, and a count of what was not
// kept.
std::ostream& operator<<(std::ostream& out, const Diagnostics& diagnostics);

}  // namespace loopwright
