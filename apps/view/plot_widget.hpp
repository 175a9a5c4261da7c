// Curves in a plane, drawn as the points come.
#pragma once
#include <QWidget>

#include "outputs/write_plot_svg.hpp"

namespace loopwright {

class PlotWidget : public QWidget {
  Q_OBJECT
 public:
  explicit PlotWidget(QWidget* parent = nullptr);
  void set_plot(Plot plot);
  const Plot& plot() const { return plot_; }
  QSize sizeHint() const override { return {260, 200}; }

 protected:
  void paintEvent(QPaintEvent* event) override;

 private:
  Plot plot_;
};

}  // namespace loopwright
