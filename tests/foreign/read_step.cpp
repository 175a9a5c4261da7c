// Reads a STEP file with OpenCASCADE and says what is in it. A line a curve: degree, poles, arc length, and
// the places at twenty-one equal steps of the parameter. A line a solid: whether it is sound, its volume and
// its surface, the volume that its mesh encloses, and places on its side. Usage: read_step FILE
#include <BRepCheck_Analyzer.hxx>
#include <BRepGProp.hxx>
#include <BRepMesh_IncrementalMesh.hxx>
#include <BRep_Tool.hxx>
#include <GCPnts_AbscissaPoint.hxx>
#include <GProp_GProps.hxx>
#include <GeomAdaptor_Curve.hxx>
#include <Geom_BSplineCurve.hxx>
#include <Geom_BSplineSurface.hxx>
#include <Message.hxx>
#include <Message_Messenger.hxx>
#include <Poly_Triangulation.hxx>
#include <STEPControl_Reader.hxx>
#include <TopExp_Explorer.hxx>
#include <TopoDS.hxx>
#include <TopoDS_Face.hxx>
#include <cstdio>

// Of the triangles that a viewer draws: within 0.01 mm and half a radian, as FreeCAD's are.
double mesh_volume(const TopoDS_Shape& solid) {
  const BRepMesh_IncrementalMesh mesh(solid, 0.01, false, 0.5);
  double volume = 0;
  for (TopExp_Explorer faces(solid, TopAbs_FACE); faces.More(); faces.Next()) {
    TopLoc_Location place;
    const TopoDS_Face face = TopoDS::Face(faces.Current());
    const Handle(Poly_Triangulation) triangles = BRep_Tool::Triangulation(face, place);
    if (triangles.IsNull()) continue;
    for (int k = 1; k <= triangles->NbTriangles(); ++k) {
      int a, b, c;
      triangles->Triangle(k).Get(a, b, c);
      const gp_Vec p(triangles->Node(a).XYZ()), q(triangles->Node(b).XYZ()), r(triangles->Node(c).XYZ());
      volume += p.Dot(q.Crossed(r)) / 6 * (face.Orientation() == TopAbs_REVERSED ? -1 : 1);
    }
  }
  return volume;
}

void say_solid(const TopoDS_Shape& solid) {
  GProp_GProps volume, surface;
  BRepGProp::VolumeProperties(solid, volume, 1e-7);
  BRepGProp::SurfaceProperties(solid, surface, 1e-7);
  std::printf("solid %d %.15g %.15g %.15g", BRepCheck_Analyzer(solid).IsValid() ? 1 : 0, volume.Mass(),
              surface.Mass(), mesh_volume(solid));
  for (TopExp_Explorer faces(solid, TopAbs_FACE); faces.More(); faces.Next()) {
    const Handle(Geom_BSplineSurface) side =
        Handle(Geom_BSplineSurface)::DownCast(BRep_Tool::Surface(TopoDS::Face(faces.Current())));
    if (side.IsNull()) continue;
    double u0, u1, v0, v1;
    side->Bounds(u0, u1, v0, v1);
    for (int k = 0; k < 40; ++k) {
      // all round, and between knots as well as on them
      const gp_Pnt p = side->Value(u0 + (u1 - u0) * (k % 37) / 37, v0 + (v1 - v0) * k / 39);
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
