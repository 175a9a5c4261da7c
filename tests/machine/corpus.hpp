// Real programmes that others wrote, read where they lie: LOOPWRIGHT_CORPUS, or the folder beside the
// project.
#pragma once
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

namespace loopwright {

inline std::filesystem::path corpus_folder() {
  const char* named = std::getenv("LOOPWRIGHT_CORPUS");
  return named ? named : LOOPWRIGHT_CORPUS_DEFAULT;
}

struct CorpusEntry {
  std::string file;       // relative to the corpus
  std::string tag;        // "INVALID: ..." for those that are wrong
  std::string converter;  // what an established converter says: "ok" or "reject: ..."
};

// The knitout files of the corpus: those of its MANIFEST.tsv, then the swatches of KnitDB, which it does not
// list (no tag, no converter). Empty where there is no corpus.
inline std::vector<CorpusEntry> corpus_knitout() {
  std::ifstream manifest(corpus_folder() / "MANIFEST.tsv");
  std::vector<CorpusEntry> entries;
  std::string line;
  while (std::getline(manifest, line)) {
    std::istringstream columns(line);
    std::vector<std::string> column;
    for (std::string text; std::getline(columns, text, '\t');) column.push_back(text);
    const std::string suffix = std::filesystem::path(column.empty() ? "" : column[0]).extension();
    if (column.size() >= 7 && (suffix == ".k" || suffix == ".knitout"))
      entries.push_back({column[0], column[1], column[6]});
  }
  const std::filesystem::path swatches = corpus_folder() / "knitdb";
  if (std::filesystem::exists(swatches))
    for (const auto& swatch : std::filesystem::directory_iterator(swatches))
      if (swatch.path().extension() == ".knitout")
        entries.push_back({"knitdb/" + swatch.path().filename().string(), "", ""});
  std::sort(entries.begin(), entries.end(),
            [](const CorpusEntry& a, const CorpusEntry& b) { return a.file < b.file; });
  return entries;
}

inline std::string corpus_text(const std::string& file) {
  std::ifstream in(corpus_folder() / file, std::ios::binary);
  std::ostringstream text;
  text << in.rdbuf();
  return text.str();
}

}  // namespace loopwright

#define SKIP_WITHOUT_CORPUS()                                     \
  if (!std::filesystem::exists(corpus_folder() / "MANIFEST.tsv")) \
  GTEST_SKIP() << "no corpus at " << corpus_folder() << ": set LOOPWRIGHT_CORPUS to where it lies"
