// What stands in the window of a session: all particles in one draw call, a grid as a coloured sheet (2D) or a cloud (3D), columns as their
// surface, solids as meshes, the brush, and lines of text. Actors are made once; a frame changes their data alone.
#pragma once
#include "app/live/snapshot.hpp"
#include "scene/scene.hpp"

#include <vtkNew.h>
#include <vtkSmartPointer.h>

#include <array>

class vtkActor;
class vtkFloatArray;
class vtkImageActor;
class vtkImageData;
class vtkLookupTable;
class vtkPoints;
class vtkPolyData;
class vtkPolyDataMapper;
class vtkRenderer;
class vtkScalarBarActor;
class vtkTextActor;
class vtkVolume;

namespace weir::live {

class Scenery {
public:
    explicit Scenery(const scene::Scene& scene);
    ~Scenery();

    vtkRenderer* renderer() { return renderer_; }
    int dim() const { return scene_.dim(); }
    const std::array<real, 6>& domain() const { return domain_; }
    real cell() const { return cell_; }
    void show(const Snapshot& snapshot);
    void show_brush(const Vec<3>& centre, real radius, bool acts);
    void look_at_all();
    void tell(const std::string& figures, const std::string& help);
    std::array<real, 2> range() const { return {low_, high_}; }

private:
    void add_outline();
    void add_particles();
    void add_sheet();
    void add_cloud();
    void add_columns();
    void add_brush();
    void add_texts();
    void set_solids(const Snapshot& s);
    void set_particles(const Snapshot& s);
    void set_sheet(const Snapshot& s);
    void set_cloud(const Snapshot& s);
    void set_columns(const Snapshot& s);
    void set_colours(const Snapshot& s);

    scene::Scene scene_;
    std::array<real, 6> domain_{};  // x0 x1 y0 y1 z0 z1 [m]
    real cell_ = 1;                 // shortest side of a cell [m]
    vtkNew<vtkRenderer> renderer_;
    vtkNew<vtkLookupTable> colours_;
    vtkNew<vtkScalarBarActor> scale_;
    vtkNew<vtkTextActor> figures_, help_;
    vtkNew<vtkPolyData> particles_, columns_, solids_;
    vtkNew<vtkFloatArray> particle_places_, particle_values_, cloud_values_;
    vtkNew<vtkImageData> sheet_, cloud_;
    vtkNew<vtkActor> particle_actor_, column_actor_, solid_actor_, brush_;
    vtkNew<vtkImageActor> sheet_actor_;
    vtkNew<vtkVolume> volume_;
    bool solids_move_ = false, has_solids_ = false;
    std::string field_;
    real low_ = infinity, high_ = -infinity;
};

}  // namespace weir::live
