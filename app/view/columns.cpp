// What the viewer's stage shows of water that no particles stand for: columns on their ground, boxes that float in them, and the inside of
// a level set, with the tall cells that it was solved on.
#include "app/view/stage.hpp"
#include "app/view/water.hpp"

#include <vtkActor.h>
#include <vtkCellData.h>
#include <vtkDataArray.h>
#include <vtkFloatArray.h>
#include <vtkImageData.h>
#include <vtkPointData.h>
#include <vtkPolyDataMapper.h>
#include <vtkProperty.h>

#include <algorithm>

namespace weir::view {

namespace {

std::vector<float> numbers(vtkDataArray* array) {
    std::vector<float> list;
    for (vtkIdType i = 0; array && i < array->GetNumberOfTuples(); ++i) list.push_back(static_cast<float>(array->GetComponent(i, 0)));
    return list;
}

std::vector<float> numbers(const Frame& frame, const char* field) { return numbers(frame.grid->GetCellData()->GetArray(field)); }

}  // namespace

bool is_of_columns(const Frame& frame) {
    return frame.grid && frame.grid->GetDimensions()[1] == 2 && frame.grid->GetCellData()->HasArray("bed") &&
           frame.grid->GetCellData()->HasArray("depth");
}

bool is_of_liquid(const Frame& frame) {
    return frame.grid && frame.grid->GetCellData()->HasArray(level_set_name) && frame.particles.empty();
}

void Stage::add_mesh(vtkPolyData* mesh, bool coloured, const std::function<void(vtkActor*)>& paint) {
    vtkNew<vtkPolyDataMapper> mapper;
    mapper->SetInputData(mesh);
    colour(mapper, coloured ? mesh : nullptr);
    vtkNew<vtkActor> actor;
    actor->SetMapper(mapper);
    paint(actor);
    add(actor.Get());
}

void Stage::add_columns(const Frame& frame, const std::string& field) {
    const int* points = frame.grid->GetDimensions();
    const double *spacing = frame.grid->GetSpacing(), *origin = frame.grid->GetOrigin();
    const Columns columns{points[0] - 1,
                          std::max(1, points[2] - 1),
                          spacing[0],
                          spacing[2],
                          origin[0],
                          origin[2],
                          numbers(frame, "bed"),
                          numbers(frame, "depth"),
                          numbers(numbers_of_cells(frame, field))};
    add_mesh(ground_mesh(columns, domain_), false, [&](vtkActor* actor) { paint_columns(actor, domain_, ground_colour); });
    add_mesh(water_mesh(columns, domain_), !columns.values.empty(), [&](vtkActor* actor) { paint_columns(actor, domain_, liquid_colour); });
}

void Stage::add_liquid(const Frame& frame, const std::string& field, Show what) {
    const int* points = frame.grid->GetDimensions();
    Level level;
    level.phi = numbers(frame, level_set_name), level.values = numbers(numbers_of_cells(frame, field));
    for (std::size_t a = 0; a < 3; ++a) {
        level.cells[a] = std::max(1, points[a] - 1);
        level.origin[a] = frame.grid->GetOrigin()[a], level.spacing[a] = frame.grid->GetSpacing()[a];
    }
    add_mesh(liquid_mesh(level, domain_), !level.values.empty(),
             [&](vtkActor* actor) { domain_.flat() ? paint_columns(actor, domain_, liquid_colour) : paint_liquid(actor); });
    level.heights = numbers(frame, "cell_height");
    if (what == Show::particles || level.heights.empty()) return;
    add_mesh(cell_lines(level, domain_), false, [](vtkActor* actor) {
        actor->GetProperty()->SetColor(ink[0], ink[1], ink[2]);
        actor->GetProperty()->LightingOff();
    });
}

/// Each point is the middle of a box, with its extent beside it.
void Stage::add_boxes(vtkPolyData* points) {
    vtkDataArray* size = points->GetPointData()->GetArray("size");
    std::vector<FloatingBox> boxes;
    for (vtkIdType b = 0; b < points->GetNumberOfPoints(); ++b) {
        FloatingBox box{};
        for (std::size_t a = 0; a < 3; ++a) {
            box.middle[a] = points->GetPoint(b)[a];
            box.size[a] = static_cast<int>(a) < size->GetNumberOfComponents() ? size->GetComponent(b, static_cast<int>(a)) : 0;
        }
        boxes.push_back(box);
    }
    add_mesh(mesh_of(boxes, domain_), false, [&](vtkActor* actor) { paint_boxes(actor, domain_); });
}

}  // namespace weir::view
