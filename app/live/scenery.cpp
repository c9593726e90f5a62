#include "app/live/scenery.hpp"

#include "app/view/solid_mesh.hpp"

#include <vtkActor.h>
#include <vtkFloatArray.h>
#include <vtkImageActor.h>
#include <vtkImageData.h>
#include <vtkPolyData.h>
#include <vtkPolyDataMapper.h>
#include <vtkProperty.h>
#include <vtkRegularPolygonSource.h>
#include <vtkRenderer.h>
#include <vtkSphereSource.h>
#include <vtkTextActor.h>
#include <vtkTextProperty.h>
#include <vtkVolume.h>

#include <algorithm>
#include <cmath>

namespace weir::live {

Mesh::Mesh() {
    actor->SetMapper(mapper);
    actor->VisibilityOff();
}

void Mesh::show(vtkPolyData* mesh, view::Scale* coloured) {
    actor->SetVisibility(mesh && mesh->GetNumberOfCells() > 0);
    if (!mesh) return;
    mapper->SetInputData(mesh);
    mapper->SetScalarVisibility(coloured != nullptr);
    if (coloured) coloured->colour(mapper);
}

Scenery::Scenery(const scene::Scene& scene) : scene_(scene), domain_(scene) {
    renderer_->SetBackground(view::paper[0], view::paper[1], view::paper[2]);
    for (const auto& solid : scene_.root().tables("solids")) solids_are_missing_ = true, solids_move_ |= solid.has("motion");
    if (scene_.root().has("bodies") && !scene_.root().tables("bodies").empty()) solids_move_ = true;
    renderer_->AddActor(view::outline(domain_));
    dim() == 2 ? add_sheet() : add_cloud();
    add_particles();
    add_meshes();
    add_brush();
    add_texts();
}

Scenery::~Scenery() = default;

void Scenery::set_solids(const Snapshot& s) {
    if (!solids_move_ && !solids_are_missing_) return;
    solids_are_missing_ = false;
    const auto pose = [&](const char* field, std::size_t component, std::size_t body) { return s.bodies.at(field)[component][body]; };
    solids_.show(view::solid_mesh(scene_, s.time, pose, domain_.box, cell()));
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
    brush_->SetPosition(centre[0], centre[1], dim() == 2 ? 2 * cell() : centre[2]);
    brush_->SetScale(radius);
    brush_->GetProperty()->SetColor(acts ? 0.85 : 0.3, acts ? 0.25 : 0.32, acts ? 0.1 : 0.36);
    brush_->VisibilityOn();
}

void Scenery::add_texts() {
    for (vtkTextActor* text : {figures_.Get(), help_.Get()}) {
        view::set_style(text);
        auto paper = view::paper;  // over whatever colour lies behind them
        text->GetTextProperty()->SetBackgroundColor(paper.data());
        text->GetTextProperty()->SetBackgroundOpacity(0.7);
    }
    figures_->SetPosition(12, 10);
    help_->GetPositionCoordinate()->SetCoordinateSystemToNormalizedViewport();
    help_->GetPositionCoordinate()->SetValue(0.02, 0.97);
    help_->GetTextProperty()->SetVerticalJustificationToTop();
    scale_.join(renderer_);
    renderer_->AddActor2D(figures_);
    renderer_->AddActor2D(help_);
}

void Scenery::tell(const std::string& figures, const std::string& help) {
    const int* size = renderer_->GetSize();
    figures_->SetInput(view::wrapped(figures, size[0] - 24).c_str());
    help_->SetInput(help.c_str());
    help_->SetVisibility(!help.empty());
    double box[4];  // of the text, from its corner [pixels]
    figures_->GetBoundingBox(renderer_, box);
    scale_.place(size[0], size[1], static_cast<int>(10 + box[3] + 16));  // and half a line between them
    help_->GetBoundingBox(renderer_, box);
    bar_hidden_ = !help.empty() && 0.02 * size[0] + box[1] > size[0] - view::bar_room;  // a narrow window: keys alone
    scale_.show(!scale_.empty() && !bar_hidden_);
}

void Scenery::set_colours(const Snapshot& s) {
    if (s.field != field_) field_ = s.field, scale_.forget();
    for (const auto* list : {&s.of_points, &s.of_cells})
        if (!list->empty()) {
            const auto [least, most] = std::minmax_element(list->begin(), list->end());
            scale_.widen(*least, *most);
        }
    scale_.show(!scale_.empty() && !bar_hidden_);
    if (scale_.set(field_)) scale_.colour(volume_->GetProperty());
}

void Scenery::show(const Snapshot& s) {
    set_colours(s);
    set_particles(s);
    dim() == 2 ? set_sheet(s) : set_cloud(s);
    set_water(s);
    set_rows(s);
    set_solids(s);
    boxes_.show(s.boxes.empty() ? nullptr : view::mesh_of(s.boxes, domain_).Get());
    auto bounds = domain_.box;
    renderer_->ResetCameraClippingRange(bounds.data());
}

}  // namespace weir::live
