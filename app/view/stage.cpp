#include "app/view/stage.hpp"

#include "app/picture/canvas.hpp"
#include "rigid/bodies.hpp"

#include <vtkActor.h>
#include <vtkCamera.h>
#include <vtkDataSetMapper.h>
#include <vtkImageData.h>
#include <vtkLookupTable.h>
#include <vtkPointData.h>
#include <vtkPointGaussianMapper.h>
#include <vtkPolyDataMapper.h>
#include <vtkProperty.h>
#include <vtkRenderer.h>
#include <vtkScalarBarActor.h>
#include <vtkTextActor.h>
#include <vtkTextProperty.h>

#include <algorithm>
#include <cmath>

namespace weir::view {

namespace {

constexpr int shades = 256;
constexpr double glare = 1 / 2.2;  // linear light as a screen wants it
constexpr std::array<double, 3> paper{0.965, 0.97, 0.98}, ink{0.13, 0.15, 0.19};

std::array<double, 3> screen_colour(std::string_view map, real s) {
    const picture::Colour linear = picture::colour_of(map, s);
    std::array<double, 3> rgb{};
    for (std::size_t c = 0; c < 3; ++c) rgb[c] = std::pow(std::clamp(linear[static_cast<int>(c)], 0.0, 1.0), glare);
    return rgb;
}

std::string title_of(const std::string& field) { return field == "speed" ? "speed [m/s]" : field; }

}  // namespace

Stage::Stage(scene::Scene scene) : scene_(std::move(scene)) {
    const auto cells = scene_.root().numbers("grid.cells"), size = scene_.root().numbers("grid.size"),
               origin = scene_.root().numbers("grid.origin");
    cell_ = infinity;
    for (std::size_t a = 0; a < static_cast<std::size_t>(scene_.dim()); ++a) {
        domain_[2 * a] = origin[a];
        domain_[2 * a + 1] = origin[a] + size[a];
        cell_ = std::min(cell_, size[a] / cells[a]);
    }
    colours_->SetNumberOfTableValues(shades);
    scale_->SetLookupTable(colours_);
    scale_->SetUnconstrainedFontSize(true);
    scale_->SetNumberOfLabels(5);
    scale_->SetLabelFormat("%.3g");
    scale_->SetVerticalTitleSeparation(12);
    scale_->SetPosition(0.87, 0.12);
    scale_->SetWidth(0.1);
    scale_->SetHeight(0.7);
    for (auto* style : {scale_->GetLabelTextProperty(), scale_->GetTitleTextProperty(), text_->GetTextProperty()}) {
        style->SetColor(ink.data());
        style->SetFontSize(14);
        style->ItalicOff();
        style->ShadowOff();
        style->BoldOff();
    }
    text_->SetPosition(12, 10);
    renderer_->SetBackground(paper.data());
    renderer_->AddActor2D(scale_);
    renderer_->AddActor2D(text_);
    add_outline();
}

Stage::~Stage() = default;

void Stage::show(const Frame& frame, const std::string& field, Show what) {
    for (const auto& prop : props_) renderer_->RemoveViewProp(prop);
    props_.clear();
    const bool sheet = std::any_of(frame.particles.begin(), frame.particles.end(),
                                   [](const auto& set) { return set.second->GetNumberOfPolys() > 0; });  // the grid is one layer of cells
    const bool columns = is_of_columns(frame);  // their particles are what floats in them
    const bool grid = frame.grid && !sheet && (columns || what != Show::particles || frame.particles.empty());
    if (grid) columns ? add_columns(frame, field) : dim() == 2 ? add_sheet(frame, field) : add_cloud(frame, field);
    if (what != Show::grid || !grid || columns)
        for (const auto& [set, points] : frame.particles)
            if (set != rigid::body_set_name) add_particles(frame, points, field);
    set_colours(field);
    add_solids(frame);
    scale_->SetVisibility(low_ <= high_);
    renderer_->ResetCameraClippingRange();
}

void Stage::forget_range() { low_ = infinity, high_ = -infinity; }

void Stage::look_at_all() {
    const auto middle = [&](int a) {
        return 0.5 * (domain_[static_cast<std::size_t>(2 * a)] + domain_[static_cast<std::size_t>(2 * a + 1)]);
    };
    vtkCamera* camera = renderer_->GetActiveCamera();
    camera->SetFocalPoint(middle(0), middle(1), middle(2));
    camera->SetViewUp(0, 1, 0);
    const bool flat = dim() == 2;
    camera->SetParallelProjection(flat);
    camera->SetPosition(middle(0) + (flat ? 0 : 0.45), middle(1) + (flat ? 0 : 0.42), middle(2) + 1);
    renderer_->ResetCamera(domain_.data());
    if (flat) camera->Zoom(1.2);  // room is left for a turn that a flat picture does not take
}

void Stage::tell(const std::string& text) { text_->SetInput(text.c_str()); }

void Stage::add(vtkSmartPointer<vtkProp> prop) {
    renderer_->AddViewProp(prop);
    props_.push_back(std::move(prop));
}

void Stage::widen(vtkDataSet* shown) {
    double range[2];
    shown->GetScalarRange(range);
    if (!(range[0] <= range[1])) return;
    low_ = std::min(low_, range[0]);
    high_ = std::max(high_, range[1]);
}

void Stage::set_colours(const std::string& field) {
    if (low_ > high_) return;
    const bool both_signs = low_ < 0 && high_ > 0;
    if (both_signs) high_ = std::max(high_, -low_), low_ = -high_;
    const std::string_view map = both_signs ? "coolwarm" : field == "temperature" ? "inferno" : "viridis";
    for (int i = 0; i < shades; ++i) {
        const auto rgb = screen_colour(map, i / (shades - 1.0));
        colours_->SetTableValue(i, rgb[0], rgb[1], rgb[2]);
    }
    colours_->SetTableRange(low_, std::max(high_, low_ + 1e-12 * std::max(1.0, std::abs(low_))));
    scale_->SetTitle(title_of(field).c_str());
}

void Stage::colour(vtkMapper* mapper, vtkDataSet* shown) {
    if (!shown) return mapper->ScalarVisibilityOff();
    widen(shown);
    mapper->SetLookupTable(colours_);
    mapper->UseLookupTableScalarRangeOn();
}

void Stage::add_particles(const Frame& frame, vtkPolyData* points, const std::string& field) {
    if (points->GetNumberOfPoints() == 0) return;
    if (points->GetPointData()->HasArray("size")) return add_boxes(points);
    if (points->GetNumberOfPolys() + points->GetNumberOfLines() > 0) return add_surface(frame, points, field);
    const auto shown = coloured(points, frame, field);
    vtkNew<vtkPointGaussianMapper> mapper;
    mapper->SetInputData(shown ? vtkPolyData::SafeDownCast(shown) : points);
    mapper->SetScaleFactor(0.6 * (frame.grid ? 0.5 : 1) * cell_);  // markers: two along a cell's side; particles: one
    mapper->EmissiveOff();
    mapper->SetSplatShaderCode(
        "//VTK::Color::Impl\n"
        "float dist2 = dot(offsetVCVSOutput.xy, offsetVCVSOutput.xy);\n"
        "if (dist2 > 1.0) discard;\n"
        "float shade = 0.55 + 0.45 * sqrt(1.0 - dist2);\n"
        "ambientColor *= shade;\n"
        "diffuseColor *= shade;\n");
    mapper->SetTriangleScale(1.8F);
    vtkNew<vtkActor> actor;
    actor->SetMapper(mapper);
    actor->GetProperty()->SetColor(0.16, 0.42, 0.66);
    actor->GetProperty()->LightingOff();
    colour(mapper, shown);
    add(actor.Get());
}

void Stage::add_surface(const Frame& frame, vtkPolyData* surface, const std::string& field) {
    const auto shown = coloured(surface, frame, field);
    vtkNew<vtkPolyDataMapper> mapper;
    mapper->SetInputData(shown ? vtkPolyData::SafeDownCast(shown) : surface);
    vtkNew<vtkActor> actor;
    actor->SetMapper(mapper);
    actor->GetProperty()->SetColor(0.16, 0.42, 0.66);
    actor->GetProperty()->SetSpecular(0.4);
    actor->GetProperty()->SetLineWidth(3);
    colour(mapper, shown);
    add(actor.Get());
}

void Stage::add_sheet(const Frame& frame, const std::string& field) {
    const auto shown = coloured(frame.grid, frame, field);
    if (!shown) return;
    vtkNew<vtkDataSetMapper> mapper;
    mapper->SetInputData(shown);
    colour(mapper, shown);
    mapper->InterpolateScalarsBeforeMappingOn();
    vtkNew<vtkActor> actor;
    actor->SetMapper(mapper);
    actor->GetProperty()->LightingOff();
    actor->SetPosition(0, 0, -0.5 * cell_);  // behind markers
    add(actor.Get());
}

}  // namespace weir::view
