// What stands in the viewer's window: particles as spheres, a grid as a coloured sheet (2D) or a cloud (3D), columns of water as ground and
// water on it, boxes that float, the scene's solids, the outline of the domain, a scale, and a line of text.
#pragma once
#include "app/view/looks.hpp"
#include "app/view/series.hpp"
#include "scene/scene.hpp"

#include <vtkNew.h>
#include <vtkSmartPointer.h>

#include <array>
#include <functional>
#include <vector>

class vtkActor;
class vtkMapper;
class vtkProp;
class vtkRenderer;
class vtkTextActor;

namespace weir::view {

/// Whether the grid is of columns of water, one cell high, which stands on its bed.
bool is_of_columns(const Frame& frame);
/// Whether a level set alone tells where the liquid is.
bool is_of_liquid(const Frame& frame);

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
    void forget_range() { scale_.forget(); }
    void look_at_all() { view::look_at_all(renderer_, domain_); }
    void tell(const std::string& text);
    /// Values of the scale's two ends.
    std::array<real, 2> range() const { return scale_.range(); }

private:
    void add_particles(const Frame& frame, vtkPolyData* points, const std::string& field);
    void add_surface(const Frame& frame, vtkPolyData* points, const std::string& field);
    void add_columns(const Frame& frame, const std::string& field);
    void add_liquid(const Frame& frame, const std::string& field, Show what);
    void add_boxes(vtkPolyData* points);
    void add_sheet(const Frame& frame, const std::string& field);
    void add_cloud(const Frame& frame, const std::string& field);
    void add_solids(const Frame& frame);
    void add_mesh(vtkPolyData* mesh, bool coloured, const std::function<void(vtkActor*)>& paint);
    /// Colours by the field of `shown`; plain where that is null.
    void colour(vtkMapper* mapper, vtkDataSet* shown);
    void widen(vtkDataSet* shown);
    void add(vtkSmartPointer<vtkProp> prop);

    scene::Scene scene_;
    Domain domain_;
    vtkNew<vtkRenderer> renderer_;
    Scale scale_;
    vtkNew<vtkTextActor> text_;
    std::vector<vtkSmartPointer<vtkProp>> props_;  // of this frame
};

}  // namespace weir::view
