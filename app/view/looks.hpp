// How the windows of `weir view` and `weir live` look: the domain, colours and their scale, how particles, clouds and meshes are drawn. One
// drawing for frames that are read and for a run that goes on.
#pragma once
#include "core/types.hpp"
#include "scene/scene.hpp"

#include <vtkNew.h>
#include <vtkSmartPointer.h>

#include <array>
#include <filesystem>
#include <string>
#include <vector>

class vtkActor;
class vtkLookupTable;
class vtkMapper;
class vtkPointGaussianMapper;
class vtkPolyData;
class vtkRenderWindow;
class vtkRenderer;
class vtkScalarBarActor;
class vtkTextActor;
class vtkVolumeProperty;

namespace weir::view {

using Rgb = std::array<double, 3>;
inline constexpr Rgb paper{0.965, 0.97, 0.98}, ink{0.13, 0.15, 0.19};
inline constexpr Rgb liquid_colour{0.16, 0.42, 0.66}, solid_colour{0.55, 0.57, 0.61}, ground_colour{0.60, 0.54, 0.43},
    float_colour{0.71, 0.47, 0.25};

/// Of a scene, as windows see it.
struct Domain {
    int dim = 2;
    std::array<real, 6> box{};  // x0 x1 y0 y1 z0 z1 [m]
    real cell = 1;              // shortest side of a cell [m]
    explicit Domain(const scene::Scene& scene);
    bool flat() const { return dim == 2; }
};

/// What colours mean, and the bar that says so. The scale grows with the values seen, so that colours keep their meaning from frame to
/// frame, until it is forgotten.
class Scale {
public:
    Scale();
    ~Scale();
    Scale(const Scale&) = delete;
    Scale& operator=(const Scale&) = delete;
    void join(vtkRenderer* renderer);
    void forget() { low_ = infinity, high_ = -infinity; }
    void widen(real low, real high);
    /// Colours by the values seen, of this field; whether they differ from the previous ones.
    bool set(const std::string& field);
    bool empty() const { return low_ > high_; }
    /// Values of the two ends.
    std::array<real, 2> range() const { return {low_, high_}; }
    vtkLookupTable* table() { return table_; }
    /// Colours by the mapper's scalars.
    void colour(vtkMapper* mapper);
    /// A cloud is the denser, the further its value is from nothing.
    void colour(vtkVolumeProperty* cloud) const;
    void show(bool shown);
    /// The bar stands at the right, above `foot`, in a window of this size [pixels].
    void place(int width, int height, int foot);

private:
    vtkNew<vtkLookupTable> table_;
    vtkNew<vtkScalarBarActor> bar_;
    real low_ = infinity, high_ = -infinity;
    std::array<real, 2> set_{infinity, -infinity};
    std::string field_;
};

/// Black on paper.
void set_style(vtkTextActor* text);
/// With lines broken at spaces where they would be wider than this [pixels].
std::string wrapped(const std::string& text, int width);

vtkSmartPointer<vtkActor> outline(const Domain& domain);
/// All particles in one draw call, as shaded discs; `markers`: two of them lie along a cell's side, else one.
vtkSmartPointer<vtkPointGaussianMapper> splats(const Domain& domain, bool markers);
void paint_splats(vtkActor* actor);
/// Solids: grey, and in 2D in front of the fluid.
void paint_solids(vtkActor* actor, const Domain& domain);
/// A surface of liquid, or a line of it.
void paint_liquid(vtkActor* actor);

/// Boxes along the axes that float: each is its middle, x y z, and its extent.
struct FloatingBox {
    std::array<double, 3> middle{}, size{};
};
vtkSmartPointer<vtkPolyData> mesh_of(const std::vector<FloatingBox>& boxes, const Domain& domain);
void paint_boxes(vtkActor* actor, const Domain& domain);

/// Room that is left for the colour bar at the right [pixels].
inline constexpr int bar_room = 104;
/// Looks at the whole domain: from the front (2D), from in front and above (3D), beside the colour bar.
void look_at_all(vtkRenderer* renderer, const Domain& domain);

/// The field that a run is about: smoke, temperature, speed, or the first; empty where there is none.
std::string main_field(const std::vector<std::string>& names);
/// The one after `name`, and the first after the last.
std::string next_field(const std::vector<std::string>& names, const std::string& name);

/// What the window shows, as a PNG.
void write_png(vtkRenderWindow* window, const std::filesystem::path& png);

}  // namespace weir::view
