// Colours for the two notations as they are typed.
#pragma once
#include <QSyntaxHighlighter>

#include "document.hpp"

namespace loopwright {

class NotationHighlighter : public QSyntaxHighlighter {
 public:
  explicit NotationHighlighter(QTextDocument* document);
  void set_kind(DocumentKind kind);
  void set_dark(bool dark);

 protected:
  void highlightBlock(const QString& text) override;

 private:
  void colour_letters(const QString& text, qsizetype end);
  void colour_operation(const QString& text, qsizetype end);

  DocumentKind kind_ = DocumentKind::fabric;
  bool dark_ = false;
};

}  // namespace loopwright
