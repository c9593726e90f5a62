// How a session's window shows the fluid: particles, cells, columns, liquids within a level set, surfaces of points in rows.
#include "app/live/scenery.hpp"

#include <vtkActor.h>
#include <vtkCamera.h>
#include <vtkCellArray.h>
#include <vtkFixedPointVolumeRayCastMapper.h>
#include <vtkFloatArray.h>
#include <vtkImageActor.h>
#include <vtkImageData.h>
#include <vtkImageProperty.h>
#include <vtkLookupTable.h>
#include <vtkPointData.h>
#include <vtkPointGaussianMapper.h>
#include <vtkPoints.h>
#include <vtkPolyData.h>
#include <vtkPolyDataMapper.h>
#include <vtkPolyDataNormals.h>
#include <vtkProperty.h>
#include <vtkRenderer.h>
#include <vtkVolume.h>
#include <vtkVolumeProperty.h>

#include <algorithm>
#include <numeric>

namespace weir::live {

namespace {

constexpr int slices = 512;  // of a view, by which particles are drawn: under a spacing where fewer than 512 stand behind each other

/// An image whose points are the middles of the grid's cells.
void set_lattice(vtkImageData* image, const view::Domain& domain, const std::array<int, 3>& n) {
    double spacing[3]{1, 1, 1}, origin[3]{};
    for (std::size_t a = 0; a < static_cast<std::size_t>(domain.dim); ++a) {
        spacing[a] = (domain.box[2 * a + 1] - domain.box[2 * a]) / n[a];
        origin[a] = domain.box[2 * a] + 0.5 * spacing[a];
    }
    image->SetDimensions(n[0], n[1], domain.flat() ? 1 : n[2]);
    image->SetSpacing(spacing);
    image->SetOrigin(origin);
}

}  // namespace

void Scenery::add_particles() {
    particle_places_->SetNumberOfComponents(3);
    vtkNew<vtkPoints> points;
    points->SetData(particle_places_);
    particles_->SetPoints(points);
    const auto mapper = view::splats(domain_, scene_.solver() == "mac_water");
    mapper->SetInputData(particles_);
    scale_.colour(mapper);
    particle_actor_->SetMapper(mapper);
    view::paint_splats(particle_actor_);
    renderer_->AddActor(particle_actor_);
}

/// In 3D the nearest first: what lies behind them then fails the test of depth before it is shaded. The picture is the same in any order,
/// so that slices of the view are near enough, and those of the last time where the camera alone has moved. Flat ones as they are: all
/// are as near, and the last one drawn is seen.
void Scenery::order_particles(const Snapshot& s) {
    const std::size_t count = s.points.size() / 3;
    order_.resize(count);
    std::iota(order_.begin(), order_.end(), 0);
    if (domain_.flat() || count == 0) return;
    double to[3];
    renderer_->GetActiveCamera()->GetDirectionOfProjection(to);
    const auto along = [&](std::size_t i) { return s.points[3 * i] * to[0] + s.points[3 * i + 1] * to[1] + s.points[3 * i + 2] * to[2]; };
    double least = infinity, most = -infinity;
    for (std::size_t i = 0; i < count; ++i) least = std::min(least, along(i)), most = std::max(most, along(i));
    const double per_metre = (slices - 1) / std::max(most - least, 1e-30);
    depth_.resize(count);
    std::array<int, slices + 1> start{};
    for (std::size_t i = 0; i < count; ++i) {
        depth_[i] = std::clamp(static_cast<int>((along(i) - least) * per_metre), 0, slices - 1);
        ++start[static_cast<std::size_t>(depth_[i]) + 1];
    }
    std::partial_sum(start.begin(), start.end(), start.begin());
    for (std::size_t i = 0; i < count; ++i)
        order_[static_cast<std::size_t>(start[static_cast<std::size_t>(depth_[i])]++)] = static_cast<int>(i);
}

void Scenery::set_particles(const Snapshot& s) {
    const bool shown = !s.points.empty() && s.sheet[0] == 0;
    particle_actor_->SetVisibility(shown);
    if (!shown) return;
    const auto count = static_cast<vtkIdType>(s.points.size() / 3);
    order_particles(s);
    particle_places_->SetNumberOfTuples(count);
    float* place = particle_places_->GetPointer(0);
    for (const int i : order_) place = std::copy_n(s.points.begin() + 3 * static_cast<std::ptrdiff_t>(i), 3, place);
    particle_places_->Modified();
    const bool valued = !s.of_points.empty();
    if (valued) {
        particle_values_->SetNumberOfTuples(count);
        float* value = particle_values_->GetPointer(0);
        for (const int i : order_) *value++ = s.of_points[static_cast<std::size_t>(i)];
        particle_values_->Modified();
    }
    particles_->GetPointData()->SetScalars(valued ? particle_values_.Get() : nullptr);
    particle_actor_->GetMapper()->SetScalarVisibility(valued);
    particles_->GetPoints()->Modified();
    particles_->Modified();
}

void Scenery::add_sheet() {
    sheet_actor_->SetInterpolate(true);
    sheet_actor_->VisibilityOff();
    renderer_->AddActor(sheet_actor_);
}

void Scenery::set_sheet(const Snapshot& s) {
    sheet_actor_->SetVisibility(s.grid_shown());
    if (!s.grid_shown()) return;
    if (sheet_->GetNumberOfPoints() != static_cast<vtkIdType>(s.of_cells.size())) {
        set_lattice(sheet_, domain_, s.cells);
        sheet_->AllocateScalars(VTK_UNSIGNED_CHAR, 3);
        sheet_actor_->SetInputData(sheet_);
        sheet_actor_->SetPosition(0, 0, -0.5 * cell());  // behind markers
    }
    auto* pixel = static_cast<unsigned char*>(sheet_->GetScalarPointer());
    for (const float v : s.of_cells) {
        const auto* rgb = scale_.table()->MapValue(v);
        *pixel++ = rgb[0], *pixel++ = rgb[1], *pixel++ = rgb[2];
    }
    sheet_->Modified();
}

void Scenery::add_cloud() {
    volume_->GetProperty()->SetInterpolationTypeToLinear();
    volume_->GetProperty()->SetScalarOpacityUnitDistance(4 * cell());
    volume_->VisibilityOff();
    renderer_->AddVolume(volume_);
}

void Scenery::set_cloud(const Snapshot& s) {
    const bool shown = s.grid_shown() && s.points.empty();
    volume_->SetVisibility(shown);
    if (!shown) return;
    if (cloud_->GetNumberOfPoints() != static_cast<vtkIdType>(s.of_cells.size())) {
        set_lattice(cloud_, domain_, s.cells);
        cloud_->GetPointData()->SetScalars(cloud_values_);
        vtkNew<vtkFixedPointVolumeRayCastMapper> mapper;  // on the processor: as quick as a GPU's shader is slow without one
        mapper->SetInputData(cloud_);
        mapper->AutoAdjustSampleDistancesOff();
        mapper->SetImageSampleDistance(3);
        mapper->SetSampleDistance(static_cast<float>(cell()));
        volume_->SetMapper(mapper);
    }
    cloud_values_->SetNumberOfTuples(static_cast<vtkIdType>(s.of_cells.size()));
    std::copy(s.of_cells.begin(), s.of_cells.end(), cloud_values_->GetPointer(0));
    cloud_values_->Modified();
    cloud_->Modified();
}

void Scenery::add_meshes() {
    view::paint_solids(solids_.actor, domain_);
    view::paint_columns(ground_.actor, domain_, view::ground_colour);
    view::paint_columns(water_.actor, domain_, view::liquid_colour);
    view::paint_liquid(rows_.actor);
    view::paint_boxes(boxes_.actor, domain_);
    lines_.actor->GetProperty()->SetColor(view::ink[0], view::ink[1], view::ink[2]);
    lines_.actor->GetProperty()->LightingOff();
    for (const Mesh* mesh : {&solids_, &ground_, &water_, &lines_, &rows_, &boxes_}) renderer_->AddActor(mesh->actor);
}

/// Columns on their ground, or what a level set bounds and the tall cells that it was solved on.
void Scenery::set_water(const Snapshot& s) {
    const bool columns = s.columns.nx > 0, level = !s.level.phi.empty(), coloured = !s.of_cells.empty();
    ground_.show(columns ? view::ground_mesh(s.columns, domain_).Get() : nullptr);
    if (columns)
        water_.show(view::water_mesh(s.columns, domain_), coloured ? &scale_ : nullptr);
    else
        water_.show(level ? view::liquid_mesh(s.level, domain_).Get() : nullptr, coloured ? &scale_ : nullptr);
    lines_.show(level && !s.level.heights.empty() ? view::cell_lines(s.level, domain_).Get() : nullptr);
}

/// A surface through points that stand in rows: a line where there is one row.
void Scenery::set_rows(const Snapshot& s) {
    if (s.sheet[0] == 0) return rows_.show(nullptr);
    vtkNew<vtkPoints> points;
    for (std::size_t i = 0; i < s.points.size(); i += 3) points->InsertNextPoint(s.points[i], s.points[i + 1], s.points[i + 2]);
    vtkNew<vtkCellArray> cells;
    vtkNew<vtkPolyData> mesh;
    mesh->SetPoints(points);
    const int nx = s.sheet[0], nz = s.sheet[1];
    if (nz == 1) {
        cells->InsertNextCell(nx);
        for (int i = 0; i < nx; ++i) cells->InsertCellPoint(i);
        mesh->SetLines(cells);
    }
    for (int k = 0; k + 1 < nz; ++k)
        for (int i = 0; i + 1 < nx; ++i) {
            const vtkIdType at = static_cast<vtkIdType>(k) * nx + i, quad[4] = {at, at + nx, at + nx + 1, at + 1};
            cells->InsertNextCell(4, quad);
        }
    if (nz > 1) mesh->SetPolys(cells);
    const bool coloured = !s.of_points.empty();
    if (coloured) {
        vtkNew<vtkFloatArray> values;
        for (const float v : s.of_points) values->InsertNextValue(v);
        mesh->GetPointData()->SetScalars(values);
    }
    if (nz == 1) return rows_.show(mesh, coloured ? &scale_ : nullptr);
    vtkNew<vtkPolyDataNormals> smooth;
    smooth->SetInputData(mesh);
    smooth->SplittingOff();
    smooth->Update();
    rows_.show(smooth->GetOutput(), coloured ? &scale_ : nullptr);
}

}  // namespace weir::live
