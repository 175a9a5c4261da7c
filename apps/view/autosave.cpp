#include "autosave.hpp"

#include <unistd.h>

#include <QCoreApplication>
#include <QDir>
#include <QFile>
#include <QFileInfo>
#include <csignal>

#include "outputs/atomic_file.hpp"

namespace loopwright {

Autosave::Autosave(const QString& folder)
    : folder_(folder), file_(folder + QStringLiteral("/unsaved-%1").arg(QCoreApplication::applicationPid())) {
  QDir().mkpath(folder_);
}

Autosave::~Autosave() { forget(); }

// The first line is the document's path, the rest its text.
void Autosave::keep(const Document& document) {
  if (!document.changed()) {
    forget();
    return;
  }
  try {
    AtomicFile file(file_.toStdString());
    file.stream() << document.path().string() << '\n' << document.text();
    file.commit();
  } catch (const FileError&) {
    // a full disk must not stop the typing; saving will say it
  }
}

void Autosave::forget() { QFile::remove(file_); }

std::optional<Autosave::Left> Autosave::left_behind() const {
  const QFileInfoList files =
      QDir(folder_).entryInfoList({QStringLiteral("unsaved-*")}, QDir::Files, QDir::Time);
  for (const QFileInfo& info : files) {
    const auto pid = static_cast<pid_t>(info.fileName().section(QLatin1Char('-'), 1).toLongLong());
    if (pid <= 0 || kill(pid, 0) == 0) continue;  // that program still runs
    QFile file(info.filePath());
    if (!file.open(QIODevice::ReadOnly)) continue;
    const QByteArray path = file.readLine().trimmed();
    return Left{info.filePath(), file.readAll().toStdString(), path.toStdString()};
  }
  return std::nullopt;
}

void Autosave::discard(const Left& left) { QFile::remove(left.file); }

}  // namespace loopwright
