// The real window, driven as a person would: it opens, is typed in, clicked, dragged, and writes its
// pictures. Needs a display (Xvfb will do).
#include <QApplication>
#include <QCursor>
#include <QElapsedTimer>
#include <QFile>
#include <QLabel>
#include <QSettings>
#include <QSlider>
#include <QStandardPaths>
#include <QSurfaceFormat>
#include <QTemporaryDir>
#include <QTest>
#include <QTreeWidget>
#include <cmath>
#include <memory>

#include "../main_window.hpp"

using namespace loopwright;

namespace {

constexpr const char* rib = R"(;!vermiculation-1
;;Name: a rib
;;Gauge: 12
;;Bed-Gap: 2 mm
;;Yarn-A: wool 2/28 Nm            ; the usual one
;;Loop-Length: 5.9 mm
;;Size: 8 wales x 8 courses
;;Edges: held
; two wales, two courses
ge   ; first
ge   ; second
)";

// Where pictures for people go; empty: none are kept.
QString pictures_folder() { return qEnvironmentVariable("LOOPWRIGHT_VIEW_PICTURES"); }

// Share of pixels that differ by more than `by` in some channel.
[[maybe_unused]] double difference(const QImage& a, const QImage& b, int by) {
  if (a.size() != b.size()) return 1;
  std::size_t apart = 0;
  for (int y = 0; y < a.height(); ++y)
    for (int x = 0; x < a.width(); ++x) {
      const QRgb p = a.pixel(x, y), q = b.pixel(x, y);
      if (std::abs(qRed(p) - qRed(q)) > by || std::abs(qGreen(p) - qGreen(q)) > by ||
          std::abs(qBlue(p) - qBlue(q)) > by)
        ++apart;
    }
  return static_cast<double>(apart) / (static_cast<double>(a.width()) * a.height());
}

}  // namespace

class WindowTest : public QObject {
  Q_OBJECT

  std::unique_ptr<QTemporaryDir> folder_;
  std::unique_ptr<MainWindow> window_;

  QString file(const char* name, const char* text) const {
    const QString path = folder_->filePath(QLatin1String(name));
    QFile out(path);
    if (out.open(QIODevice::WriteOnly)) out.write(text);
    return path;
  }
  ClothStage stage() const { return window_->session().moment().stage; }
  bool at_rest() const {
    return !window_->session().working() && stage() == ClothStage::at_rest &&
           window_->cloth().scene_is_current();
  }
  void open_rib() {
    QVERIFY(window_->open(file("rib.verm", rib)));
    QTRY_VERIFY_WITH_TIMEOUT(at_rest(), 20000);
  }
  QString text() const { return QString::fromStdString(window_->session().document().text()); }
  void keep_picture(const char* name) {
    if (!pictures_folder().isEmpty())
      window_->grab().save(pictures_folder() + QLatin1Char('/') + QLatin1String(name));
  }

 private slots:
  void initTestCase() {
    QStandardPaths::setTestModeEnabled(true);
    QSettings::setDefaultFormat(QSettings::IniFormat);
  }

  void init() {
    folder_ = std::make_unique<QTemporaryDir>();
    QSettings::setPath(QSettings::IniFormat, QSettings::UserScope, folder_->path());
    window_ = std::make_unique<MainWindow>(folder_->filePath(QStringLiteral("autosave")));
    window_->resize(1280, 800);
    window_->show();
    QVERIFY(QTest::qWaitForWindowExposed(window_.get()));
  }

  void cleanup() {
    window_.reset();
    folder_.reset();
  }

  void opens_and_relaxes() {
    QElapsedTimer clock;
    clock.start();
    QVERIFY(window_->open(file("rib.verm", rib)));
    QVERIFY2(clock.elapsed() < 1000, "opening must not wait for the cloth");
    QTRY_VERIFY_WITH_TIMEOUT(at_rest(), 20000);
    QCOMPARE(window_->interlacings_text(), QStringLiteral("interlacings 4 of 4"));
    QVERIFY(window_->windowTitle().contains(QStringLiteral("rib.verm")));
    QTest::qWait(300);
    keep_picture("window.png");
  }
};

int main(int argc, char** argv) {
  QSurfaceFormat format;
  format.setVersion(3, 3);
  format.setProfile(QSurfaceFormat::CoreProfile);
  format.setDepthBufferSize(24);
  format.setSamples(4);
  QSurfaceFormat::setDefaultFormat(format);
  QApplication app(argc, argv);
  QCoreApplication::setOrganizationName(QStringLiteral("loopwright"));
  QCoreApplication::setApplicationName(QStringLiteral("loopwright-view-test"));
  WindowTest test;
  return QTest::qExec(&test, argc, argv);
}

#include "window_test.moc"
