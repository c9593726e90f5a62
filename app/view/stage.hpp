// What stands in the viewer's window: particles as spheres, a grid as a coloured sheet (2D) or a cloud (3D), columns of water as ground and
// water on it, boxes that float, the scene's solids, the outline of the domain, a scale, and a line of text.
#pragma once
#include "app/view/series.hpp"
#include "scene/scene.hpp"

#include <vtkNew.h>
#include <vtkSmartPointer.h>

#include <array>
#include <vector>

class vtkActor;
class vtkLookupTable;
class vtkMapper;
class vtkProp;
class vtkRenderer;
class vtkScalarBarActor;
class vtkTextActor;

namespace weir::view {

/// Whether the grid is of columns of water, one cell high, which stands on its bed.
bool is_of_columns(const Frame& frame);

enum class Show { particles, grid, both };

class Stage {
public:
    explicit Stage(scene::Scene scene);
    ~Stage();

    vtkRenderer* renderer() { return renderer_; }
    int dim() const { return scene_.dim(); }
    /// Replaces what is shown. The scale grows with the fields seen, so that colours keep their meaning from frame to frame.
    void show(const Frame& frame, const std::string& field, Show what);
    /// The next frame shown sets the scale anew.
    void forget_range();
    /// Looks at the whole domain: from the front (2D), from in front and above (3D).
    void look_at_all();
    void tell(const std::string& text);
    /// Values of the scale's two ends.
    std::array<real, 2> range() const { return {low_, high_}; }

private:
    void add_particles(const Frame& frame, vtkPolyData* points, const std::string& field);
    void add_surface(const Frame& frame, vtkPolyData* points, const std::string& field);
    void add_columns(const Frame& frame, const std::string& field);
    void add_boxes(vtkPolyData* points);
    void add_sheet(const Frame& frame, const std::string& field);
    void add_cloud(const Frame& frame, const std::string& field);
    void add_solids(const Frame& frame);
    void add_outline();
    /// Colours by the field of `shown`; plain where that is null.
    void colour(vtkMapper* mapper, vtkDataSet* shown);
    void widen(vtkDataSet* shown);
    void set_colours(const std::string& field);
    void add(vtkSmartPointer<vtkProp> prop);

    scene::Scene scene_;
    std::array<real, 6> domain_{};  // x0 x1 y0 y1 z0 z1 [m]
    real cell_ = 1;                 // shortest side of a cell of the scene [m]
    vtkNew<vtkRenderer> renderer_;
    vtkNew<vtkLookupTable> colours_;
    vtkNew<vtkScalarBarActor> scale_;
    vtkNew<vtkTextActor> text_;
    std::vector<vtkSmartPointer<vtkProp>> props_;  // of this frame
    real low_ = infinity, high_ = -infinity;
};

}  // namespace weir::view
