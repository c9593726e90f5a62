// Water that no particles stand for, as meshes: columns on their bed, and the inside of a level set with the cells that it was solved on.
#pragma once
#include "app/view/looks.hpp"

#include <vtkPolyData.h>
#include <vtkSmartPointer.h>

#include <array>
#include <vector>

namespace weir::view {

/// A plane of columns of water, one row of them in 2D; x fastest.
struct Columns {
    int nx = 0, nz = 1;
    double dx = 1, dz = 1, x0 = 0, z0 = 0;
    std::vector<float> bed, depth;  // [m]
    std::vector<float> values;      // to colour the water by; empty: plain
};

/// The ground down to the domain's floor (2D: strips; 3D: a relief), and the water on it where it is no film.
vtkSmartPointer<vtkPolyData> ground_mesh(const Columns& columns, const Domain& domain);
vtkSmartPointer<vtkPolyData> water_mesh(const Columns& columns, const Domain& domain);
void paint_columns(vtkActor* actor, const Domain& domain, const Rgb& rgb);

/// A level set in the cells of a grid, negative in the liquid; x fastest.
struct Level {
    std::array<int, 3> cells{1, 1, 1};
    std::array<double, 3> origin{}, spacing{1, 1, 1};  // [m]; in 2D the last spacing means nothing
    std::vector<float> phi;                            // [m]
    std::vector<float> values;                         // to colour the liquid by; empty: plain
    std::vector<float> heights;                        // of tall cells: that of the one which a cell lies in; empty: the grid is not shown
};

/// The area of the liquid (2D), or its surface, closed at the sides of the domain.
vtkSmartPointer<vtkPolyData> liquid_mesh(const Level& level, const Domain& domain);
/// Lines about the cells that hold liquid, tall ones as tall as they are: all (2D), or those at the sides of large x and z.
vtkSmartPointer<vtkPolyData> cell_lines(const Level& level, const Domain& domain);

}  // namespace weir::view
