// Runs the tests of the window; without arguments all of them.
#include "window_test.hpp"

#include <QSurfaceFormat>

int main(int argc, char** argv) {
  QSurfaceFormat format;
  format.setVersion(3, 3);
  format.setProfile(QSurfaceFormat::CoreProfile);
  format.setDepthBufferSize(24);
  QSurfaceFormat::setDefaultFormat(format);
  QApplication app(argc, argv);
  QCoreApplication::setOrganizationName(QStringLiteral("loopwright"));
  QCoreApplication::setApplicationName(QStringLiteral("loopwright-view-test"));
  loopwright::WindowTest test;
  return QTest::qExec(&test, argc, argv);
}
