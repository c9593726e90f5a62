// What the viewer's stage shows in space: clouds of a 3D grid's field, and the scene's solids.
#include "rigid/bodies.hpp"
#include "app/view/solid_mesh.hpp"
#include "app/view/stage.hpp"

#include <vtkActor.h>
#include <vtkClipDataSet.h>
#include <vtkContourFilter.h>
#include <vtkFloatArray.h>
#include <vtkGeometryFilter.h>
#include <vtkImageData.h>
#include <vtkPointData.h>
#include <vtkSmartVolumeMapper.h>
#include <vtkVolume.h>
#include <vtkVolumeProperty.h>

#include <algorithm>
#include <cmath>

namespace weir::view {

namespace {

/// Signed distance to the solids [m] on a lattice of `step` [m] over the box.
template <int D>
vtkSmartPointer<vtkImageData> distances(const scene::Scene& scene, real time, const PoseOf& pose, const std::array<real, 6>& box,
                                        real step) {
    rigid::ShownSolids<D> shown(scene);
    if (shown.empty()) return nullptr;
    const geometry::Solids<D>& solids = shown.at(time, pose);
    auto image = vtkSmartPointer<vtkImageData>::New();
    std::array<int, 3> n{1, 1, 1};
    for (std::size_t a = 0; a < D; ++a) n[a] = 1 + static_cast<int>(std::ceil((box[2 * a + 1] - box[2 * a]) / step - 1e-9));
    image->SetDimensions(n.data());
    image->SetOrigin(box[0], box[2], box[4]);
    image->SetSpacing(step, step, step);
    vtkNew<vtkFloatArray> values;
    values->SetNumberOfTuples(image->GetNumberOfPoints());
    for (vtkIdType i = 0; i < image->GetNumberOfPoints(); ++i) {
        Vec<D> x;
        for (int a = 0; a < D; ++a) x[a] = image->GetPoint(i)[a];
        values->SetValue(i, static_cast<float>(solids.distance(x)));
    }
    image->GetPointData()->SetScalars(values);
    return image;
}

}  // namespace

vtkSmartPointer<vtkPolyData> solid_mesh(const scene::Scene& scene, real time, const PoseOf& pose, const std::array<real, 6>& box,
                                        real cell) {
    const bool flat = scene.dim() == 2;
    const real longest = std::max({box[1] - box[0], box[3] - box[2], box[5] - box[4]});
    const real step = std::max(0.5 * cell, longest / (flat ? 600 : 160));
    const auto image = flat ? distances<2>(scene, time, pose, box, step) : distances<3>(scene, time, pose, box, step);
    if (!image) return nullptr;
    if (!flat) {
        vtkNew<vtkContourFilter> surface;
        surface->SetInputData(image);
        surface->SetValue(0, 0);
        surface->Update();
        return surface->GetOutput();
    }
    vtkNew<vtkClipDataSet> inside;
    inside->SetInputData(image);
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
