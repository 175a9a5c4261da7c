// Programmes and files of cloth in the real window: knitout with its passes, saved states, curves, cloth that
// is broken, and whether the window answers while others work.
#pragma once
#include <QComboBox>
#include <QDropEvent>
#include <QMenuBar>
#include <QMimeData>
#include <QScrollBar>
#include <QTextBlock>
#include <QWizard>

#include "../cloth_file_job.hpp"
#include "outputs/atomic_file.hpp"
#include "outputs/write_fabric.hpp"
#include "window_fixture.hpp"

namespace loopwright {

class ProgrammeTest : public WindowFixture {
  Q_OBJECT

  void open_swatch() {
    QVERIFY(window_->open(QStringLiteral(LOOPWRIGHT_SOURCE_DIR "/examples/swatch.k")));
    QTRY_VERIFY_WITH_TIMEOUT(window_->session().fabric() != nullptr, 30000);
    window_->session().cancel();
    QTRY_VERIFY_WITH_TIMEOUT(!window_->session().working(), 30000);
    QTRY_VERIFY(window_->cloth().scene_is_current());
  }
  QString saved_rib() {
    open_rib();
    const QString state = folder_->filePath(QStringLiteral("rib.h5"));
    window_->export_to(state);
    return state;
  }
  int visible_lines() const {
    int visible = 0;
    for (QTextBlock block = window_->editor().document()->begin(); block.isValid(); block = block.next())
      visible += block.isVisible() ? 1 : 0;
    return visible;
  }

 private slots:
  void knitout_is_shown_and_not_edited() {
    QVERIFY(window_->open(QStringLiteral(LOOPWRIGHT_SOURCE_DIR "/examples/swatch.k")));
    QTRY_VERIFY_WITH_TIMEOUT(window_->session().fabric() != nullptr, 30000);
    QVERIFY(window_->editor().isReadOnly());
    QVERIFY(window_->session().passes() > 10);
    // the third needle of the second pass
    auto* slider = window_->findChild<QSlider*>(QStringLiteral("acts"));
    DiagramView& paper = window_->diagram();
    QCOMPARE(slider->maximum(), paper.acts());
    QVERIFY(paper.acts() > 20);
    for (int k = 1; k <= 20; ++k) {
      slider->setValue(k);
      QCOMPARE(window_->editor().textCursor().blockNumber() + 1, paper.act_place(k - 1).line);
      QVERIFY2(k == 1 || paper.act_place(k - 1).line > paper.act_place(k - 2).line,
               "in the order of the file");
    }
    const std::string before = window_->session().document().text();
    DiagramView& diagram = window_->diagram();
    diagram.set_tool(DiagramTool::tuck);
    QTest::mouseClick(diagram.viewport(), Qt::LeftButton, {}, diagram.needle_place(0, false, 0).toPoint());
    QCOMPARE(window_->session().document().text(), before);
    window_->session().cancel();
  }

  void passes_fold_and_open_where_one_goes() {
    open_swatch();
    NotationEditor& editor = window_->editor();
    const std::vector<Fold>& folds = window_->session().knitout()->folds();
    QVERIFY(folds.size() > 3 && editor.folds() == folds.size());
    int hidden = 0;
    for (const Fold& fold : folds) hidden += fold.last_line - fold.first_line;
    editor.fold_all(true);
    QCOMPARE(visible_lines(), editor.document()->blockCount() - hidden);
    // the slider stays at the first line of a folded pass
    auto* slider = window_->findChild<QSlider*>(QStringLiteral("acts"));
    slider->setValue(slider->maximum() / 2);
    const int at = editor.textCursor().blockNumber() + 1;
    QVERIFY(
        std::any_of(folds.begin(), folds.end(), [at](const Fold& fold) { return fold.first_line == at; }));
    QVERIFY(editor.folded(0));
    QTest::qWait(pictures_folder().isEmpty() ? 0 : 500);
    keep_picture("folded.png");
    // a message or a search opens it
    editor.go_to({folds[1].last_line, 0});
    QVERIFY(!editor.folded(1));
    QCOMPARE(editor.textCursor().blockNumber() + 1, folds[1].last_line);
    // the mark in the margin, and the key
    editor.go_to({folds[0].first_line, 0});
    const double y = editor.cursorRect().center().y();
    editor.toggle_fold_at(y);
    QVERIFY(!editor.folded(0));
    QTest::keyClick(window_.get(), Qt::Key_Period, Qt::ControlModifier);
    QVERIFY(editor.folded(0));
    QVERIFY(editor.find_next(QStringLiteral("outhook"), false));
    editor.fold_all(false);
    QCOMPARE(visible_lines(), editor.document()->blockCount());
  }

  void the_slider_knits_the_cloth() {
    open_swatch();
    ClothView& cloth = window_->cloth();
    cloth.set_floor(false);
    const QSize size(320, 240);
    QImage empty(size, QImage::Format_RGB32);
    empty.fill(QColor(246, 245, 242));
    auto* slider = window_->findChild<QSlider*>(QStringLiteral("acts"));
    const QImage whole = cloth.picture(size);
    double before = difference(whole, empty, 30);
    for (const int share : {3, 2, 1}) {
      slider->setValue(slider->maximum() * share / 4);
      const double now = difference(cloth.picture(size), empty, 30);
      QVERIFY2(now < 0.95 * before && now > 0.001, qPrintable(QStringLiteral("%1 %2").arg(now).arg(before)));
      before = now;
      QTest::qWait(100);
      if (share == 2) keep_picture("scrubbed.png");
    }
    slider->setValue(0);
    QVERIFY(difference(cloth.picture(size), empty, 30) < 1e-4);
    slider->setValue(slider->maximum());
    QVERIFY(difference(cloth.picture(size), whole, 8) < 1e-4);
  }

  void a_long_programme_is_drawn_where_one_looks() {
    constexpr int needles = 3, courses = 6000;
    const std::string text = plain_knitout(needles, courses);
    Heartbeat heart;
    QVERIFY(window_->open(file("long.k", text.c_str())));
    QTRY_VERIFY_WITH_TIMEOUT(window_->session().knitout() != nullptr, 60000);
    QCOMPARE(window_->session().passes(), static_cast<std::size_t>(courses));
    DiagramView& paper = window_->diagram();
    QCOMPARE(paper.acts(), needles * courses);
    QElapsedTimer clock;
    clock.start();
    paper.verticalScrollBar()->setValue(0);  // the last pass is at the top
    paper.grab();
    QVERIFY2(clock.elapsed() < 1000, qPrintable(QString::number(clock.elapsed())));
    const QPointF last = paper.needle_place(courses - 1, false, 0);
    QVERIFY(last.y() > 0 && last.y() < paper.viewport()->height());
    keep_picture("long.png");
    // its first geometry, or whatever works now, ends soon
    window_->session().cancel();
    clock.restart();
    QTRY_VERIFY_WITH_TIMEOUT(!window_->session().working(), 20000);
    const qint64 until_stopped = clock.elapsed();
    window_->editor().fold_all(true);
    window_->editor().fold_all(false);
    QTest::qWait(50);
    qInfo("18000 stitches: stopped after %lld ms, longest wait of the window %lld ms", until_stopped,
          heart.longest());
    QVERIFY(until_stopped < 3000);
    QVERIFY(heart.longest() < 3000);
  }

  void a_state_opens_with_its_notation_and_goes_on() {
    const QString state = saved_rib();
    const qint64 bytes = QFile(state).size();
    QVERIFY(window_->open(state));
    QTRY_VERIFY_WITH_TIMEOUT(at_rest(), 20000);
    QCOMPARE(window_->interlacings_text(), QStringLiteral("interlacings 4 of 4"));
    QVERIFY(window_->editor().isReadOnly());
    QCOMPARE(text(), QString::fromUtf8(rib));
    QCOMPARE(window_->editor().toPlainText(), QString::fromUtf8(rib));
    QVERIFY(window_->session().moment().iterations <= 30);
    QVERIFY(!window_->session().diagram().passes.empty());
    // it can be pulled at once
    auto* slider = window_->findChild<QSlider*>(QStringLiteral("stretch"));
    QVERIFY(slider->isEnabled());
    slider->setValue(2);
    QTRY_VERIFY_WITH_TIMEOUT(!window_->session().working() && window_->session().stretch_points().size() > 1,
                             20000);
    QVERIFY(window_->session().stretch_points().back().course_force > 0);
    QTest::qWait(300);
    keep_picture("state.png");
    // saving would put text where cloth was
    QVERIFY_EXCEPTION_THROWN(window_->session().document().save(state.toStdString()), FileError);
    QCOMPARE(QFile(state).size(), bytes);
    auto* fresh = window_->findChild<QAction*>(QStringLiteral("new from state"));
    QVERIFY(fresh->isEnabled());
    fresh->trigger();
    QVERIFY(!window_->editor().isReadOnly());
    QTRY_VERIFY_WITH_TIMEOUT(at_rest(), 20000);
  }

  void curves_of_other_programs_open() {
    open_rib();
    for (const char* name : {"a.bcc", "a.yarns", "a.obj"}) {
      const QString curves = folder_->filePath(QLatin1String(name));
      window_->export_to(curves);
      QVERIFY(QFile::exists(curves));
    }
    for (const char* name : {"a.bcc", "a.yarns", "a.obj"}) {
      QVERIFY(window_->open(folder_->filePath(QLatin1String(name))));
      QTRY_VERIFY_WITH_TIMEOUT(stage() == ClothStage::as_saved && window_->cloth().scene_is_current(), 20000);
      QVERIFY(!window_->session().working());
      QVERIFY(!window_->session().fabric()->yarns.empty());
      QCOMPARE(window_->interlacings_text(), QStringLiteral("no interlacings known"));
      QVERIFY(text().contains(QStringLiteral("curves of another program")));
    }
    QTest::qWait(300);
    keep_picture("curves.png");
    // an unreadable one says why, and nothing of another file is shown
    QVERIFY(window_->open(file("bad.h5", "no state")));
    QTRY_COMPARE_WITH_TIMEOUT(stage(), ClothStage::unusable, 20000);
    QVERIFY(!window_->session().fabric());
    QCOMPARE(window_->findChild<QTreeWidget*>(QStringLiteral("messages"))->topLevelItemCount(), 1);
  }

  void broken_cloth_is_red_everywhere() {
    State state = read_state(saved_rib().toStdString());
    // a loop pushed through the one that holds it
    for (Vec3& p : state.fabric.yarns[0].control_points) p.z = -p.z;
    state.numbers["converged"] = 0;
    const QString broken = folder_->filePath(QStringLiteral("broken.h5"));
    write_fabric(broken.toStdString(), state);
    QVERIFY(window_->open(broken));
    QTRY_VERIFY_WITH_TIMEOUT(window_->session().fabric() && window_->cloth().scene_is_current(), 20000);
    window_->session().cancel();
    QTRY_VERIFY_WITH_TIMEOUT(!window_->session().working(), 20000);
    QVERIFY(window_->session().broken());
    QTest::qWait(300);
    const QColor banner = window_->cloth().grabFramebuffer().pixelColor(4, 4);
    QVERIFY2(banner.red() > 150 && banner.green() < 80, qPrintable(banner.name()));
    keep_picture("broken.png");
    bool said = false;
    for (const QLabel* label : window_->findChildren<QLabel*>())
      said = said || label->text() == QStringLiteral("Nothing is measured: the cloth is broken.");
    QVERIFY(said);
    QVERIFY_EXCEPTION_THROWN(window_->export_to(folder_->filePath(QStringLiteral("b.obj"))),
                             std::invalid_argument);
  }

  void a_yarns_data_change_goes_on_from_the_cloth_at_hand() {
    open_rib();
    const double width = window_->session().fabric()->width;
    QVERIFY(!window_->session().moment().went_on);
    window_->findChild<QDoubleSpinBox*>(QStringLiteral("Friction A"))->setValue(0.35);
    QTRY_VERIFY_WITH_TIMEOUT(at_rest() && window_->session().moment().went_on, 20000);
    QCOMPARE(window_->interlacings_text(), QStringLiteral("interlacings 4 of 4"));
    QVERIFY(std::abs(window_->session().fabric()->width / width - 1) < 0.02);
    // other loops begin anew
    window_->editor().go_to({10, 1});
    QTest::keyClicks(&window_->editor(), QStringLiteral("g"));
    QTRY_VERIFY_WITH_TIMEOUT(at_rest() && window_->session().fabric()->loops.size() > 4, 30000);
    QVERIFY(!window_->session().moment().went_on);
  }

  void shear_by_slider_and_by_the_upper_edge() {
    open_rib();
    auto* ways = window_->findChild<QComboBox*>(QStringLiteral("stretch direction"));
    ways->setCurrentIndex(3);
    window_->findChild<QSlider*>(QStringLiteral("stretch"))->setValue(6);
    QTRY_VERIFY_WITH_TIMEOUT(!window_->session().working() && window_->session().stretch_points().size() > 3,
                             30000);
    const StretchPoint last = window_->session().stretch_points().back();
    QVERIFY(std::abs(last.shear - 0.06) < 1e-9);
    QVERIFY(last.shear_force > 0);
    QCOMPARE(last.interlacings_intact, last.interlacings);
    QTest::qWait(300);
    keep_picture("shear.png");
    window_->session().forget_stretch();
    ClothView& cloth = window_->cloth();
    QTRY_VERIFY(cloth.scene_is_current());
    cloth.fit();
    Bounds box = fabric_bounds(*window_->session().fabric(), {4, 4});
    const QPoint from = cloth.on_screen({box.centre().x, box.upper.y, 0}).toPoint();
    QTest::mousePress(&cloth, Qt::LeftButton, {}, from);
    QTest::mouseMove(&cloth, from + QPoint(8, 0));
    QTest::mouseMove(&cloth, from + QPoint(14, 1));
    QTest::mouseRelease(&cloth, Qt::LeftButton, {}, from + QPoint(14, 1));
    QTRY_VERIFY_WITH_TIMEOUT(!window_->session().working() && !window_->session().stretch_points().empty(),
                             30000);
    QVERIFY(window_->session().stretch_points().back().shear > 0.005);
    QCOMPARE(ways->currentIndex(), 3);
  }

  void a_dropped_file_opens_and_is_remembered() {
    QMimeData files;
    files.setUrls({QUrl::fromLocalFile(file("dropped.verm", rib))});
    QDragEnterEvent enter({40, 40}, Qt::CopyAction, &files, Qt::LeftButton, Qt::NoModifier);
    QApplication::sendEvent(window_.get(), &enter);
    QVERIFY(enter.isAccepted());
    QDropEvent drop({40, 40}, Qt::CopyAction, &files, Qt::LeftButton, Qt::NoModifier);
    QApplication::sendEvent(window_.get(), &drop);
    QVERIFY(window_->windowTitle().contains(QStringLiteral("dropped.verm")));
    QVERIFY(QSettings()
                .value(QStringLiteral("recent"))
                .toStringList()
                .front()
                .endsWith(QStringLiteral("dropped.verm")));
    QMenu* recent = nullptr;
    for (QMenu* menu : window_->findChildren<QMenu*>())
      if (menu->title() == QStringLiteral("&Recent")) recent = menu;
    QVERIFY(recent);
    emit recent->aboutToShow();
    QVERIFY(recent->actions().front()->text().endsWith(QStringLiteral("dropped.verm")));
  }

  void the_tour_has_five_steps_beside_the_work() {
    window_->start_tour();
    auto* tour = window_->findChild<QWizard*>();
    QVERIFY(tour && tour->isVisible() && !tour->isModal());
    QCOMPARE(tour->pageIds().size(), 5);
    QTest::qWait(300);
    if (!pictures_folder().isEmpty())
      window_->screen()->grabWindow(0, 0, 0, 1280, 800).save(pictures_folder() + QStringLiteral("/tour.png"));
    // it stays while the first step is tried
    window_->editor().go_to({8, 2});
    QTest::keyClicks(&window_->editor(), QStringLiteral("e"));
    QVERIFY(text().contains(QStringLiteral("\nge\n")));
    QVERIFY(tour->isVisible());
    for (int step = 1; step < 5; ++step) tour->next();
    tour->accept();
  }

  void a_message_leads_to_its_line() {
    open_rib();
    window_->editor().go_to({11, 3});
    QTest::keyClicks(&window_->editor(), QStringLiteral("q"));
    window_->editor().go_to({1, 1});
    auto* messages = window_->findChild<QTreeWidget*>(QStringLiteral("messages"));
    QTRY_COMPARE(messages->topLevelItemCount(), 1);
    emit messages->itemClicked(messages->topLevelItem(0), 0);
    QCOMPARE(window_->editor().textCursor().blockNumber() + 1, 11);
  }

  void ten_thousand_loops_turn() {
    if (!qEnvironmentVariableIsSet("LOOPWRIGHT_VIEW_FIGURES"))
      QSKIP("set LOOPWRIGHT_VIEW_FIGURES to measure");
    window_->session().choose_piece(PieceChoice::whole);
    QVERIFY(
        window_->open(file("large.verm",
                           ";!vermiculation-1\n;;Gauge: 12\n;;Bed-Gap: 2 mm\n;;Yarn-A: wool 2/28 Nm\n"
                           ";;Loop-Length: 5.9 mm\n;;Size: 100 wales x 100 courses\n;;Edges: held\nge\n")));
    Heartbeat heart;
    QElapsedTimer clock;
    clock.start();
    ClothView& cloth = window_->cloth();
    QTRY_VERIFY_WITH_TIMEOUT(!window_->session().working() && cloth.scene_is_current(), 60000);
    QCOMPARE(window_->session().fabric()->loops.size(), std::size_t{10000});
    const qint64 ready = clock.elapsed();
    QTest::qWait(4000);  // the coarse picture for movement
    const double rate = turning_rate(3000);
    keep_picture("large_moving.png");
    QTest::qWait(2500);
    keep_picture("large_still.png");
    qInfo(
        "10,000 loops: shown after %lld ms; turning %.1f frames a second in %d x %d; still picture %.0f ms; "
        "longest wait %lld ms",
        ready, rate, cloth.width(), cloth.height(), cloth.last_frame_ms(), heart.longest());
  }

  // How long the window is deaf while large files are worked on; needs the corpus of real programmes.
  void figures_of_answering() {
    if (!qEnvironmentVariableIsSet("LOOPWRIGHT_VIEW_FIGURES"))
      QSKIP("set LOOPWRIGHT_VIEW_FIGURES to measure");
    const QStringList files =
        qEnvironmentVariable("LOOPWRIGHT_VIEW_FILES").split(QLatin1Char(':'), Qt::SkipEmptyParts);
    for (const QString& name : files) {
      Heartbeat heart;
      QElapsedTimer clock;
      clock.start();
      QVERIFY(window_->open(name));
      const qint64 opened = clock.elapsed();
      QTRY_VERIFY_WITH_TIMEOUT(!window_->session().working() && window_->cloth().scene_is_current(), 120000);
      const qint64 ready = clock.elapsed(), while_made = heart.longest();
      QTest::qWait(1000);
      qInfo("%s: opened %lld ms, cloth %lld ms, longest wait %lld ms, with its picture %lld ms",
            qPrintable(name), opened, ready, while_made, heart.longest());
    }
  }
};

}  // namespace loopwright
