#include "yarn_facts.hpp"

#include <QObject>
#include <set>

#include "notation/material.hpp"

namespace loopwright {
namespace {

QString row(const QString& name, const QString& value) {
  return QStringLiteral("<tr><td style='padding-right:10px'>%1</td><td><b>%2</b></td></tr>")
      .arg(name, value.toHtmlEscaped());
}

// The headers that a knitout file carries, carrier by carrier.
QString facts_of_program(const Knitting& knitting) {
  const Program& program = knitting.program;
  QString rows;
  std::set<std::size_t> used;
  for (const GraphYarn& yarn : knitting.graph.yarns)
    if (!yarn.loops.empty() && yarn.carrier.valid()) used.insert(yarn.carrier.position());
  for (const std::size_t carrier : used) {
    const QString data = carrier < program.yarns.size()
                             ? QString::fromStdString(yarn_value(program.yarns[carrier]))
                             : QString();
    rows += row(QObject::tr("Carrier %1").arg(QString::fromStdString(program.carriers[carrier])),
                data.isEmpty() ? QObject::tr("nothing said") : data);
  }
  const FabricSettings& settings = program.settings;
  if (settings.gauge_npi) rows += row(QObject::tr("Gauge"), QString::number(*settings.gauge_npi));
  if (settings.loop_length_mm)
    rows += row(QObject::tr("Loop length"), QObject::tr("%1 mm").arg(*settings.loop_length_mm));
  return QStringLiteral("<table>%1</table><p>%2</p>")
      .arg(rows,
           QObject::tr("These stand in the file's headers, such as <tt>;;Yarn-1: wool 2/28 Nm</tt> and "
                       "<tt>;;X-Loop-Length: 5.9 mm</tt>. A change by another editor is taken at once."));
}

QString facts_of_material(const ClothMoment& moment) {
  const YarnMaterial& material = moment.options->model.material;
  const double d_mm = moment.fabric->diameter_mm, bend = material.reference_bend_N_m2;
  QString rows = row(QObject::tr("Diameter"), QObject::tr("%1 mm").arg(d_mm, 0, 'g', 4));
  if (bend > 0) {
    const double d = d_mm * 1e-3;
    rows += row(QObject::tr("Bending"), QObject::tr("%1 mN mm\u00b2").arg(bend * 1e9, 0, 'g', 4));
    rows += row(QObject::tr("Stretching"),
                QObject::tr("%1 cN").arg(material.stretch_stiffness * bend / (d * d) * 100, 0, 'g', 4));
  } else {
    rows += row(QObject::tr("Stretching"),
                QObject::tr("%1 B/d\u00b2").arg(material.stretch_stiffness, 0, 'g', 4));
  }
  if (material.twist_stiffness > 0)
    rows += row(QObject::tr("Twisting"),
                bend > 0 ? QObject::tr("%1 mN mm\u00b2").arg(material.twist_stiffness * bend * 1e9, 0, 'g', 4)
                         : QObject::tr("%1 B").arg(material.twist_stiffness, 0, 'g', 4));
  rows += row(QObject::tr("Friction"), QString::number(material.friction, 'g', 3));
  return QStringLiteral("<table>%1</table><p>%2</p>").arg(rows, QObject::tr("As the file of cloth says it."));
}

}  // namespace

QString yarn_facts(const ClothMoment& moment, DocumentKind kind) {
  if (kind == DocumentKind::knitout && moment.knitting) return facts_of_program(*moment.knitting);
  if (kind != DocumentKind::cloth || !moment.fabric) return {};
  if (moment.options) return facts_of_material(moment);
  return QStringLiteral("<table>%1</table>")
      .arg(row(QObject::tr("Diameter"), QObject::tr("%1 mm").arg(moment.fabric->diameter_mm, 0, 'g', 4)));
}

}  // namespace loopwright
