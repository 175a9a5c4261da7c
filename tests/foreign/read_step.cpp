// Reads a STEP file with OpenCASCADE and says what is in it. A line a curve: degree, poles, arc length, and
// the places at twenty-one equal steps of the parameter. A line a solid: whether it is sound, its volume and
// its surface, and places on its side. Usage: read_step FILE
#include <BRepCheck_Analyzer.hxx>
#include <BRepGProp.hxx>
#include <BRep_Tool.hxx>
#include <GCPnts_AbscissaPoint.hxx>
#include <GProp_GProps.hxx>
#include <GeomAdaptor_Curve.hxx>
#include <Geom_BSplineCurve.hxx>
#include <Geom_BSplineSurface.hxx>
#include <Message.hxx>
#include <Message_Messenger.hxx>
#include <STEPControl_Reader.hxx>
#include <TopExp_Explorer.hxx>
#include <TopoDS.hxx>
#include <cstdio>

void say_solid(const TopoDS_Shape& solid) {
  GProp_GProps volume, surface;
  BRepGProp::VolumeProperties(solid, volume, 1e-7);
  BRepGProp::SurfaceProperties(solid, surface, 1e-7);
  std::printf("solid %d %.15g %.15g", BRepCheck_Analyzer(solid).IsValid() ? 1 : 0, volume.Mass(),
              surface.Mass());
  for (TopExp_Explorer faces(solid, TopAbs_FACE); faces.More(); faces.Next()) {
    const Handle(Geom_BSplineSurface) side =
        Handle(Geom_BSplineSurface)::DownCast(BRep_Tool::Surface(TopoDS::Face(faces.Current())));
    if (side.IsNull()) continue;
    double u0, u1, v0, v1;
    side->Bounds(u0, u1, v0, v1);
    for (int k = 0; k < 400; ++k) {
      // all round, and between knots as well as on them
      const gp_Pnt p = side->Value(u0 + (u1 - u0) * (k % 37) / 37, v0 + (v1 - v0) * k / 399);
      std::printf(" %.15g %.15g %.15g", p.X(), p.Y(), p.Z());
    }
  }
  std::printf("\n");
}

int main(int argc, char** argv) {
  if (argc != 2) return 2;
  STEPControl_Reader reader;
  if (reader.ReadFile(argv[1]) != IFSelect_RetDone) return 1;
  reader.TransferRoots();
  const TopoDS_Shape shape = reader.OneShape();
  for (TopExp_Explorer solids(shape, TopAbs_SOLID); solids.More(); solids.Next()) say_solid(solids.Current());
  if (TopExp_Explorer(shape, TopAbs_SOLID).More()) return 0;
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
