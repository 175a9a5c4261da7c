// The real window, driven as a person would: it opens, is typed in, clicked, dragged, and writes its
// pictures.
#pragma once
#include "window_fixture.hpp"

namespace loopwright {

class WindowTest : public WindowFixture {
  Q_OBJECT

 private slots:
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

  void typing_changes_diagram_and_cloth() {
    open_rib();
    const std::size_t loops = window_->session().fabric()->loops.size();
    NotationEditor& editor = window_->editor();
    editor.go_to({10, 3});
    QTest::keyClicks(&editor, QStringLiteral("g"));
    QVERIFY(text().contains(QStringLiteral("geg   ; first")));
    QCOMPARE(window_->session().diagram().repeat_wales, 6);
    QTRY_VERIFY_WITH_TIMEOUT(at_rest() && window_->session().fabric()->loops.size() == 3 * loops, 30000);
    QCOMPARE(window_->interlacings_text(), QStringLiteral("interlacings 12 of 12"));
    // one history for all: the window's undo takes the typing back
    QTest::keyClick(&editor, Qt::Key_Z, Qt::ControlModifier);
    QTRY_COMPARE(text(), QString::fromUtf8(rib));
    QCOMPARE(editor.toPlainText(), QString::fromUtf8(rib));
  }

  void click_in_diagram_changes_one_letter() {
    open_rib();
    DiagramView& diagram = window_->diagram();
    diagram.set_tool(DiagramTool::stitch);
    // the rear needle of the first wale, first course
    QTest::mouseClick(diagram.viewport(), Qt::LeftButton, {}, diagram.needle_place(0, true, 0).toPoint());
    QString wanted = QString::fromUtf8(rib);
    wanted.replace(QStringLiteral("ge   ; first"), QStringLiteral("ee   ; first"));
    QCOMPARE(text(), wanted);
    QCOMPARE(window_->editor().toPlainText(), wanted);
    QTRY_VERIFY_WITH_TIMEOUT(at_rest(), 20000);
    QCOMPARE(window_->interlacings_text(), QStringLiteral("interlacings 4 of 4"));
    window_->session().undo();
    QCOMPARE(text(), QString::fromUtf8(rib));
  }

  void diagram_is_worked_by_keys() {
    open_rib();
    DiagramView& diagram = window_->diagram();
    diagram.setFocus();
    QTest::keyClick(&diagram, Qt::Key_Right);
    QTest::keyClick(&diagram, Qt::Key_V);
    QVERIFY2(text().contains(QStringLiteral("gv   ; first")), qPrintable(text()));
    QTest::keyClick(&diagram, Qt::Key_Insert);
    QVERIFY2(window_->session().diagram().courses == 3, qPrintable(text()));
    QTest::keyClick(&diagram, Qt::Key_Insert, Qt::ShiftModifier);
    QCOMPARE(window_->session().diagram().repeat_wales, 3);
  }

  void an_error_keeps_the_last_good_cloth() {
    open_rib();
    const auto cloth = window_->session().fabric();
    NotationEditor& editor = window_->editor();
    editor.go_to({10, 3});
    QTest::keyClicks(&editor, QStringLiteral("q"));
    auto* messages = window_->findChild<QTreeWidget*>(QStringLiteral("messages"));
    QCOMPARE(messages->topLevelItemCount(), 1);
    QCOMPARE(messages->topLevelItem(0)->text(0), QStringLiteral("10"));
    QTRY_COMPARE(stage(), ClothStage::unusable);
    QCOMPARE(window_->session().fabric(), cloth);
    QVERIFY(!window_->session().fabric_is_current());
    QVERIFY(!editor.extraSelections().isEmpty());
    QTest::qWait(200);
    keep_picture("error.png");
    QTest::keyClick(&editor, Qt::Key_Backspace);
    QCOMPARE(messages->topLevelItemCount(), 0);
    QTRY_VERIFY_WITH_TIMEOUT(at_rest(), 20000);
    QVERIFY(window_->session().fabric_is_current());
  }

  void click_on_a_loop_marks_it_everywhere() {
    open_rib();
    ClothView& cloth = window_->cloth();
    const Fabric& fabric = *window_->session().fabric();
    // a front stitch, where its yarn crosses the top of its head
    std::size_t chosen = 0;
    while (fabric.loops[chosen].side != StitchSide::front) ++chosen;
    const LoopSpan& span = fabric.loops[chosen];
    const Vec3 head = position(fabric, fabric.yarns[static_cast<std::size_t>(span.yarn)], span.apex);
    const QPoint at = cloth.on_screen(head + fabric.lattice(1, 1)).toPoint();
    QTest::mouseClick(&cloth, Qt::LeftButton, {}, at);
    const Selection& selection = window_->session().selection();
    QVERIFY(selection.span >= 0);
    QVERIFY(selection.at.line == 10 || selection.at.line == 11);
    QVERIFY(!window_->editor().extraSelections().isEmpty());
    QCOMPARE(window_->editor().textCursor().blockNumber() + 1, selection.at.line);
    QTRY_VERIFY(cloth.scene_is_current());
    QTest::qWait(300);
    keep_picture("selection.png");
  }

  void a_pulled_edge_stretches_the_cloth() {
    open_rib();
    ClothView& cloth = window_->cloth();
    const double width = window_->session().fabric()->width;
    Vec3 right;
    for (const FabricYarn& yarn : window_->session().fabric()->yarns)
      for (const Vec3& p : yarn.control_points)
        if (p.x > right.x) right = p;
    const QPoint from = cloth.on_screen(right + window_->session().fabric()->lattice(3, 1)).toPoint();
    QTest::mousePress(&cloth, Qt::LeftButton, {}, from);
    QTest::mouseMove(&cloth, from + QPoint(10, 0));
    QTest::mouseMove(&cloth, from + QPoint(25, 0));
    QTest::mouseRelease(&cloth, Qt::LeftButton, {}, from + QPoint(25, 0));
    QTRY_VERIFY_WITH_TIMEOUT(!window_->session().working(), 30000);
    QVERIFY(!window_->session().stretch_points().empty());
    QVERIFY(window_->session().fabric()->width > 1.02 * width);
    const StretchPoint& last = window_->session().stretch_points().back();
    QVERIFY(last.course_force > 0);
    QCOMPARE(last.interlacings_intact, last.interlacings);
    QCOMPARE(window_->stretch().plot()->plot().curves.front().x.size(),
             window_->session().stretch_points().size());
    QTest::qWait(300);
    keep_picture("stretch.png");
    const QString csv = folder_->filePath(QStringLiteral("curve.csv"));
    window_->stretch().write_curve(csv);
    QVERIFY(QFile(csv).size() > 50);
    window_->session().forget_stretch();
    QCOMPARE(window_->session().fabric()->width, width);
  }

  void a_pulled_binding_point_comes_back() {
    open_rib();
    ClothView& cloth = window_->cloth();
    cloth.set_style(ClothStyle::structure);
    QTRY_VERIFY_WITH_TIMEOUT(cloth.motion() != nullptr, 20000);
    const auto at_rest_now = [&] { return cloth.motion()->force() < 1e-4 && cloth.motion()->speed() < 1e-4; };
    QTRY_VERIFY_WITH_TIMEOUT(at_rest_now(), 30000);
    cloth.fit();
    const std::size_t middle = cloth.motion()->state().size() / 2;
    const Vec3 before = cloth.motion()->state().position(middle);
    const QPoint from = cloth.on_screen(before).toPoint();
    QTest::mousePress(&cloth, Qt::LeftButton, {}, from);
    QVERIFY(cloth.motion()->grabbed());
    QTest::mouseMove(&cloth, from + QPoint(20, 30));
    QTest::mouseMove(&cloth, from + QPoint(40, 60));
    QTest::qWait(400);
    keep_picture("structure.png");
    QTest::mouseRelease(&cloth, Qt::LeftButton, {}, from + QPoint(40, 60));
    QVERIFY(!cloth.motion()->grabbed());
    QTRY_VERIFY_WITH_TIMEOUT(at_rest_now(), 60000);
  }

  void a_pulled_yarn_moves_and_is_let_go() {
    open_rib();
    ClothView& cloth = window_->cloth();
    const Fabric rest = *window_->session().fabric();
    const LoopSpan& span = rest.loops.front();
    const Vec3 head = position(rest, rest.yarns[static_cast<std::size_t>(span.yarn)], span.apex);
    const QPoint at = cloth.on_screen(head + rest.lattice(1, 1)).toPoint();
    QTest::mousePress(&cloth, Qt::LeftButton, Qt::ControlModifier, at);
    QTest::mouseMove(&cloth, at + QPoint(0, -10));
    QTest::mouseMove(&cloth, at + QPoint(0, -60));
    QTRY_VERIFY_WITH_TIMEOUT(!window_->session().working(), 20000);
    double farthest = 0;
    const Fabric& pulled = *window_->session().fabric();
    for (std::size_t y = 0; y < rest.yarns.size(); ++y)
      for (std::size_t i = 0; i < rest.yarns[y].control_points.size(); ++i)
        farthest =
            std::max(farthest, distance(rest.yarns[y].control_points[i], pulled.yarns[y].control_points[i]));
    QVERIFY2(farthest > 0.05, qPrintable(QString::number(farthest)));
    QCOMPARE(window_->interlacings_text(), QStringLiteral("interlacings 4 of 4"));
    QTest::mouseRelease(&cloth, Qt::LeftButton, Qt::ControlModifier, at + QPoint(0, -60));
    QTRY_VERIFY_WITH_TIMEOUT(!window_->session().working(), 20000);
    window_->session().forget_stretch();
    QCOMPARE(window_->session().fabric()->yarns[0].control_points[0], rest.yarns[0].control_points[0]);
  }

  void another_editors_change_is_taken() {
    open_rib();
    QString changed = QString::fromUtf8(rib);
    changed.replace(QStringLiteral("ge   ; second"), QStringLiteral("gg   ; second"));
    file("rib.verm", qPrintable(changed));
    QTRY_COMPARE_WITH_TIMEOUT(text(), changed, 5000);
    QVERIFY(!window_->isWindowModified());
    QTRY_VERIFY_WITH_TIMEOUT(at_rest(), 20000);
    window_->session().undo();
    QCOMPARE(text(), QString::fromUtf8(rib));
  }

  void picture_is_that_of_the_command() {
    open_rib();
    ClothView& cloth = window_->cloth();
    cloth.set_floor(false);
    QTest::qWait(400);  // shadows come back
    const QSize size(640, 480);
    const QImage own = cloth.picture(size);
    RenderOptions options;
    options.width = size.width(), options.height = size.height();
    options.repeats = {4, 4};
    options.look.fuzz = 0;
    options.style.table = false;
    Image drawn;
    try {
      drawn = render(*window_->session().fabric(), cloth.camera(), options);
    } catch (const NoOpenGl& missing) {
      QSKIP(missing.what());
    }
    const QImage other(drawn.pixels.data(), drawn.width, drawn.height, QImage::Format_RGBA8888);
    const double apart = difference(own, other.convertToFormat(QImage::Format_RGB32), 48);
    QVERIFY2(apart < 0.02, qPrintable(QString::number(apart)));
    // and the cloth is there at all
    QImage empty(size, QImage::Format_RGB32);
    empty.fill(QColor(246, 245, 242));
    QVERIFY(difference(own, empty, 48) > 0.1);
  }

  void exports_and_saves() {
    open_rib();
    for (const char* name : {"a.png", "a.svg", "a.json", "a.h5", "a.obj"}) {
      window_->export_to(folder_->filePath(QLatin1String(name)));
      QVERIFY2(QFile(folder_->filePath(QLatin1String(name))).size() > 100, name);
    }
    const QString copy = folder_->filePath(QStringLiteral("copy.verm"));
    QVERIFY(window_->save_to(copy));
    QFile saved(copy);
    QVERIFY(saved.open(QIODevice::ReadOnly));
    QCOMPARE(saved.readAll(), QByteArray(rib));
  }

  void unsaved_text_is_found_again() {
    open_rib();
    window_->editor().go_to({10, 3});
    QTest::keyClicks(&window_->editor(), QStringLiteral("e"));
    const QString kept =
        folder_->filePath(QStringLiteral("autosave/unsaved-%1").arg(QCoreApplication::applicationPid()));
    QTRY_VERIFY_WITH_TIMEOUT(QFile::exists(kept), 5000);
    // as a program that was killed would have left it
    QVERIFY(QFile::copy(kept, folder_->filePath(QStringLiteral("autosave/unsaved-999999999"))));
    const Autosave other(folder_->filePath(QStringLiteral("autosave")));
    const auto left = other.left_behind();
    QVERIFY(left.has_value());
    QVERIFY(left->text.find("gee   ; first") != std::string::npos);
    Autosave::discard(*left);
    QVERIFY(!other.left_behind().has_value());
    window_->session().document().save(window_->session().document().path());
  }

  void a_yarn_and_a_length_are_changed_in_their_panels() {
    open_rib();
    auto* length = window_->findChild<QDoubleSpinBox*>(QStringLiteral("Loop-Length"));
    QCOMPARE(length->value(), 5.9);
    length->setValue(6.5);
    QVERIFY(text().contains(QStringLiteral(";;Loop-Length: 6.5 mm\n")));
    auto* yarn = window_->findChild<QLineEdit*>(QStringLiteral("yarn A"));
    yarn->setText(QStringLiteral("wool 2/28 Nm colour=#b03020"));
    emit yarn->editingFinished();
    QVERIFY(
        text().contains(QStringLiteral(";;Yarn-A: wool 2/28 Nm colour=#b03020            ; the usual one")));
    window_->findChild<QDoubleSpinBox*>(QStringLiteral("Friction A"))->setValue(0.4);
    QVERIFY2(text().contains(QStringLiteral("friction=0.4")), qPrintable(text()));
    auto* liveliness = window_->findChild<QDoubleSpinBox*>(QStringLiteral("Liveliness A"));
    QCOMPARE(liveliness->value(), 0);
    liveliness->setValue(-150);
    QVERIFY2(text().contains(QStringLiteral("liveliness=-150 tpm")), qPrintable(text()));
    QVERIFY(text().contains(QStringLiteral("colour=#b03020")));
    liveliness->setValue(0);
    yarn->setText(QStringLiteral("wool 2/28 Nm diameter=-3mm"));
    const QString before = text();
    emit yarn->editingFinished();
    QCOMPARE(text(), before);  // refused, and said
    QTRY_VERIFY_WITH_TIMEOUT(at_rest(), 20000);
  }

  void views_styles_and_colours() {
    open_rib();
    ClothView& cloth = window_->cloth();
    QImage last = cloth.picture({320, 240});
    for (const View view : {View::left, View::top, View::corner}) {
      cloth.set_view(view);
      QTRY_VERIFY(cloth.scene_is_current());
      const QImage now = cloth.picture({320, 240});
      QVERIFY(difference(now, last, 30) > 0.02);
      last = now;
    }
    for (const ColourBy by :
         {ColourBy::tension, ColourBy::curvature, ColourBy::contact, ColourBy::loop_kind}) {
      cloth.set_colour_by(by);
      QTRY_VERIFY_WITH_TIMEOUT(cloth.scene_is_current(), 10000);
      const QImage now = cloth.picture({320, 240});
      QVERIFY2(difference(now, last, 20) > 0.01, qPrintable(QString::number(static_cast<int>(by))));
      last = now;
    }
    window_->resize(2560, 1440);
    cloth.set_colour_by(ColourBy::tension);
    QTest::qWait(1500);
    keep_picture("large.png");
    for (QAction* action : window_->findChildren<QAction*>())
      if (action->text() == QStringLiteral("&Dark")) action->trigger();
    const QImage dark = cloth.picture({320, 240});
    QVERIFY(qGray(dark.pixel(2, 2)) < 80);
    QTest::qWait(pictures_folder().isEmpty() ? 0 : 3000);
    keep_picture("dark.png");
    for (QAction* action : window_->findChildren<QAction*>())
      if (action->text() == QStringLiteral("&Dark")) action->trigger();
  }

  // Pictures of other files, to be looked at: LOOPWRIGHT_VIEW_FILES names them, parted by colons.
  void pictures_of_files() {
    const QStringList files =
        qEnvironmentVariable("LOOPWRIGHT_VIEW_FILES").split(QLatin1Char(':'), Qt::SkipEmptyParts);
    if (files.isEmpty()) QSKIP("set LOOPWRIGHT_VIEW_FILES to files to be looked at");
    for (qsizetype i = 0; i < files.size(); ++i) {
      QVERIFY(window_->open(files[i]));
      QTRY_VERIFY_WITH_TIMEOUT(!window_->session().working() && window_->cloth().scene_is_current(), 60000);
      QTest::qWait(1500);
      keep_picture(qPrintable(QStringLiteral("file_%1.png").arg(i)));
    }
  }

  // Figures for docs/view.md; none is asked for, as they belong to the machine.
  void figures() {
    if (!qEnvironmentVariableIsSet("LOOPWRIGHT_VIEW_FIGURES"))
      QSKIP("set LOOPWRIGHT_VIEW_FIGURES to measure");
    const QString cell = QStringLiteral(
        ";!vermiculation-1\n;;Gauge: 12\n;;Bed-Gap: 2 mm\n;;Yarn-A: wool 2/28 Nm\n"
        ";;Loop-Length: 5.9 mm\n;;Size: 8 wales x 8 courses\n;;Edges: held\n"
        "ggee\nggee\neegg\neegg\n");
    int pictures = 0;
    double first_s = 0;
    QElapsedTimer clock;
    clock.start();
    {
      MainWindow other(folder_->filePath(QStringLiteral("other")));
      other.show();
      QVERIFY(other.open(file("start.verm", rib)));
      QTRY_VERIFY(other.cloth().frames_drawn() > 0 && other.session().fabric());
      qInfo("window with a small file: %.3f s", static_cast<double>(clock.elapsed()) * 1e-3);
    }
    connect(&window_->session(), &Session::fabric_changed, this, [&] {
      if (pictures++ == 0) first_s = static_cast<double>(clock.elapsed()) * 1e-3;
    });
    clock.start();
    QVERIFY(window_->open(file("cell.verm", qPrintable(cell))));
    QTRY_VERIFY_WITH_TIMEOUT(at_rest(), 60000);
    pictures = 0;
    clock.restart();
    DiagramView& diagram = window_->diagram();
    diagram.set_tool(DiagramTool::stitch);
    // the first pass that is written; before it stand transfers that follow from it
    std::size_t pass = 0;
    while (window_->session().diagram().passes[pass].implied) ++pass;
    QTest::mouseClick(diagram.viewport(), Qt::LeftButton, {}, diagram.needle_place(pass, true, 0).toPoint());
    QTRY_VERIFY_WITH_TIMEOUT(at_rest(), 60000);
    const double seconds = static_cast<double>(clock.elapsed()) * 1e-3;
    QVERIFY2(pictures > 0, qPrintable(text()));
    qInfo("4 x 4 repeat after an edit: first picture %.3f s, %d pictures in %.2f s, %.1f a second", first_s,
          pictures, seconds, pictures / seconds);
    ClothView& cloth = window_->cloth();
    QTest::qWait(500);
    const double rate = turning_rate(2000);
    QVERIFY(rate > 0);
    qInfo("turning: %.1f frames a second in %d x %d, the last took %.1f ms", rate, cloth.width(),
          cloth.height(), cloth.last_frame_ms());
  }
};

}  // namespace loopwright
