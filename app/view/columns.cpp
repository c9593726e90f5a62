// What the viewer's stage shows of columns of water: the ground, the water on it, and boxes that float.
#include "app/view/stage.hpp"

#include <vtkActor.h>
#include <vtkCellArray.h>
#include <vtkCellData.h>
#include <vtkCubeSource.h>
#include <vtkDataArray.h>
#include <vtkFloatArray.h>
#include <vtkImageData.h>
#include <vtkPointData.h>
#include <vtkPoints.h>
#include <vtkPolyData.h>
#include <vtkPolyDataMapper.h>
#include <vtkPolyDataNormals.h>
#include <vtkProperty.h>

#include <algorithm>

namespace weir::view {

namespace {

constexpr double film = 1e-3;  // of the deepest water: thinner films are shown as dry

struct Columns {
    vtkImageData* grid;
    vtkDataArray *bed, *depth;
    int nx, nz;
    double dx, dz, x0, z0;
    explicit Columns(vtkImageData* g) : grid(g), bed(g->GetCellData()->GetArray("bed")), depth(g->GetCellData()->GetArray("depth")) {
        const int* points = grid->GetDimensions();
        nx = points[0] - 1, nz = std::max(1, points[2] - 1);
        dx = grid->GetSpacing()[0], dz = grid->GetSpacing()[2], x0 = grid->GetOrigin()[0], z0 = grid->GetOrigin()[2];
    }
    vtkIdType at(int i, int k) const { return static_cast<vtkIdType>(k) * nx + i; }
    double ground(vtkIdType c) const { return bed->GetComponent(c, 0); }
    double top(vtkIdType c) const { return ground(c) + std::max(0.0, depth->GetComponent(c, 0)); }
};

/// A line of columns: an upright strip each, from `low` to `high`; `wanted` says of which.
template <class Low, class High, class Wanted>
vtkSmartPointer<vtkPolyData> strips(const Columns& c, vtkFloatArray* values, Low&& low, High&& high, Wanted&& wanted) {
    vtkNew<vtkPoints> points;
    vtkNew<vtkCellArray> cells;
    vtkNew<vtkFloatArray> shown;
    for (int i = 0; i < c.nx; ++i) {
        if (!wanted(i)) continue;
        const double x = c.x0 + i * c.dx;
        const vtkIdType corner[] = {points->InsertNextPoint(x, low(i), 0), points->InsertNextPoint(x + c.dx, low(i), 0),
                                    points->InsertNextPoint(x + c.dx, high(i), 0), points->InsertNextPoint(x, high(i), 0)};
        cells->InsertNextCell(4, corner);
        if (values) shown->InsertNextValue(values->GetValue(i));
    }
    auto surface = vtkSmartPointer<vtkPolyData>::New();
    surface->SetPoints(points);
    surface->SetPolys(cells);
    if (values) surface->GetCellData()->SetScalars(shown);
    return surface;
}

/// A plane of columns: a surface through their middles at a height, where all four columns about a piece are wanted.
template <class Height, class Wanted>
vtkSmartPointer<vtkPolyData> relief(const Columns& c, vtkFloatArray* values, Height&& height, Wanted&& wanted) {
    vtkNew<vtkPoints> points;
    vtkNew<vtkCellArray> cells;
    for (int k = 0; k < c.nz; ++k)
        for (int i = 0; i < c.nx; ++i) points->InsertNextPoint(c.x0 + (i + 0.5) * c.dx, height(c.at(i, k)), c.z0 + (k + 0.5) * c.dz);
    for (int k = 0; k + 1 < c.nz; ++k)
        for (int i = 0; i + 1 < c.nx; ++i) {
            const vtkIdType corner[] = {c.at(i, k), c.at(i, k + 1), c.at(i + 1, k + 1), c.at(i + 1, k)};
            if (std::any_of(std::begin(corner), std::end(corner), wanted)) cells->InsertNextCell(4, corner);
        }
    auto surface = vtkSmartPointer<vtkPolyData>::New();
    surface->SetPoints(points);
    surface->SetPolys(cells);
    if (values) surface->GetPointData()->SetScalars(values);
    vtkNew<vtkPolyDataNormals> normals;
    normals->SetInputData(surface);
    normals->SplittingOff();
    normals->Update();
    return normals->GetOutput();
}

}  // namespace

bool is_of_columns(const Frame& frame) {
    return frame.grid && frame.grid->GetDimensions()[1] == 2 && frame.grid->GetCellData()->HasArray("bed") &&
           frame.grid->GetCellData()->HasArray("depth");
}

void Stage::add_columns(const Frame& frame, const std::string& field) {
    const Columns c(frame.grid);
    const auto values = numbers_of_cells(frame, field);
    const double thin = film * c.depth->GetRange()[1];
    const auto wet = [&](vtkIdType at) { return c.depth->GetComponent(at, 0) > thin; };
    const auto any = [](vtkIdType) { return true; };
    const auto bed = [&](vtkIdType at) { return c.ground(at); };
    const auto top = [&](vtkIdType at) { return c.top(at); };
    const auto floor = [&](vtkIdType) { return std::min(domain_[2], c.bed->GetRange()[0]); };
    const bool flat = dim() == 2;
    const auto ground = flat ? strips(c, nullptr, floor, bed, any) : relief(c, nullptr, bed, any);
    const auto water = flat ? strips(c, values, bed, top, wet) : relief(c, values, top, wet);
    const auto shown = [&](vtkPolyData* surface, vtkDataSet* colours, const std::array<double, 3>& plain) {
        vtkNew<vtkPolyDataMapper> mapper;
        mapper->SetInputData(surface);
        colour(mapper, colours);
        vtkNew<vtkActor> actor;
        actor->SetMapper(mapper);
        actor->GetProperty()->SetColor(plain[0], plain[1], plain[2]);
        if (flat)
            actor->GetProperty()->LightingOff(), actor->SetPosition(0, 0, -0.5 * cell_);
        else
            actor->GetProperty()->SetSpecular(0.3);
        add(actor.Get());
    };
    shown(ground, nullptr, {0.60, 0.54, 0.43});
    shown(water, values ? water.Get() : nullptr, {0.16, 0.42, 0.66});
}

/// Each point is the middle of a box, with its extent beside it.
void Stage::add_boxes(vtkPolyData* points) {
    vtkDataArray* size = points->GetPointData()->GetArray("size");
    for (vtkIdType b = 0; b < points->GetNumberOfPoints(); ++b) {
        const double* at = points->GetPoint(b);
        vtkNew<vtkCubeSource> box;
        box->SetCenter(at[0], at[1], dim() == 2 ? cell_ : at[2]);
        box->SetXLength(size->GetComponent(b, 0));
        box->SetYLength(size->GetComponent(b, 1));
        box->SetZLength(dim() == 2 ? 0.1 * cell_ : size->GetComponent(b, 2));
        vtkNew<vtkPolyDataMapper> mapper;
        mapper->SetInputConnection(box->GetOutputPort());
        mapper->ScalarVisibilityOff();
        vtkNew<vtkActor> actor;
        actor->SetMapper(mapper);
        actor->GetProperty()->SetColor(0.71, 0.47, 0.25);
        if (dim() == 2) actor->GetProperty()->LightingOff();
        add(actor.Get());
    }
}

}  // namespace weir::view
