#include "notation_highlighter.hpp"

#include <QTextCharFormat>

namespace loopwright {
namespace {

enum class Ink { front, rear, move, quiet, header, comment, feeder };

// Front work green and rear work blue, as the structure picture draws front and rear loops.
QTextCharFormat ink(Ink what, bool dark) {
  QTextCharFormat format;
  const auto colour = [&](const char* light_theme, const char* dark_theme) {
    format.setForeground(QColor(dark ? dark_theme : light_theme));
  };
  switch (what) {
    case Ink::front:
      colour("#1d7a3e", "#7ad190");
      format.setFontWeight(QFont::DemiBold);
      break;
    case Ink::rear:
      colour("#2a55c0", "#8fb3ff");
      format.setFontWeight(QFont::DemiBold);
      break;
    case Ink::move:
      colour("#a04a00", "#ffb066");
      format.setFontWeight(QFont::DemiBold);
      break;
    case Ink::quiet:
      colour("#8a8a8a", "#909090");
      break;
    case Ink::header:
      colour("#6a3d8a", "#cba6f0");
      break;
    case Ink::comment:
      colour("#7a7f87", "#9aa2ad");
      format.setFontItalic(true);
      break;
    case Ink::feeder:
      colour("#8a5a00", "#e6c070");
      break;
  }
  return format;
}

}  // namespace

NotationHighlighter::NotationHighlighter(QTextDocument* document) : QSyntaxHighlighter(document) {}

void NotationHighlighter::set_kind(DocumentKind kind) {
  if (kind == kind_) return;
  kind_ = kind;
  rehighlight();
}

void NotationHighlighter::set_dark(bool dark) {
  if (dark == dark_) return;
  dark_ = dark;
  rehighlight();
}

void NotationHighlighter::highlightBlock(const QString& text) {
  if (text.startsWith(QLatin1String(";!")) || text.startsWith(QLatin1String(";;"))) {
    const qsizetype colon = text.indexOf(QLatin1Char(':'));
    setFormat(0, static_cast<int>(colon < 0 ? text.size() : colon + 1), ink(Ink::header, dark_));
    const qsizetype note = text.indexOf(QLatin1Char(';'), 2);
    if (note > 0)
      setFormat(static_cast<int>(note), static_cast<int>(text.size() - note), ink(Ink::comment, dark_));
    return;
  }
  const qsizetype note = text.indexOf(QLatin1Char(';'));
  const qsizetype end = note < 0 ? text.size() : note;
  if (note >= 0)
    setFormat(static_cast<int>(note), static_cast<int>(text.size() - note), ink(Ink::comment, dark_));
  if (kind_ == DocumentKind::fabric)
    colour_letters(text, end);
  else
    colour_operation(text, end);
}

void NotationHighlighter::colour_letters(const QString& text, qsizetype end) {
  // feeders stand before a colon, or before the arrow of a direction
  qsizetype from = 0;
  for (qsizetype i = 0; i < end; ++i) {
    const QChar c = text[i];
    if (c == QLatin1Char('&')) from = i + 1;
    if (c == QLatin1Char(':') || c == QLatin1Char('>') || c == QLatin1Char('<')) {
      setFormat(static_cast<int>(from), static_cast<int>(i + 1 - from), ink(Ink::feeder, dark_));
      from = i + 1;
    }
  }
  for (qsizetype i = 0; i < end; ++i) {
    if (format(static_cast<int>(i)).foreground().style() != Qt::NoBrush) continue;  // a feeder's name
    const char c = text[i].toLatin1();
    const auto paint = [&](Ink what) { setFormat(static_cast<int>(i), 1, ink(what, dark_)); };
    if (c == 'g' || c == 'v' || c == 's') paint(Ink::front);
    if (c == 'e' || c == 'n' || c == 'S') paint(Ink::rear);
    if (c == 't' || c == 'T' || c == 'd' || c == 'D' || c == 'R' || c == 'r') paint(Ink::move);
    if (c == '.' || c == '-' || c == '/' || c == '&') paint(Ink::quiet);
  }
}

void NotationHighlighter::colour_operation(const QString& text, qsizetype end) {
  const QString word = text.left(end).trimmed().section(QLatin1Char(' '), 0, 0);
  if (word.isEmpty()) return;
  const auto from = static_cast<int>(text.indexOf(word));
  const bool stitch =
      word == QLatin1String("knit") || word == QLatin1String("tuck") || word == QLatin1String("split");
  const bool moves =
      word == QLatin1String("xfer") || word == QLatin1String("rack") || word == QLatin1String("drop");
  setFormat(from, static_cast<int>(word.size()),
            ink(stitch  ? Ink::front
                : moves ? Ink::move
                        : Ink::feeder,
                dark_));
}

}  // namespace loopwright
