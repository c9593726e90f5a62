// What stands in the window of a session: all particles in one draw call, a grid as a coloured sheet (2D) or a cloud (3D), columns on their
// ground, liquids that a level set bounds, solids as meshes, the brush, and lines of text. Actors are made once; a frame changes their data
// alone.
#pragma once
#include "app/live/snapshot.hpp"
#include "app/view/looks.hpp"
#include "scene/scene.hpp"

#include <vtkNew.h>
#include <vtkSmartPointer.h>

#include <array>

class vtkActor;
class vtkFloatArray;
class vtkImageActor;
class vtkImageData;
class vtkPoints;
class vtkPolyData;
class vtkPolyDataMapper;
class vtkRenderer;
class vtkTextActor;
class vtkVolume;

namespace weir::live {

/// A mesh that changes from frame to frame.
struct Mesh {
    vtkNew<vtkActor> actor;
    vtkNew<vtkPolyDataMapper> mapper;
    Mesh();
    /// Nothing is shown of a null pointer.
    void show(vtkPolyData* mesh, view::Scale* coloured = nullptr);
};

class Scenery {
public:
    explicit Scenery(const scene::Scene& scene);
    ~Scenery();

    vtkRenderer* renderer() { return renderer_; }
    const view::Domain& domain() const { return domain_; }
    int dim() const { return domain_.dim; }
    real cell() const { return domain_.cell; }
    void show(const Snapshot& snapshot);
    void show_brush(const Vec<3>& centre, real radius, bool acts);
    void look_at_all() { view::look_at_all(renderer_, domain_); }
    void tell(const std::string& figures, const std::string& help);
    std::array<real, 2> range() const { return scale_.range(); }

private:
    void add_particles();
    void add_sheet();
    void add_cloud();
    void add_meshes();
    void add_brush();
    void add_texts();
    void set_solids(const Snapshot& s);
    void set_particles(const Snapshot& s);
    void order_particles(const Snapshot& s);
    void set_sheet(const Snapshot& s);
    void set_cloud(const Snapshot& s);
    void set_water(const Snapshot& s);
    void set_rows(const Snapshot& s);
    void set_colours(const Snapshot& s);

    scene::Scene scene_;
    view::Domain domain_;
    vtkNew<vtkRenderer> renderer_;
    view::Scale scale_;
    vtkNew<vtkTextActor> figures_, help_;
    bool bar_hidden_ = false;  // behind the keys
    vtkNew<vtkPolyData> particles_;
    vtkNew<vtkFloatArray> particle_places_, particle_values_, cloud_values_;
    vtkNew<vtkImageData> sheet_, cloud_;
    vtkNew<vtkActor> particle_actor_, brush_;
    vtkNew<vtkImageActor> sheet_actor_;
    vtkNew<vtkVolume> volume_;
    Mesh solids_, ground_, water_, lines_, rows_, boxes_;
    std::vector<int> order_, depth_;  // particles as they are drawn; how far each is from the eye
    bool solids_move_ = false, solids_are_missing_ = false;
    std::string field_;
};

}  // namespace weir::live
