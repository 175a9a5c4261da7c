// What all parts of the window share: the document, the cloth that follows it, and what is chosen. Views talk
// to the session, never to each other.
#pragma once
#include <QObject>
#include <optional>

#include "cloth_colours.hpp"
#include "cloth_job.hpp"
#include "document.hpp"
#include "latest_only.hpp"
#include "notation/needle_diagram.hpp"
#include "pull_session.hpp"
#include "stretch_session.hpp"

namespace loopwright {

// A loop that was clicked in some view. Others of the same letter (repeats) are its kin.
struct Selection {
  SourceLocation at;  // its letter or instruction; line 0: nothing is chosen
  int span = -1;      // index into the shown fabric's loops; -1: only its letter is known
};

class Session : public QObject {
  Q_OBJECT
 public:
  explicit Session(QObject* parent = nullptr);
  ~Session() override;

  Document& document() { return document_; }
  const ClothMoment& moment() const { return moment_; }
  // The cloth that is shown: the last good one, while a new one is made or where the text has errors.
  const std::shared_ptr<const Fabric>& fabric() const { return fabric_; }
  bool fabric_is_current() const { return fabric_is_current_; }
  // Its passes are asked for one by one: knitout may have many thousand.
  const NeedleDiagram& diagram() const { return diagram_; }
  std::size_t passes() const;
  const DiagramPass& pass(std::size_t p) const;
  const std::shared_ptr<const KnitoutPasses>& knitout() const { return knitout_; }  // none for fabric files
  // Knitting needle by needle: loops that this instruction of the programme or an earlier one formed; -1:
  // all.
  int knitted_until() const { return knitted_until_; }
  void knit_until(int instruction);
  bool diagram_is_current() const { return diagram_is_current_; }
  const std::shared_ptr<const Vermiculation>& notation() const { return notation_; }
  // Of the text as it is: of the notation at once, of machine and geometry when they have been asked.
  const Diagnostics& diagnostics() const { return diagnostics_; }
  const Selection& selection() const { return selection_; }
  // Whether what is shown may not be taken for the cloth that the notation knits.
  bool broken() const { return moment_.broken() || broken_pass_throughs_ > 0; }
  bool working() const { return working_; }
  double working_seconds() const;

  PieceChoice piece_choice() const { return piece_; }
  void choose_piece(PieceChoice piece);
  void set_automatic(bool automatic);  // relax after every edit
  bool automatic() const { return automatic_; }

  // Changes the notation by a function that answers why it cannot (empty: done); true if it was done. One
  // step of the history.
  bool edit_notation(const QString& what, const std::function<std::string(Vermiculation&)>& edit);
  void change_text(const std::string& text, const QString& what, bool joined = false);

  void select(Selection selection);
  void select_at(SourceLocation at);  // the first loop of a letter
  // Spans of the shown fabric that the letter made.
  std::vector<int> spans_at(SourceLocation at) const;

  // Pulls the cloth at rest to a strain of its size (in the worker); the cloth follows.
  void stretch_to(StretchDirection direction, double strain);
  const std::vector<StretchPoint>& stretch_points() const { return stretch_points_; }
  void forget_stretch();  // shows the cloth at rest again
  // Takes hold of a yarn of the cloth at rest, pulls it (force in B/d^2, zero lets go); the cloth follows.
  void take_hold(int yarn, double t);
  void pull(const Vec3& force);

 public slots:
  void make_cloth_anew();  // from the first geometry, as the choice of piece says, live limits respected
  void relax_whole();      // whatever its size
  void cancel();
  void undo();
  void redo();

 signals:
  void text_changed(qsizetype begin, qsizetype removed, qsizetype inserted, bool whole);
  void reading_changed();  // notation, diagram, diagnostics
  void moment_changed();   // stage, numbers, and perhaps the fabric
  void fabric_changed();
  void knitted_changed();  // by the slider
  void selection_changed();
  void stretch_changed();
  void refused(const QString& why);  // an edit that cannot be

 private:
  void read_text();
  void start_cloth(std::size_t most_loops, bool from_hand);
  void end_work(int serial);
  void take_moment(int serial, ClothMoment moment);
  // Runs a hand's work in the worker; it answers the cloth that it came to.
  void work_by_hand(const std::function<void(int serial, const std::atomic<bool>& cancelled)>& work);
  struct HandMoment {
    std::shared_ptr<const Fabric> cloth;
    int pass_throughs = 0;
    std::optional<StretchPoint> point;          // of a stretch test
    std::shared_ptr<const RelaxResult> pulled;  // the end of a pull
  };
  void show_by_hand(int serial, HandMoment moment);

  Document document_;
  std::shared_ptr<const Vermiculation> notation_;
  NeedleDiagram diagram_;
  std::shared_ptr<const KnitoutPasses> knitout_;
  mutable PassCache shown_passes_;
  int knitted_until_ = -1;
  bool describing_ = false;
  std::optional<ClothAtHand> at_hand_;
  InterlacingCheck at_rest_;  // of the cloth before a hand changed it
  bool diagram_is_current_ = false, fabric_is_current_ = false, automatic_ = true, working_ = false;
  Diagnostics diagnostics_;
  Selection selection_;
  PieceChoice piece_ = PieceChoice::automatic;
  ClothMoment moment_;
  std::shared_ptr<const Fabric> fabric_;
  std::vector<StretchPoint> stretch_points_;
  std::shared_ptr<StretchSession> stretch_;
  std::shared_ptr<PullSession> pull_;
  std::shared_ptr<const RelaxResult> pulled_;  // what the last pull came to
  int broken_pass_throughs_ = 0;               // of what the hand did to the cloth
  int serial_ = 0;                             // of the work whose moments count
  double working_since_ = 0;
  LatestOnly worker_;  // last: its thread uses the rest
};

}  // namespace loopwright
