// Runs the tests of the window; without arguments all of them.
#include "window_test.hpp"

#include <QSurfaceFormat>

#include "window_programmes_test.hpp"

int main(int argc, char** argv) {
  QSurfaceFormat format;
  format.setVersion(3, 3);
  format.setProfile(QSurfaceFormat::CoreProfile);
  format.setDepthBufferSize(24);
  QSurfaceFormat::setDefaultFormat(format);
  QApplication app(argc, argv);
  QCoreApplication::setOrganizationName(QStringLiteral("loopwright"));
  QCoreApplication::setApplicationName(QStringLiteral("loopwright-view-test"));
  loopwright::WindowTest window;
  loopwright::ProgrammeTest programmes;
  int failed = 0;
  // a test that is named is of one of the two
  for (QObject* test : {static_cast<QObject*>(&window), static_cast<QObject*>(&programmes)}) {
    const QByteArray named = argc > 1 ? QByteArray(argv[1]) : QByteArray();
    const bool has =
        named.isEmpty() || named.startsWith('-') || test->metaObject()->indexOfSlot(named + "()") >= 0;
    if (has) failed += QTest::qExec(test, argc, argv);
  }
  return failed;
}
