// The document's history and the changes of header lines.
#include <gmock/gmock.h>

#include <filesystem>
#include <fstream>

#include "../document.hpp"
#include "../header_edits.hpp"
#include "../latest_only.hpp"
#include "outputs/atomic_file.hpp"

namespace loopwright {
namespace {

TEST(Document, UndoesAndRedoesChangesOfAllEditorsInOneOrder) {
  Document document;
  document.open_text(";!vermiculation-1\ng\n", ".verm");
  const std::string first = document.text();
  document.change_to(";!vermiculation-1\nge\n", "Typing", true);
  document.change_to(";!vermiculation-1\ngeg\n", "Typing", true);
  document.change_to(";!vermiculation-1\ngee\n", "Needle: stitch");
  EXPECT_EQ(document.undo_name(), "Needle: stitch");
  document.undo();
  EXPECT_EQ(document.text(), ";!vermiculation-1\ngeg\n");
  document.undo();  // both typed letters at once
  EXPECT_EQ(document.text(), first);
  EXPECT_FALSE(document.can_undo());
  EXPECT_FALSE(document.changed());
  document.redo();
  document.redo();
  EXPECT_EQ(document.text(), ";!vermiculation-1\ngee\n");
  EXPECT_FALSE(document.can_redo());
}

TEST(Document, TellsTheSmallestChangeAndNeverPartsACharacter) {
  Document document;
  document.open_text("; \u00e4\ng\n", ".verm");
  Document::Change seen;
  document.on_change = [&seen](const Document::Change& change) { seen = change; };
  document.change_to("; \u00f6\ng\n", "Typing");  // the second byte alone differs
  EXPECT_EQ(seen.begin, 2U);
  EXPECT_EQ(seen.removed, 2U);
  EXPECT_EQ(seen.inserted, 2U);
  document.undo();
  EXPECT_EQ(document.text(), "; \u00e4\ng\n");
}

TEST(Document, KnowsWhetherItIsSaved) {
  const auto path = std::filesystem::temp_directory_path() / "loopwright_document_test.verm";
  Document document;
  document.change_to(document.text() + "e\n", "Typing", true);
  EXPECT_TRUE(document.changed());
  document.save(path);
  EXPECT_FALSE(document.changed());
  document.undo();
  EXPECT_TRUE(document.changed());
  document.change_to(document.text() + "g\n", "Typing", true);  // what was saved is out of reach
  document.undo();
  EXPECT_TRUE(document.changed());
  Document again;
  again.open(path);
  EXPECT_THAT(again.text(), testing::EndsWith("g\ne\n"));
  EXPECT_FALSE(again.changed());
  std::filesystem::remove(path);
  EXPECT_THROW(again.open(path), FileError);
  EXPECT_THAT(again.text(), testing::EndsWith("g\ne\n")) << "nothing is lost by a failed open";
}

TEST(Document, ShowsKnitoutWithoutEditingIt) {
  Document document;
  document.open_text(";!knitout-2\n;;Carriers: A\nin A\n", ".k");
  EXPECT_EQ(document.kind(), DocumentKind::knitout);
  document.change_to("knit + f0 A\n", "Typing");
  EXPECT_THAT(document.text(), testing::StartsWith(";!knitout-2"));
}

TEST(Headers, ChangeOneLineAndKeepItsComment) {
  const std::string text = ";!vermiculation-1\n;;Gauge: 12   ; needles per inch\n; note\n;;Set: 0\ng\n";
  EXPECT_EQ(header_value(text, "gauge"), "12");
  EXPECT_EQ(with_header(text, "Gauge", "7"),
            ";!vermiculation-1\n;;Gauge: 7   ; needles per inch\n; note\n;;Set: 0\ng\n");
  EXPECT_EQ(with_header(text, "Name", "x"),
            ";!vermiculation-1\n;;Gauge: 12   ; needles per inch\n; note\n;;Set: 0\n;;Name: x\ng\n");
  EXPECT_EQ(with_header(text, "Set", ""), ";!vermiculation-1\n;;Gauge: 12   ; needles per inch\n; note\ng\n");
  EXPECT_EQ(with_header("g", "Set", "1"), ";;Set: 1\ng");
}

TEST(LatestOnly, RunsTheLatestAndTellsTheOthersToStop) {
  LatestOnly worker;
  std::atomic<int> begun = 0, last = 0;
  for (int k = 1; k <= 50; ++k)
    worker.start([&, k](const std::atomic<bool>& cancelled) {
      ++begun;
      last = k;
      // the last one ends by itself, all before it only when told
      while (!cancelled && k < 50) std::this_thread::yield();
    });
  worker.wait();
  EXPECT_EQ(last, 50);
  EXPECT_LE(begun, 50);
  EXPECT_FALSE(worker.busy());
}

}  // namespace
}  // namespace loopwright
