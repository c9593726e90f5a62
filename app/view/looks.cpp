#include "app/view/looks.hpp"

#include "app/picture/canvas.hpp"
#include "output/atomic_file.hpp"

#include <vtkActor.h>
#include <vtkAppendPolyData.h>
#include <vtkCamera.h>
#include <vtkColorTransferFunction.h>
#include <vtkCubeSource.h>
#include <vtkLookupTable.h>
#include <vtkMapper.h>
#include <vtkOutlineSource.h>
#include <vtkPNGWriter.h>
#include <vtkPiecewiseFunction.h>
#include <vtkPointGaussianMapper.h>
#include <vtkPolyData.h>
#include <vtkPolyDataMapper.h>
#include <vtkProperty.h>
#include <vtkRenderWindow.h>
#include <vtkRenderer.h>
#include <vtkScalarBarActor.h>
#include <vtkTextActor.h>
#include <vtkTextProperty.h>
#include <vtkUnsignedCharArray.h>
#include <vtkVolumeProperty.h>
#include <vtkWindow.h>
#include <vtkWindowToImageFilter.h>

#include <algorithm>
#include <cmath>

namespace weir::view {

namespace {

constexpr int shades = 256, shades_of_clouds = 16;
constexpr double glare = 1 / 2.2;                   // linear light as a screen wants it
constexpr double bar_foot = 0.12, bar_head = 0.82;  // in parts of a window's height
constexpr int text_room = 72;                       // below: three lines of text [pixels]
constexpr int usual_width = 1100, usual_height = 800;

Rgb screen_colour(std::string_view map, real s) {
    const picture::Colour linear = picture::colour_of(map, s);
    Rgb rgb{};
    for (std::size_t c = 0; c < 3; ++c) rgb[c] = std::pow(std::clamp(linear[static_cast<int>(c)], 0.0, 1.0), glare);
    return rgb;
}

void set_style(vtkTextProperty* style) {
    style->SetColor(ink[0], ink[1], ink[2]);
    style->SetFontSize(14);
    style->ItalicOff();
    style->ShadowOff();
    style->BoldOff();
}

void set_colour(vtkActor* actor, const Rgb& rgb) { actor->GetProperty()->SetColor(rgb[0], rgb[1], rgb[2]); }

}  // namespace

Domain::Domain(const scene::Scene& scene) : dim(scene.dim()) {
    const auto cells = scene.root().numbers("grid.cells"), size = scene.root().numbers("grid.size"),
               origin = scene.root().numbers("grid.origin");
    cell = infinity;
    for (std::size_t a = 0; a < static_cast<std::size_t>(dim); ++a) {
        box[2 * a] = origin[a];
        box[2 * a + 1] = origin[a] + size[a];
        if (cells[a] > 1) cell = std::min(cell, size[a] / cells[a]);
    }
    if (cell == infinity) cell = *std::min_element(size.begin(), size.end());
}

Scale::Scale() {
    table_->SetNumberOfTableValues(shades);
    bar_->SetLookupTable(table_);
    bar_->SetUnconstrainedFontSize(true);
    bar_->SetNumberOfLabels(5);
    bar_->SetLabelFormat("%.3g");
    bar_->SetVerticalTitleSeparation(12);
    bar_->SetBarRatio(0.2);  // the rest is for numbers such as -1.23e-05
    set_style(bar_->GetLabelTextProperty());
    set_style(bar_->GetTitleTextProperty());
    place(usual_width, usual_height, 0);
}

Scale::~Scale() = default;

void Scale::join(vtkRenderer* renderer) { renderer->AddActor2D(bar_); }

void Scale::place(int width, int height, int foot) {
    if (width <= 0 || height <= 0) return;
    const double low = std::clamp(static_cast<double>(foot) / height, bar_foot, 0.5 * bar_head);
    bar_->SetPosition(1 - static_cast<double>(bar_room - 4) / width, low);
    bar_->SetWidth(static_cast<double>(bar_room - 8) / width);
    bar_->SetHeight(bar_head - low);
}

void Scale::widen(real low, real high) {
    if (!(low <= high)) return;
    low_ = std::min(low_, low);
    high_ = std::max(high_, high);
}

bool Scale::set(const std::string& field) {
    if (empty()) return false;
    const bool both_signs = low_ < 0 && high_ > 0;
    if (both_signs) high_ = std::max(high_, -low_), low_ = -high_;
    if (range() == set_ && field == field_) return false;
    set_ = range(), field_ = field;
    const std::string_view map = both_signs ? "coolwarm" : field == "temperature" ? "inferno" : "viridis";
    for (int i = 0; i < shades; ++i) {
        const auto rgb = screen_colour(map, i / (shades - 1.0));
        table_->SetTableValue(i, rgb[0], rgb[1], rgb[2]);
    }
    table_->SetTableRange(low_, std::max(high_, low_ + 1e-12 * std::max(1.0, std::abs(low_))));
    bar_->SetTitle((field == "speed" ? "speed [m/s]" : field).c_str());
    return true;
}

void Scale::colour(vtkMapper* mapper) {
    mapper->SetLookupTable(table_);
    mapper->UseLookupTableScalarRangeOn();
}

void Scale::colour(vtkVolumeProperty* cloud) const {
    vtkNew<vtkColorTransferFunction> colour;
    vtkNew<vtkPiecewiseFunction> opacity;
    for (int i = 0; i <= shades_of_clouds; ++i) {
        const real at = static_cast<real>(i) / shades_of_clouds, value = low_ + (high_ - low_) * at;
        double rgb[3];
        table_->GetColor(value, rgb);
        colour->AddRGBPoint(value, rgb[0], rgb[1], rgb[2]);
        opacity->AddPoint(value, 0.6 * (low_ < 0 ? std::abs(2 * at - 1) : at));
    }
    cloud->SetColor(colour);
    cloud->SetScalarOpacity(opacity);
}

void Scale::show(bool shown) { bar_->SetVisibility(shown); }

void set_style(vtkTextActor* text) { set_style(text->GetTextProperty()); }

std::string wrapped(const std::string& text, int width) {
    constexpr double letter = 6.9;  // a mean one of the style, and a little [pixels]
    const std::size_t most = static_cast<std::size_t>(std::max(16.0, width / letter));
    std::string lines;
    std::size_t column = 0, space = std::string::npos;  // where the line may be broken
    for (const char c : text) {
        lines += c;
        column = c == '\n' ? 0 : column + 1;
        if (c == '\n') space = std::string::npos;
        if (c == ' ') space = lines.size() - 1;
        if (column <= most || space == std::string::npos) continue;
        lines[space] = '\n';
        const std::size_t words = lines.find_first_not_of(' ', space + 1);  // a line begins with a word
        if (words != std::string::npos) lines.erase(space + 1, words - space - 1);
        column = lines.size() - space - 1;
        space = std::string::npos;
    }
    return lines;
}

vtkSmartPointer<vtkActor> outline(const Domain& domain) {
    vtkNew<vtkOutlineSource> lines;
    lines->SetBounds(domain.box.data());
    vtkNew<vtkPolyDataMapper> mapper;
    mapper->SetInputConnection(lines->GetOutputPort());
    auto actor = vtkSmartPointer<vtkActor>::New();
    actor->SetMapper(mapper);
    actor->GetProperty()->SetColor(0.35, 0.38, 0.42);
    actor->GetProperty()->LightingOff();
    return actor;
}

vtkSmartPointer<vtkPointGaussianMapper> splats(const Domain& domain, bool markers) {
    auto mapper = vtkSmartPointer<vtkPointGaussianMapper>::New();
    mapper->SetScaleFactor(0.6 * (markers ? 0.5 : 1) * domain.cell);
    mapper->EmissiveOff();
    mapper->SetSplatShaderCode(
        "//VTK::Color::Impl\n"
        "float dist2 = dot(offsetVCVSOutput.xy, offsetVCVSOutput.xy);\n"
        "if (dist2 > 1.0) discard;\n"
        "float shade = 0.55 + 0.45 * sqrt(1.0 - dist2);\n"
        "ambientColor *= shade;\n"
        "diffuseColor *= shade;\n");
    mapper->SetTriangleScale(1.02F);  // the triangle around the disc, and a hair: what lies beyond the disc is shaded for nothing
    return mapper;
}

void paint_splats(vtkActor* actor) {
    set_colour(actor, liquid_colour);
    actor->GetProperty()->LightingOff();
}

void paint_solids(vtkActor* actor, const Domain& domain) {
    set_colour(actor, solid_colour);
    if (domain.flat()) actor->GetProperty()->LightingOff(), actor->SetPosition(0, 0, domain.cell);
}

void paint_liquid(vtkActor* actor) {
    set_colour(actor, liquid_colour);
    actor->GetProperty()->SetSpecular(0.4);
    actor->GetProperty()->SetLineWidth(3);
}

vtkSmartPointer<vtkPolyData> mesh_of(const std::vector<FloatingBox>& boxes, const Domain& domain) {
    vtkNew<vtkAppendPolyData> all;
    for (const auto& [middle, size] : boxes) {
        vtkNew<vtkCubeSource> box;
        box->SetCenter(middle[0], middle[1], domain.flat() ? domain.cell : middle[2]);
        box->SetXLength(size[0]);
        box->SetYLength(size[1]);
        box->SetZLength(domain.flat() ? 0.1 * domain.cell : size[2]);
        all->AddInputConnection(box->GetOutputPort());
    }
    if (!boxes.empty()) all->Update();
    return all->GetOutput();
}

void paint_boxes(vtkActor* actor, const Domain& domain) {
    set_colour(actor, float_colour);
    if (domain.flat()) actor->GetProperty()->LightingOff();
}

void look_at_all(vtkRenderer* renderer, const Domain& domain) {
    const auto middle = [&](std::size_t a) { return 0.5 * (domain.box[2 * a] + domain.box[2 * a + 1]); };
    vtkCamera* camera = renderer->GetActiveCamera();
    camera->SetFocalPoint(middle(0), middle(1), middle(2));
    camera->SetViewUp(0, 1, 0);
    const bool flat = domain.flat();
    camera->SetParallelProjection(flat);
    camera->SetPosition(middle(0) + (flat ? 0 : 0.45), middle(1) + (flat ? 0 : 0.42), middle(2) + 1);
    renderer->ResetCamera(domain.box.data());
    const int* size = renderer->GetVTKWindow() ? renderer->GetVTKWindow()->GetSize() : nullptr;
    const double width = size && size[0] > 0 ? size[0] : usual_width, height = size && size[1] > 0 ? size[1] : usual_height;
    const double across = std::max(0.5 * width, width - 1.1 * bar_room), up = std::max(0.5 * height, height - text_room);
    if (!flat) return camera->Zoom(std::min(1.0, 1.1 * across / width));
    // as large as fits beside the bar and above the text, and in the middle of what they leave
    const double metre = 1.06 * std::max((domain.box[1] - domain.box[0]) / across, (domain.box[3] - domain.box[2]) / up);
    const double x = middle(0) + 0.5 * (width - across) * metre, y = middle(1) - 0.5 * (height - up) * metre;
    camera->SetParallelScale(0.5 * height * metre);
    camera->SetFocalPoint(x, y, middle(2));
    camera->SetPosition(x, y, camera->GetPosition()[2]);
}

std::string main_field(const std::vector<std::string>& names) {
    for (const char* name : {"smoke", "temperature", "speed"})
        if (std::find(names.begin(), names.end(), name) != names.end()) return name;
    return names.empty() ? "" : names.front();
}

std::string next_field(const std::vector<std::string>& names, const std::string& name) {
    if (names.empty()) return name;
    const auto at = std::find(names.begin(), names.end(), name);
    return at == names.end() || at + 1 == names.end() ? names.front() : *(at + 1);
}

void write_png(vtkRenderWindow* window, const std::filesystem::path& png) {
    vtkNew<vtkWindowToImageFilter> pixels;
    pixels->SetInput(window);
    pixels->ReadFrontBufferOff();
    vtkNew<vtkPNGWriter> writer;
    writer->SetInputConnection(pixels->GetOutputPort());
    writer->WriteToMemoryOn();
    writer->Write();
    vtkUnsignedCharArray* bytes = writer->GetResult();
    output::write_file(png, {reinterpret_cast<const char*>(bytes->GetPointer(0)), static_cast<std::size_t>(bytes->GetNumberOfValues())});
}

}  // namespace weir::view
