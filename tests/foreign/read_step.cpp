// Reads a STEP file with OpenCASCADE and says what is in it, a line a curve: degree, poles, arc length, and
// the places at twenty-one equal steps of the parameter.  Usage: read_step FILE
#include <BRep_Tool.hxx>
#include <GCPnts_AbscissaPoint.hxx>
#include <GeomAdaptor_Curve.hxx>
#include <Geom_BSplineCurve.hxx>
#include <Message.hxx>
#include <Message_Messenger.hxx>
#include <STEPControl_Reader.hxx>
#include <TopExp_Explorer.hxx>
#include <TopoDS.hxx>
#include <cstdio>

int main(int argc, char** argv) {
  if (argc != 2) return 2;
  STEPControl_Reader reader;
  if (reader.ReadFile(argv[1]) != IFSelect_RetDone) return 1;
  reader.TransferRoots();
  const TopoDS_Shape shape = reader.OneShape();
  for (TopExp_Explorer edges(shape, TopAbs_EDGE); edges.More(); edges.Next()) {
    double first = 0, last = 0;
    const Handle(Geom_Curve) curve = BRep_Tool::Curve(TopoDS::Edge(edges.Current()), first, last);
    const Handle(Geom_BSplineCurve) spline = Handle(Geom_BSplineCurve)::DownCast(curve);
    if (spline.IsNull()) return 3;
    const GeomAdaptor_Curve along(curve, first, last);
    std::printf("curve %d %d %.15g", spline->Degree(), spline->NbPoles(),
                GCPnts_AbscissaPoint::Length(along, 1e-9));
    constexpr int steps = 20;
    for (int k = 0; k <= steps; ++k) {
      const gp_Pnt p = curve->Value(first + (last - first) * k / steps);
      std::printf(" %.15g %.15g %.15g", p.X(), p.Y(), p.Z());
    }
    std::printf("\n");
  }
}
