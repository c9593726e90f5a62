#include "reconstruction/contour.hpp"

#include "core/error.hpp"
#include "core/parallel.hpp"
#include "reconstruction/vtk_threads.hpp"

#ifdef WEIR_HAS_VTK
#include <vtkCellArray.h>
#include <vtkFloatArray.h>
#include <vtkFlyingEdges3D.h>
#include <vtkImageData.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPolyData.h>
#endif

namespace weir::reconstruction {

#ifdef WEIR_HAS_VTK

bool can_contour() { return true; }

void contour(const Samples& samples, SurfaceMesh& mesh) {
    vtkNew<vtkFloatArray> values;
    values->SetArray(const_cast<float*>(samples.depth.data()), static_cast<vtkIdType>(samples.depth.size()), 1);  // lent, not given
    vtkNew<vtkImageData> image;  // in numbers of samples: single precision then is good to 1e-5 of a cell in lattices of a hundred
    image->SetDimensions(samples.n[0], samples.n[1], samples.n[2]);
    image->GetPointData()->SetScalars(values);
    vtkNew<vtkFlyingEdges3D> filter;
    filter->SetInputData(image);
    filter->SetValue(0, 0);
    filter->ComputeNormalsOff();
    filter->ComputeGradientsOff();
    filter->ComputeScalarsOff();
    with_vtk_threads(threads(), [&] { filter->Update(); });
    vtkPolyData* made = filter->GetOutput();

    mesh.points.resize(static_cast<std::size_t>(made->GetNumberOfPoints()));
    mesh.corners.resize(static_cast<std::size_t>(made->GetNumberOfPolys()));
    if (mesh.corners.empty()) return mesh.points.clear();
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
}

#else

bool can_contour() { return false; }
void contour(const Samples&, SurfaceMesh&) { throw BadInput("this weir was built without VTK (WEIR_VTK=OFF) and makes no surfaces"); }

#endif

}  // namespace weir::reconstruction
