// What all tests of the real window share: a folder, a window, and pictures for people. Needs a display (Xvfb
// will do).
#pragma once
#include <QApplication>
#include <QDoubleSpinBox>
#include <QElapsedTimer>
#include <QFile>
#include <QLabel>
#include <QLineEdit>
#include <QMouseEvent>
#include <QScreen>
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
#include "../plot_widget.hpp"
#include "outputs/render.hpp"

namespace loopwright {

inline constexpr const char* rib = R"(;!vermiculation-1
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
inline QString pictures_folder() { return qEnvironmentVariable("LOOPWRIGHT_VIEW_PICTURES"); }

// Share of pixels that differ by more than `by` in some channel.
inline double difference(const QImage& a, const QImage& b, int by) {
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

// Plain knitting to and fro with one carrier.
inline std::string plain_knitout(int needles, int courses) {
  std::string text = ";!knitout-2\n;;Carriers: 1\ninhook 1\n";
  for (int course = 0; course < courses; ++course)
    for (int k = 0; k < needles; ++k) {
      const bool left = course % 2 == 0;
      text += std::string(course == 0 ? "tuck " : "knit ") + (left ? "- f" : "+ f") +
              std::to_string(left ? needles - k : k + 1) + " 1\n";
      if (course == 1 && k + 1 == needles) text += "releasehook 1\n";
    }
  return text + "outhook 1\n";
}

// The longest time in which the window's thread did nothing for anybody, in ms.
class Heartbeat : public QObject {
 public:
  Heartbeat() {
    startTimer(1, Qt::PreciseTimer);
    last_.start();
  }
  qint64 longest() const { return longest_; }

 protected:
  void timerEvent(QTimerEvent*) override { longest_ = std::max(longest_, last_.restart()); }

 private:
  QElapsedTimer last_;
  qint64 longest_ = 0;
};

// Opens a window before every test and closes it after.
class WindowFixture : public QObject {
  Q_OBJECT

 protected:
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
  // Pictures of the whole window, those of large screens at a size that a page can hold.
  void keep_picture(const char* name) {
    if (pictures_folder().isEmpty()) return;
    QImage picture = window_->screen()->grabWindow(window_->winId()).toImage();
    if (picture.width() > 1600) picture = picture.scaledToWidth(1600, Qt::SmoothTransformation);
    picture.save(pictures_folder() + QLatin1Char('/') + QLatin1String(name));
  }

  // Frames a second while the right button turns the cloth.
  double turning_rate(int milliseconds) {
    ClothView& cloth = window_->cloth();
    QTest::mousePress(&cloth, Qt::RightButton, {}, {200, 200});
    const int drawn = cloth.frames_drawn();
    QElapsedTimer clock;
    clock.start();
    for (int i = 0; clock.elapsed() < milliseconds; ++i) {
      // Qt Test's moves carry no button, the window's own do
      const QPointF at(200 + 4 * (i % 60), 200);
      QMouseEvent move(QEvent::MouseMove, at, at, Qt::NoButton, Qt::RightButton, Qt::NoModifier);
      QApplication::sendEvent(&cloth, &move);
      QCoreApplication::processEvents();
    }
    const double seconds = static_cast<double>(clock.elapsed()) * 1e-3;
    const int frames = cloth.frames_drawn() - drawn;
    QTest::mouseRelease(&cloth, Qt::RightButton, {}, {200, 200});
    return frames / seconds;
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
    connect(&window_->session(), &Session::refused, this,
            [](const QString& why) { qInfo("refused: %s", qPrintable(why)); });
    // without a window manager nobody else makes it the one that gets the keys
    QApplication::setActiveWindow(window_.get());
  }

  void cleanup() {
    window_.reset();
    folder_.reset();
  }
};

}  // namespace loopwright
