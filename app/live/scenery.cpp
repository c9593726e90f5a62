#include "app/live/scenery.hpp"

#include "app/picture/canvas.hpp"
#include "app/view/solid_mesh.hpp"

#include <vtkActor.h>
#include <vtkCamera.h>
#include <vtkCellArray.h>
#include <vtkColorTransferFunction.h>
#include <vtkFixedPointVolumeRayCastMapper.h>
#include <vtkFloatArray.h>
#include <vtkImageActor.h>
#include <vtkImageData.h>
#include <vtkImageProperty.h>
#include <vtkLookupTable.h>
#include <vtkOutlineSource.h>
#include <vtkPiecewiseFunction.h>
#include <vtkPointData.h>
#include <vtkPointGaussianMapper.h>
#include <vtkPoints.h>
#include <vtkPolyData.h>
#include <vtkPolyDataMapper.h>
#include <vtkProperty.h>
#include <vtkRegularPolygonSource.h>
#include <vtkRenderer.h>
#include <vtkScalarBarActor.h>
#include <vtkSphereSource.h>
#include <vtkTextActor.h>
#include <vtkTextProperty.h>
#include <vtkVolume.h>
#include <vtkVolumeProperty.h>

#include <algorithm>
#include <cmath>

namespace weir::live {

namespace {

constexpr int shades = 256;
constexpr double glare = 1 / 2.2;  // linear light as a screen wants it
constexpr std::array<double, 3> paper{0.965, 0.97, 0.98}, ink{0.13, 0.15, 0.19}, liquid{0.16, 0.42, 0.66};

std::array<double, 3> screen_colour(std::string_view map, real s) {
    const picture::Colour linear = picture::colour_of(map, s);
    std::array<double, 3> rgb{};
    for (std::size_t c = 0; c < 3; ++c) rgb[c] = std::pow(std::clamp(linear[static_cast<int>(c)], 0.0, 1.0), glare);
    return rgb;
}

}  // namespace

Scenery::Scenery(const scene::Scene& scene) : scene_(scene) {
    const auto cells = scene_.root().numbers("grid.cells"), size = scene_.root().numbers("grid.size"),
               origin = scene_.root().numbers("grid.origin");
    cell_ = infinity;
    for (std::size_t a = 0; a < static_cast<std::size_t>(scene_.dim()); ++a) {
        domain_[2 * a] = origin[a];
        domain_[2 * a + 1] = origin[a] + size[a];
        if (cells[a] > 1) cell_ = std::min(cell_, size[a] / cells[a]);
    }
    colours_->SetNumberOfTableValues(shades);
    renderer_->SetBackground(paper.data());
    for (const auto& solid : scene_.root().tables("solids")) has_solids_ = true, solids_move_ = solids_move_ || solid.has("motion");
    if (scene_.root().has("bodies") && !scene_.root().tables("bodies").empty()) has_solids_ = solids_move_ = true;
    add_outline();
    dim() == 2 ? add_sheet() : add_cloud();
    add_particles();
    add_columns();
    add_brush();
    add_texts();
}

Scenery::~Scenery() = default;

void Scenery::add_outline() {
    vtkNew<vtkOutlineSource> outline;
    outline->SetBounds(domain_.data());
    vtkNew<vtkPolyDataMapper> mapper;
    mapper->SetInputConnection(outline->GetOutputPort());
    vtkNew<vtkActor> actor;
    actor->SetMapper(mapper);
    actor->GetProperty()->SetColor(0.35, 0.38, 0.42);
    actor->GetProperty()->LightingOff();
    renderer_->AddActor(actor);
}

void Scenery::add_particles() {
    particle_places_->SetNumberOfComponents(3);
    vtkNew<vtkPoints> points;
    points->SetData(particle_places_);
    particles_->SetPoints(points);
    vtkNew<vtkPointGaussianMapper> mapper;
    mapper->SetInputData(particles_);
    mapper->SetScaleFactor(0.6 * (scene_.solver() == "mac_water" ? 0.5 : 1) * cell_);  // markers: two along a cell's side; particles: one
    mapper->EmissiveOff();
    mapper->SetSplatShaderCode(
        "//VTK::Color::Impl\n"
        "float dist2 = dot(offsetVCVSOutput.xy, offsetVCVSOutput.xy);\n"
        "if (dist2 > 1.0) discard;\n"
        "float shade = 0.55 + 0.45 * sqrt(1.0 - dist2);\n"
        "ambientColor *= shade;\n"
        "diffuseColor *= shade;\n");
    mapper->SetTriangleScale(1.8F);
    mapper->SetLookupTable(colours_);
    mapper->UseLookupTableScalarRangeOn();
    particle_actor_->SetMapper(mapper);
    particle_actor_->GetProperty()->SetColor(liquid[0], liquid[1], liquid[2]);
    particle_actor_->GetProperty()->LightingOff();
    renderer_->AddActor(particle_actor_);
}

void Scenery::set_particles(const Snapshot& s) {
    particle_actor_->SetVisibility(!s.points.empty());
    if (s.points.empty()) return;
    const auto count = static_cast<vtkIdType>(s.points.size() / 3);
    particle_places_->SetNumberOfTuples(count);
    std::copy(s.points.begin(), s.points.end(), particle_places_->GetPointer(0));
    particle_places_->Modified();
    const bool valued = !s.of_points.empty();
    if (valued) {
        particle_values_->SetNumberOfTuples(count);
        std::copy(s.of_points.begin(), s.of_points.end(), particle_values_->GetPointer(0));
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
    const bool shown = !s.of_cells.empty() && s.heights.empty();
    sheet_actor_->SetVisibility(shown);
    if (!shown) return;
    const auto& n = s.cells;
    if (sheet_->GetNumberOfPoints() != static_cast<vtkIdType>(s.of_cells.size())) {
        const auto h = [&](std::size_t a) { return (domain_[2 * a + 1] - domain_[2 * a]) / n[a]; };
        sheet_->SetDimensions(n[0], n[1], 1);
        sheet_->SetSpacing(h(0), h(1), 1);
        sheet_->SetOrigin(domain_[0] + 0.5 * h(0), domain_[2] + 0.5 * h(1), 0);
        sheet_->AllocateScalars(VTK_UNSIGNED_CHAR, 3);
        sheet_actor_->SetInputData(sheet_);
        sheet_actor_->SetPosition(0, 0, -0.5 * cell_);  // behind markers
    }
    auto* pixel = static_cast<unsigned char*>(sheet_->GetScalarPointer());
    for (const float v : s.of_cells) {
        const auto* rgb = colours_->MapValue(v);
        *pixel++ = rgb[0], *pixel++ = rgb[1], *pixel++ = rgb[2];
    }
    sheet_->Modified();
}

void Scenery::add_cloud() {
    volume_->GetProperty()->SetInterpolationTypeToLinear();
    volume_->GetProperty()->SetScalarOpacityUnitDistance(4 * cell_);
    volume_->VisibilityOff();
    renderer_->AddVolume(volume_);
}

void Scenery::set_cloud(const Snapshot& s) {
    const bool shown = !s.of_cells.empty() && s.heights.empty() && s.points.empty();
    volume_->SetVisibility(shown);
    if (!shown) return;
    const auto& n = s.cells;
    if (cloud_->GetNumberOfPoints() != static_cast<vtkIdType>(s.of_cells.size())) {
        const auto h = [&](std::size_t a) { return (domain_[2 * a + 1] - domain_[2 * a]) / n[a]; };
        cloud_->SetDimensions(n[0], n[1], n[2]);
        cloud_->SetSpacing(h(0), h(1), h(2));
        cloud_->SetOrigin(domain_[0] + 0.5 * h(0), domain_[2] + 0.5 * h(1), domain_[4] + 0.5 * h(2));
        cloud_->GetPointData()->SetScalars(cloud_values_);
        vtkNew<vtkFixedPointVolumeRayCastMapper> mapper;  // on the processor: as quick as a GPU's shader is slow without one
        mapper->SetInputData(cloud_);
        mapper->AutoAdjustSampleDistancesOff();
        mapper->SetImageSampleDistance(3);
        mapper->SetSampleDistance(static_cast<float>(cell_));
        volume_->SetMapper(mapper);
    }
    cloud_values_->SetNumberOfTuples(static_cast<vtkIdType>(s.of_cells.size()));
    std::copy(s.of_cells.begin(), s.of_cells.end(), cloud_values_->GetPointer(0));
    cloud_values_->Modified();
    cloud_->Modified();
}

void Scenery::add_columns() {
    vtkNew<vtkPoints> points;
    columns_->SetPoints(points);
    vtkNew<vtkPolyDataMapper> mapper;
    mapper->SetInputData(columns_);
    mapper->ScalarVisibilityOff();
    column_actor_->SetMapper(mapper);
    column_actor_->GetProperty()->SetColor(liquid[0], liquid[1], liquid[2]);
    column_actor_->GetProperty()->SetSpecular(0.4);
    column_actor_->GetProperty()->SetLineWidth(3);
    column_actor_->VisibilityOff();
    renderer_->AddActor(column_actor_);
}

void Scenery::set_columns(const Snapshot& s) {
    column_actor_->SetVisibility(!s.heights.empty());
    if (s.heights.empty()) return;
    const int nx = s.cells[0], nz = s.cells[2];
    const real hx = (domain_[1] - domain_[0]) / nx, hz = (domain_[5] - domain_[4]) / nz;
    vtkPoints* points = columns_->GetPoints();
    if (points->GetNumberOfPoints() != nx * nz) {
        points->SetNumberOfPoints(nx * nz);
        vtkNew<vtkCellArray> cells;
        if (nz == 1) {
            cells->InsertNextCell(nx);
            for (int i = 0; i < nx; ++i) cells->InsertCellPoint(i);
            columns_->SetLines(cells);
        } else {
            for (int k = 0; k + 1 < nz; ++k)
                for (int i = 0; i + 1 < nx; ++i) {
                    const vtkIdType at = static_cast<vtkIdType>(k) * nx + i, quad[4] = {at, at + nx, at + nx + 1, at + 1};
                    cells->InsertNextCell(4, quad);
                }
            columns_->SetPolys(cells);
        }
    }
    for (int k = 0; k < nz; ++k)
        for (int i = 0; i < nx; ++i)
            points->SetPoint(static_cast<vtkIdType>(k) * nx + i, domain_[0] + hx * (i + 0.5),
                             static_cast<double>(s.heights[static_cast<std::size_t>(k * nx + i)]),
                             nz == 1 ? 0 : domain_[4] + hz * (k + 0.5));
    points->Modified();
    columns_->Modified();
}

void Scenery::set_solids(const Snapshot& s) {
    const auto pose = [&](const char* field, std::size_t component, std::size_t body) { return s.bodies.at(field)[component][body]; };
    const auto mesh = view::solid_mesh(scene_, s.time, pose, domain_, cell_);
    if (!mesh) return;
    solids_->ShallowCopy(mesh);
    if (solid_actor_->GetMapper()) return;
    vtkNew<vtkPolyDataMapper> mapper;
    mapper->SetInputData(solids_);
    mapper->ScalarVisibilityOff();
    solid_actor_->SetMapper(mapper);
    solid_actor_->GetProperty()->SetColor(0.55, 0.57, 0.61);
    if (dim() == 2) solid_actor_->GetProperty()->LightingOff(), solid_actor_->SetPosition(0, 0, cell_);
    renderer_->AddActor(solid_actor_);
}

/// A ring of radius one, or a ball of wires.
void Scenery::add_brush() {
    vtkNew<vtkPolyDataMapper> mapper;
    if (dim() == 2) {
        vtkNew<vtkRegularPolygonSource> ring;
        ring->SetNumberOfSides(48);
        ring->SetRadius(1);
        ring->GeneratePolygonOff();
        mapper->SetInputConnection(ring->GetOutputPort());
    } else {
        vtkNew<vtkSphereSource> ball;
        ball->SetRadius(1);
        ball->SetThetaResolution(10);
        ball->SetPhiResolution(6);
        mapper->SetInputConnection(ball->GetOutputPort());
        brush_->GetProperty()->SetRepresentationToWireframe();
    }
    brush_->SetMapper(mapper);
    brush_->GetProperty()->LightingOff();
    brush_->GetProperty()->SetLineWidth(dim() == 2 ? 2 : 1);
    brush_->VisibilityOff();
    brush_->UseBoundsOff();
    renderer_->AddActor(brush_);
}

void Scenery::show_brush(const Vec<3>& centre, real radius, bool acts) {
    brush_->SetPosition(centre[0], centre[1], dim() == 2 ? 2 * cell_ : centre[2]);
    brush_->SetScale(radius);
    brush_->GetProperty()->SetColor(acts ? 0.85 : 0.3, acts ? 0.25 : 0.32, acts ? 0.1 : 0.36);
    brush_->VisibilityOn();
}

void Scenery::add_texts() {
    scale_->SetLookupTable(colours_);
    scale_->SetUnconstrainedFontSize(true);
    scale_->SetNumberOfLabels(5);
    scale_->SetLabelFormat("%.3g");
    scale_->SetVerticalTitleSeparation(12);
    scale_->SetPosition(0.87, 0.12);
    scale_->SetWidth(0.1);
    scale_->SetHeight(0.7);
    for (auto* style :
         {scale_->GetLabelTextProperty(), scale_->GetTitleTextProperty(), figures_->GetTextProperty(), help_->GetTextProperty()}) {
        style->SetColor(ink.data());
        style->SetFontSize(14);
        style->ItalicOff();
        style->ShadowOff();
        style->BoldOff();
    }
    for (auto* text : {figures_->GetTextProperty(), help_->GetTextProperty()}) {  // over whatever colour lies behind them
        text->SetBackgroundColor(const_cast<double*>(paper.data()));
        text->SetBackgroundOpacity(0.7);
    }
    figures_->SetPosition(12, 10);
    help_->GetPositionCoordinate()->SetCoordinateSystemToNormalizedViewport();
    help_->GetPositionCoordinate()->SetValue(0.02, 0.97);
    help_->GetTextProperty()->SetVerticalJustificationToTop();
    renderer_->AddActor2D(scale_);
    renderer_->AddActor2D(figures_);
    renderer_->AddActor2D(help_);
}

void Scenery::tell(const std::string& figures, const std::string& help) {
    figures_->SetInput(figures.c_str());
    help_->SetInput(help.c_str());
    help_->SetVisibility(!help.empty());
}

/// The scale only grows, so that colours keep their meaning from frame to frame, until another field is shown.
void Scenery::set_colours(const Snapshot& s) {
    if (s.field != field_) field_ = s.field, low_ = infinity, high_ = -infinity;
    real low = low_, high = high_;
    for (const auto* list : {&s.of_points, &s.of_cells})
        if (!list->empty()) {
            const auto [least, most] = std::minmax_element(list->begin(), list->end());
            low = std::min<real>(low, *least), high = std::max<real>(high, *most);
        }
    scale_->SetVisibility(low <= high);
    if (!(low <= high) || (low == low_ && high == high_)) return;
    low_ = low, high_ = high;
    const bool both_signs = low_ < 0 && high_ > 0;
    if (both_signs) high_ = std::max(high_, -low_), low_ = -high_;
    const std::string_view map = both_signs ? "coolwarm" : field_ == "temperature" ? "inferno" : "viridis";
    vtkNew<vtkColorTransferFunction> colour;
    vtkNew<vtkPiecewiseFunction> opacity;
    for (int i = 0; i < shades; ++i) {
        const real at = i / (shades - 1.0);
        const auto rgb = screen_colour(map, at);
        colours_->SetTableValue(i, rgb[0], rgb[1], rgb[2]);
        if (i % 16 == 15 || i == 0) {
            colour->AddRGBPoint(low_ + (high_ - low_) * at, rgb[0], rgb[1], rgb[2]);
            opacity->AddPoint(low_ + (high_ - low_) * at, 0.6 * (low_ < 0 ? std::abs(2 * at - 1) : at));
        }
    }
    volume_->GetProperty()->SetColor(colour);
    volume_->GetProperty()->SetScalarOpacity(opacity);
    colours_->SetTableRange(low_, std::max(high_, low_ + 1e-12 * std::max(1.0, std::abs(low_))));
    scale_->SetTitle((field_ == "speed" ? "speed [m/s]" : field_).c_str());
}

void Scenery::show(const Snapshot& s) {
    set_colours(s);
    set_particles(s);
    dim() == 2 ? set_sheet(s) : set_cloud(s);
    set_columns(s);
    if (solids_move_ || (has_solids_ && !solid_actor_->GetMapper())) set_solids(s);
    renderer_->ResetCameraClippingRange(domain_.data());
}

void Scenery::look_at_all() {
    const auto middle = [&](std::size_t a) { return 0.5 * (domain_[2 * a] + domain_[2 * a + 1]); };
    vtkCamera* camera = renderer_->GetActiveCamera();
    camera->SetFocalPoint(middle(0), middle(1), middle(2));
    camera->SetViewUp(0, 1, 0);
    const bool flat = dim() == 2;
    camera->SetParallelProjection(flat);
    camera->SetPosition(middle(0) + (flat ? 0 : 0.45), middle(1) + (flat ? 0 : 0.42), middle(2) + 1);
    renderer_->ResetCamera(domain_.data());
    const bool wide = domain_[1] - domain_[0] > 1.6 * (domain_[3] - domain_[2]);
    if (flat && !wide) camera->Zoom(1.2);  // room is left for a turn that a flat picture does not take, and for the scale
}

}  // namespace weir::live
