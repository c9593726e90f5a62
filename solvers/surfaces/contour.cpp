#include "surfaces/contour.hpp"

#include "core/error.hpp"
#include "core/parallel.hpp"
#include "surfaces/vtk_threads.hpp"

#include <algorithm>

#ifdef WEIR_HAS_VTK
#include <vtkCellArray.h>
#include <vtkFloatArray.h>
#include <vtkFlyingEdges3D.h>
#include <vtkImageData.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPolyData.h>
#include <vtkSmartPointer.h>
#endif

namespace weir::surfaces {

#ifdef WEIR_HAS_VTK

bool can_contour() { return true; }

namespace {

/// The contour between these planes, in index coordinates: single precision is then accurate to 1e-5 of a cell for lattices of a hundred.
vtkSmartPointer<vtkPolyData> contour_of(const Samples& samples, int first, int last) {
    const std::size_t plane = samples.plane(), count = plane * static_cast<std::size_t>(last - first + 1);
    float* const lent = const_cast<float*>(samples.depth.data()) + plane * static_cast<std::size_t>(first);
    vtkNew<vtkFloatArray> values;
    values->SetArray(lent, static_cast<vtkIdType>(count), 1);  // not owned by the array
    vtkNew<vtkImageData> image;
    image->SetExtent(0, samples.n[0] - 1, 0, samples.n[1] - 1, first, last);
    image->GetPointData()->SetScalars(values);
    vtkNew<vtkFlyingEdges3D> filter;
    filter->SetInputData(image);
    filter->SetValue(0, 0);
    filter->ComputeNormalsOff();
    filter->ComputeGradientsOff();
    filter->ComputeScalarsOff();
    with_vtk_threads(threads(), [&] { filter->Update(); });
    return filter->GetOutput();
}

/// Number of triangles between these planes.
std::size_t triangles_between(const Samples& samples, int first, int last) {
    return first < last ? static_cast<std::size_t>(contour_of(samples, first, last)->GetNumberOfPolys()) : 0;
}

}  // namespace

Piece contour(const Samples& samples, SurfaceMesh& mesh) {
    mesh.points.clear(), mesh.corners.clear();
    const PlaneRange layers = samples.layers;
    if (layers.begin >= layers.end) return {};
    const int first = std::max(0, layers.begin - 2), last = std::min(samples.n[2] - 1, layers.end + 1);
    const auto made = contour_of(samples, first, last);
    mesh.points.resize(static_cast<std::size_t>(made->GetNumberOfPoints()));
    mesh.corners.resize(static_cast<std::size_t>(made->GetNumberOfPolys()));
    if (mesh.corners.empty()) {
        mesh.points.clear();
        return {};
    }
    const auto* xyz = vtkFloatArray::SafeDownCast(made->GetPoints()->GetData())->GetPointer(0);
    parallel_for(0, static_cast<int>(mesh.points.size()), [&](int p) {
        for (std::size_t a = 0; a < 3; ++a)
            mesh.points[static_cast<std::size_t>(p)][a] = samples.first[a] + samples.spacing[a] * real(xyz[3 * p + static_cast<int>(a)]);
    });
    vtkDataArray* corners = made->GetPolys()->GetConnectivityArray();
    const auto* ids = vtkArrayDownCast<vtkTypeInt64Array>(corners)->GetPointer(0);
    parallel_for(0, static_cast<int>(mesh.corners.size()), [&](int t) {
        for (int c = 0; c < 3; ++c)
            mesh.corners[static_cast<std::size_t>(t)][static_cast<std::size_t>(c)] = static_cast<int>(ids[3 * t + c]);
    });
    const auto start = [&](int layer) {  // filters process a lattice plane by plane and number results in that order
        std::size_t low = 0, high = mesh.points.size();
        while (low < high) {
            const std::size_t middle = (low + high) / 2;
            xyz[3 * middle + 2] < static_cast<float>(layer) ? low = middle + 1 : high = middle;
        }
        return low;
    };
    return piece_of(layers, start, triangles_between(samples, first, layers.begin),
                    mesh.corners.size() - triangles_between(samples, layers.end, last));
}

#else

bool can_contour() { return false; }
Piece contour(const Samples&, SurfaceMesh&) { throw BadInput("this weir was built without VTK (WEIR_VTK=OFF) and makes no surfaces"); }

#endif

}  // namespace weir::surfaces
