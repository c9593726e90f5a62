// What the viewer's stage shows in space: clouds of a 3D grid's field, and the scene's solids.
#include "rigid/bodies.hpp"
#include "app/view/solid_mesh.hpp"
#include "app/view/stage.hpp"
#include "geometry/mesh/mesh.hpp"

#include <vtkActor.h>
#include <vtkAppendPolyData.h>
#include <vtkCellArray.h>
#include <vtkClipDataSet.h>
#include <vtkContourFilter.h>
#include <vtkFloatArray.h>
#include <vtkGeometryFilter.h>
#include <vtkImageData.h>
#include <vtkPointData.h>
#include <vtkPoints.h>
#include <vtkPolyDataMapper.h>
#include <vtkPolyDataNormals.h>
#include <vtkProperty.h>
#include <vtkRenderer.h>
#include <vtkSmartVolumeMapper.h>
#include <vtkVolume.h>
#include <vtkVolumeProperty.h>

#include <algorithm>
#include <cmath>

namespace weir::view {

namespace {

/// Signed distance to the solids that are not meshes [m] on a lattice of `step` [m] over the box.
template <int D>
vtkSmartPointer<vtkImageData> distances(const geometry::Solids<D>& solids, const std::array<real, 6>& box, real step) {
    auto image = vtkSmartPointer<vtkImageData>::New();
    std::array<int, 3> n{1, 1, 1};
    for (std::size_t a = 0; a < D; ++a) n[a] = 1 + static_cast<int>(std::ceil((box[2 * a + 1] - box[2 * a]) / step - 1e-9));
    image->SetDimensions(n.data());
    image->SetOrigin(box[0], box[2], box[4]);
    image->SetSpacing(step, step, step);
    const Vec<3> size{{box[1] - box[0], box[3] - box[2], box[5] - box[4]}};
    vtkNew<vtkFloatArray> values;
    values->SetNumberOfTuples(image->GetNumberOfPoints());
    for (vtkIdType i = 0; i < image->GetNumberOfPoints(); ++i) {
        Vec<D> x;
        for (int a = 0; a < D; ++a) x[a] = image->GetPoint(i)[a];
        real d = infinity;
        for (std::size_t s = 0; s < solids.count(); ++s)
            if (!solids[s].shape->mesh()) d = std::min(d, solids.distance(s, x));
        values->SetValue(i, static_cast<float>(std::min(d, norm(size))));
    }
    image->GetPointData()->SetScalars(values);
    return image;
}

/// The triangles of solids that are meshes, where these are.
vtkSmartPointer<vtkPolyData> triangles_of(const geometry::Solids<3>& solids) {
    vtkNew<vtkPoints> points;
    vtkNew<vtkCellArray> cells;
    for (std::size_t s = 0; s < solids.count(); ++s) {
        const geometry::PosedMesh* posed = solids[s].shape->mesh();
        if (!posed) continue;
        const vtkIdType first = points->GetNumberOfPoints();
        for (const Vec<3>& y : posed->mesh->triangles().points) points->InsertNextPoint(solids.pose(s).to_world(posed->to_scene(y)).data());
        for (const auto& t : posed->mesh->triangles().corners) {
            const std::array<vtkIdType, 3> corners{first + t[0], first + t[1], first + t[2]};
            cells->InsertNextCell(3, corners.data());
        }
    }
    auto mesh = vtkSmartPointer<vtkPolyData>::New();
    mesh->SetPoints(points);
    mesh->SetPolys(cells);
    return mesh;
}

vtkSmartPointer<vtkPolyData> surface_of(const geometry::Solids<3>& solids, const std::array<real, 6>& box, real step) {
    vtkNew<vtkContourFilter> surface;
    surface->SetInputData(distances<3>(solids, box, step));
    surface->SetValue(0, 0);
    vtkNew<vtkAppendPolyData> both;
    both->AddInputConnection(surface->GetOutputPort());
    both->AddInputData(triangles_of(solids));
    vtkNew<vtkPolyDataNormals> smooth;  // of meshes; a contour has its own
    smooth->SetInputConnection(both->GetOutputPort());
    smooth->SplittingOn();
    smooth->SetFeatureAngle(45);
    smooth->Update();
    return smooth->GetOutput();
}

}  // namespace

vtkSmartPointer<vtkPolyData> solid_mesh(const scene::Scene& scene, real time, const PoseOf& pose, const std::array<real, 6>& box,
                                        real cell) {
    const bool flat = scene.dim() == 2;
    const real longest = std::max({box[1] - box[0], box[3] - box[2], box[5] - box[4]});
    const real step = std::max(0.5 * cell, longest / (flat ? 600 : 160));
    if (!flat) {
        rigid::ShownSolids<3> shown(scene);
        return shown.empty() ? nullptr : surface_of(shown.at(time, pose), box, step);
    }
    rigid::ShownSolids<2> shown(scene);
    if (shown.empty()) return nullptr;
    vtkNew<vtkClipDataSet> inside;
    inside->SetInputData(distances<2>(shown.at(time, pose), box, step));
    inside->SetValue(0);
    inside->InsideOutOn();
    vtkNew<vtkGeometryFilter> sheet;
    sheet->SetInputConnection(inside->GetOutputPort());
    sheet->Update();
    return sheet->GetOutput();
}

void Stage::add_solids(const Frame& frame) {
    const PoseOf pose = [&](const char* field, std::size_t component, std::size_t body) {
        vtkPolyData* points = frame.particles.at(rigid::body_set_name);
        const auto point = static_cast<vtkIdType>(body);
        if (std::string_view(field) == "position") return points->GetPoint(point)[component];
        return points->GetPointData()->GetArray(field)->GetComponent(point, static_cast<int>(component));
    };
    if (const auto mesh = solid_mesh(scene_, frame.time, pose, domain_.box, domain_.cell))
        add_mesh(mesh, false, [&](vtkActor* actor) { paint_solids(actor, domain_); });
}

void Stage::add_cloud(const Frame& frame, const std::string& field) {
    const auto shown = coloured(frame.grid, frame, field);
    if (!shown) return;
    widen(shown);
    scale_.set(field);
    vtkNew<vtkVolume> volume;
    scale_.colour(volume->GetProperty());
    volume->GetProperty()->SetInterpolationTypeToLinear();
    volume->GetProperty()->SetScalarOpacityUnitDistance(4 * domain_.cell);
    vtkNew<vtkSmartVolumeMapper> mapper;
    mapper->SetInputData(shown);
    volume->SetMapper(mapper);
    add(volume.Get());
}

}  // namespace weir::view
