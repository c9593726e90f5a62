#include "app/view/water.hpp"

#include <vtkActor.h>
#include <vtkCellArray.h>
#include <vtkCellData.h>
#include <vtkFloatArray.h>
#include <vtkFlyingEdges3D.h>
#include <vtkGeometryFilter.h>
#include <vtkImageData.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPoints.h>
#include <vtkPolyDataNormals.h>
#include <vtkProperty.h>
#include <vtkTableBasedClipDataSet.h>

#include <algorithm>

namespace weir::view {

namespace {

constexpr double film = 1e-3;  // of the deepest water: thinner films are shown as dry

std::size_t place(vtkIdType c) { return static_cast<std::size_t>(c); }

vtkIdType at(const Columns& c, int i, int k) { return static_cast<vtkIdType>(k) * c.nx + i; }

vtkSmartPointer<vtkFloatArray> array_of(const std::vector<float>& values) {
    auto array = vtkSmartPointer<vtkFloatArray>::New();
    array->SetName("shown");
    array->SetNumberOfTuples(static_cast<vtkIdType>(values.size()));
    std::copy(values.begin(), values.end(), array->GetPointer(0));
    return array;
}

vtkSmartPointer<vtkPolyData> smooth(vtkPolyData* surface) {
    vtkNew<vtkPolyDataNormals> normals;
    normals->SetInputData(surface);
    normals->SplittingOff();
    normals->Update();
    return normals->GetOutput();
}

/// A line of columns: an upright strip each, from `low` to `high`; `wanted` says of which.
template <class Low, class High, class Wanted>
vtkSmartPointer<vtkPolyData> strips(const Columns& c, const std::vector<float>& values, Low&& low, High&& high, Wanted&& wanted) {
    vtkNew<vtkPoints> points;
    vtkNew<vtkCellArray> cells;
    std::vector<float> shown;
    for (int i = 0; i < c.nx; ++i) {
        if (!wanted(i)) continue;
        const double x = c.x0 + i * c.dx;
        const vtkIdType corner[] = {points->InsertNextPoint(x, low(i), 0), points->InsertNextPoint(x + c.dx, low(i), 0),
                                    points->InsertNextPoint(x + c.dx, high(i), 0), points->InsertNextPoint(x, high(i), 0)};
        cells->InsertNextCell(4, corner);
        if (!values.empty()) shown.push_back(values[static_cast<std::size_t>(i)]);
    }
    auto surface = vtkSmartPointer<vtkPolyData>::New();
    surface->SetPoints(points);
    surface->SetPolys(cells);
    if (!values.empty()) surface->GetCellData()->SetScalars(array_of(shown));
    return surface;
}

/// A plane of columns: a surface through their middles at a height, where any of the four columns about a piece is wanted.
template <class Height, class Wanted>
vtkSmartPointer<vtkPolyData> relief(const Columns& c, const std::vector<float>& values, Height&& height, Wanted&& wanted) {
    vtkNew<vtkPoints> points;
    vtkNew<vtkCellArray> cells;
    for (int k = 0; k < c.nz; ++k)
        for (int i = 0; i < c.nx; ++i) points->InsertNextPoint(c.x0 + (i + 0.5) * c.dx, height(at(c, i, k)), c.z0 + (k + 0.5) * c.dz);
    for (int k = 0; k + 1 < c.nz; ++k)
        for (int i = 0; i + 1 < c.nx; ++i) {
            const vtkIdType corner[] = {at(c, i, k), at(c, i, k + 1), at(c, i + 1, k + 1), at(c, i + 1, k)};
            if (std::any_of(std::begin(corner), std::end(corner), wanted)) cells->InsertNextCell(4, corner);
        }
    vtkNew<vtkPolyData> surface;
    surface->SetPoints(points);
    surface->SetPolys(cells);
    if (!values.empty()) surface->GetPointData()->SetScalars(array_of(values));
    return smooth(surface);
}

/// The level set at the corners of cells, the mean of those about each, with the values beside it; in 3D within one more layer that is far
/// outside, so that its surface closes at the sides.
vtkSmartPointer<vtkImageData> corners_of(const Level& level, bool flat) {
    const int pad = flat ? 0 : 1;
    const auto& n = level.cells;
    const std::array<int, 3> m{n[0] + 1 + 2 * pad, n[1] + 1 + 2 * pad, flat ? 1 : n[2] + 1 + 2 * pad};
    auto image = vtkSmartPointer<vtkImageData>::New();
    image->SetDimensions(m.data());
    image->SetSpacing(level.spacing[0], level.spacing[1], flat ? 1 : level.spacing[2]);
    image->SetOrigin(level.origin[0] - pad * level.spacing[0], level.origin[1] - pad * level.spacing[1],
                     flat ? 0 : level.origin[2] - pad * level.spacing[2]);
    const float outside = 1e3F * static_cast<float>(level.spacing[0]);
    std::vector<float> phi, values;
    phi.reserve(place(image->GetNumberOfPoints()));
    for (int k = -pad; k < m[2] - pad; ++k)
        for (int j = -pad; j < m[1] - pad; ++j)
            for (int i = -pad; i < m[0] - pad; ++i) {
                const bool in = i >= 0 && i <= n[0] && j >= 0 && j <= n[1] && (flat || (k >= 0 && k <= n[2]));
                float p = 0, v = 0;
                int count = 0;
                for (int c = std::max(0, k - 1); c <= std::min(n[2] - 1, flat ? 0 : k); ++c)
                    for (int b = std::max(0, j - 1); b <= std::min(n[1] - 1, j); ++b)
                        for (int a = std::max(0, i - 1); a <= std::min(n[0] - 1, i); ++a, ++count) {
                            const std::size_t cell = static_cast<std::size_t>(a + n[0] * (b + n[1] * c));
                            p += level.phi[cell];
                            if (!level.values.empty()) v += level.values[cell];
                        }
                const float share = 1.0F / static_cast<float>(std::max(1, count));
                phi.push_back(in ? p * share : outside);
                values.push_back(v * share);
            }
    auto field = array_of(phi);
    field->SetName("phi");
    image->GetPointData()->SetScalars(field);
    if (!level.values.empty()) image->GetPointData()->AddArray(array_of(values));
    return image;
}

}  // namespace

vtkSmartPointer<vtkPolyData> ground_mesh(const Columns& c, const Domain& domain) {
    const auto bed = [&](vtkIdType at) { return static_cast<double>(c.bed[place(at)]); };
    const auto any = [](vtkIdType) { return true; };
    if (!domain.flat()) return relief(c, {}, bed, any);
    const double floor = std::min<double>(domain.box[2], *std::min_element(c.bed.begin(), c.bed.end()));
    return strips(
        c, {}, [&](vtkIdType) { return floor; }, bed, any);
}

vtkSmartPointer<vtkPolyData> water_mesh(const Columns& c, const Domain& domain) {
    const double thin = film * *std::max_element(c.depth.begin(), c.depth.end());
    const auto bed = [&](vtkIdType at) { return static_cast<double>(c.bed[place(at)]); };
    const auto top = [&](vtkIdType at) { return bed(at) + std::max(0.0, static_cast<double>(c.depth[place(at)])); };
    const auto wet = [&](vtkIdType at) { return c.depth[place(at)] > thin; };
    return domain.flat() ? strips(c, c.values, bed, top, wet) : relief(c, c.values, top, wet);
}

void paint_columns(vtkActor* actor, const Domain& domain, const Rgb& rgb) {
    actor->GetProperty()->SetColor(rgb[0], rgb[1], rgb[2]);
    if (domain.flat())
        actor->GetProperty()->LightingOff(), actor->SetPosition(0, 0, -0.5 * domain.cell);
    else
        actor->GetProperty()->SetSpecular(0.3);
}

vtkSmartPointer<vtkPolyData> liquid_mesh(const Level& level, const Domain& domain) {
    const auto image = corners_of(level, domain.flat());
    vtkSmartPointer<vtkPolyData> mesh;
    if (domain.flat()) {
        vtkNew<vtkTableBasedClipDataSet> inside;
        inside->SetInputData(image);
        inside->SetValue(0);
        inside->InsideOutOn();
        vtkNew<vtkGeometryFilter> sheet;
        sheet->SetInputConnection(inside->GetOutputPort());
        sheet->Update();
        mesh = sheet->GetOutput();
    } else {
        vtkNew<vtkFlyingEdges3D> surface;
        surface->SetInputData(image);
        surface->SetValue(0, 0);
        surface->ComputeNormalsOn();
        surface->InterpolateAttributesOn();
        surface->Update();
        mesh = surface->GetOutput();
    }
    mesh->GetPointData()->SetActiveScalars(level.values.empty() ? nullptr : "shown");
    return mesh;
}

vtkSmartPointer<vtkPolyData> cell_lines(const Level& level, const Domain& domain) {
    vtkNew<vtkPoints> points;
    vtkNew<vtkCellArray> lines;
    const auto& n = level.cells;
    const auto around = [&](const std::array<std::array<double, 3>, 4>& corner) {
        lines->InsertNextCell(5);
        vtkIdType first = 0;
        for (std::size_t c = 0; c < 4; ++c) {
            const vtkIdType id = points->InsertNextPoint(corner[c].data());
            if (c == 0) first = id;
            lines->InsertCellPoint(id);
        }
        lines->InsertCellPoint(first);
    };
    /// From below: a tall cell is as many rows as its height says.
    const auto column = [&](int i, int k, std::array<double, 3> from, std::array<double, 3> along) {
        for (int j = 0; j < n[1];) {
            const std::size_t c = static_cast<std::size_t>(i + n[0] * (j + n[1] * k));
            const int rows = std::clamp(static_cast<int>(level.heights[c] / level.spacing[1] + 0.5), 1, n[1] - j);
            if (level.phi[c] < 0) {
                auto a = from, b = from, e = from, f = from;
                for (std::size_t x : {0, 2}) b[x] += along[x], e[x] += along[x];
                a[1] = b[1] = level.origin[1] + j * level.spacing[1];
                e[1] = f[1] = a[1] + rows * level.spacing[1];
                around({a, b, e, f});
            }
            j += rows;
        }
    };
    const double dx = level.spacing[0], dz = level.spacing[2], x0 = level.origin[0], z0 = level.origin[2];
    const int last = domain.flat() ? 0 : n[2] - 1;
    for (int i = 0; i < n[0]; ++i) column(i, last, {x0 + i * dx, 0, domain.flat() ? 0.25 * domain.cell : z0 + n[2] * dz}, {dx, 0, 0});
    for (int k = 0; !domain.flat() && k < n[2]; ++k) column(n[0] - 1, k, {x0 + n[0] * dx, 0, z0 + k * dz}, {0, 0, dz});
    auto mesh = vtkSmartPointer<vtkPolyData>::New();
    mesh->SetPoints(points);
    mesh->SetLines(lines);
    return mesh;
}

}  // namespace weir::view
