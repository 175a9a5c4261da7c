// loopwright-view: the desktop application.
#include <QApplication>
#include <QCommandLineParser>
#include <QSettings>
#include <QStandardPaths>
#include <QSurfaceFormat>
#include <QTimer>

#include "main_window.hpp"

int main(int argc, char** argv) {
  QCoreApplication::setApplicationName(QStringLiteral("loopwright-view"));
  QCoreApplication::setOrganizationName(QStringLiteral("loopwright"));
  QCoreApplication::setApplicationVersion(QStringLiteral(LOOPWRIGHT_VERSION));
  QSurfaceFormat format;
  format.setVersion(3, 3);
  format.setProfile(QSurfaceFormat::CoreProfile);
  format.setDepthBufferSize(24);
  QSurfaceFormat::setDefaultFormat(format);
  QApplication app(argc, argv);
  app.setApplicationDisplayName(QStringLiteral("Loopwright"));
  app.setDesktopFileName(QStringLiteral("loopwright-view"));

  QCommandLineParser parser;
  parser.setApplicationDescription(QStringLiteral("Knitting notations and their cloth, in a window"));
  parser.addHelpOption();
  parser.addVersionOption();
  parser.addPositionalArgument(QStringLiteral("file"), QStringLiteral("Fabric file (.verm) or knitout (.k)"));
  parser.process(app);
  const QStringList files = parser.positionalArguments();

  loopwright::MainWindow window(QStandardPaths::writableLocation(QStandardPaths::AppDataLocation));
  window.show();
  if (!files.isEmpty()) window.open(files.front());
  // after the window is there, so that the start is not held up
  QTimer::singleShot(0, &window, [&window, named = !files.isEmpty()] {
    if (named) return;
    window.offer_recovery();
    QSettings settings;
    if (settings.value(QStringLiteral("toured")).toBool()) return;
    settings.setValue(QStringLiteral("toured"), true);
    window.start_tour();
  });
  return QApplication::exec();
}
