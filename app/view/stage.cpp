#include "app/view/stage.hpp"

#include "rigid/bodies.hpp"

#include <vtkActor.h>
#include <vtkDataSetMapper.h>
#include <vtkImageData.h>
#include <vtkPointData.h>
#include <vtkPointGaussianMapper.h>
#include <vtkPolyDataMapper.h>
#include <vtkProperty.h>
#include <vtkRenderer.h>
#include <vtkTextActor.h>

#include <algorithm>

namespace weir::view {

Stage::Stage(scene::Scene scene) : scene_(std::move(scene)), domain_(scene_) {
    set_style(text_);
    text_->SetPosition(12, 10);
    renderer_->SetBackground(paper[0], paper[1], paper[2]);
    scale_.join(renderer_);
    renderer_->AddActor2D(text_);
    renderer_->AddActor(outline(domain_));
}

Stage::~Stage() = default;

void Stage::show(const Frame& frame, const std::string& field, Show what) {
    for (const auto& prop : props_) renderer_->RemoveViewProp(prop);
    props_.clear();
    const bool sheet = std::any_of(frame.particles.begin(), frame.particles.end(),
                                   [](const auto& set) { return set.second->GetNumberOfPolys() > 0; });  // the grid is one layer of cells
    const bool columns = is_of_columns(frame);  // their particles are what floats in them
    const bool grid = frame.grid && !sheet && (columns || what != Show::particles || frame.particles.empty());
    if (columns)
        add_columns(frame, field);
    else if (is_of_liquid(frame))
        add_liquid(frame, field, what);
    else if (grid)
        dim() == 2 ? add_sheet(frame, field) : add_cloud(frame, field);
    if (what != Show::grid || !grid || columns)
        for (const auto& [set, points] : frame.particles)
            if (set != rigid::body_set_name) add_particles(frame, points, field);
    scale_.set(field);
    add_solids(frame);
    scale_.show(!scale_.empty());
    renderer_->ResetCameraClippingRange();
}

void Stage::tell(const std::string& text) {
    const int* size = renderer_->GetSize();
    text_->SetInput(wrapped(text, size[0] - 24).c_str());
    scale_.place(size[0], size[1], 0);
}

void Stage::add(vtkSmartPointer<vtkProp> prop) {
    renderer_->AddViewProp(prop);
    props_.push_back(std::move(prop));
}

void Stage::widen(vtkDataSet* shown) {
    double range[2];
    shown->GetScalarRange(range);
    scale_.widen(range[0], range[1]);
}

void Stage::colour(vtkMapper* mapper, vtkDataSet* shown) {
    if (!shown) return mapper->ScalarVisibilityOff();
    widen(shown);
    scale_.colour(mapper);
}

void Stage::add_particles(const Frame& frame, vtkPolyData* points, const std::string& field) {
    if (points->GetNumberOfPoints() == 0) return;
    if (points->GetPointData()->HasArray("size")) return add_boxes(points);
    if (points->GetNumberOfPolys() + points->GetNumberOfLines() > 0) return add_surface(frame, points, field);
    const auto shown = coloured(points, frame, field);
    const auto mapper = splats(domain_, frame.grid != nullptr);
    mapper->SetInputData(shown ? vtkPolyData::SafeDownCast(shown) : points);
    vtkNew<vtkActor> actor;
    actor->SetMapper(mapper);
    paint_splats(actor);
    colour(mapper, shown);
    add(actor.Get());
}

void Stage::add_surface(const Frame& frame, vtkPolyData* surface, const std::string& field) {
    const auto shown = coloured(surface, frame, field);
    vtkNew<vtkPolyDataMapper> mapper;
    mapper->SetInputData(shown ? vtkPolyData::SafeDownCast(shown) : surface);
    vtkNew<vtkActor> actor;
    actor->SetMapper(mapper);
    paint_liquid(actor);
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
    actor->SetPosition(0, 0, -0.5 * domain_.cell);  // behind markers
    add(actor.Get());
}

}  // namespace weir::view
