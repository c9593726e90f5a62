#include "app/view/viewer.hpp"

#include "core/error.hpp"

#include <vtkCommand.h>
#include <vtkInteractorStyleImage.h>
#include <vtkInteractorStyleTrackballCamera.h>
#include <vtkRenderWindow.h>
#include <vtkRenderWindowInteractor.h>
#include <vtkRenderer.h>

#include <algorithm>

#include <fmt/format.h>

namespace weir::view {

namespace {

constexpr int milliseconds_a_frame = 40;

std::string chosen_field(const std::string& requested, const Frame& frame) {
    const auto names = field_names(frame);
    const auto has = [&](const std::string& name) { return std::find(names.begin(), names.end(), name) != names.end(); };
    if (!requested.empty() && !has(requested))
        throw BadInput(fmt::format("this run has no field \"{}\"; known: {}", requested, fmt::join(names, ", ")));
    return requested.empty() ? main_field(names) : requested;
}

}  // namespace

Viewer::Viewer(Series series, scene::Scene scene, const Options& options)
    : series_(std::move(series)), stage_(std::move(scene)), options_(options) {
    shown_ = series_.read(std::min(options.first, series_.size() - 1));
    field_ = chosen_field(options.field, shown_);
    window_->SetWindowName(("weir " + series_.folder().string()).c_str());
    window_->SetOffScreenRendering(options.offscreen);
    window_->SetSize(options.width, options.height);
    window_->SetMultiSamples(4);
    window_->AddRenderer(stage_.renderer());
    if (!options.offscreen) {
        if (stage_.dim() == 2)
            style_ = vtkSmartPointer<vtkInteractorStyleImage>::New();
        else
            style_ = vtkSmartPointer<vtkInteractorStyleTrackballCamera>::New();
        interactor_->SetRenderWindow(window_);
        interactor_->SetInteractorStyle(style_);
        style_->AddObserver(vtkCommand::CharEvent, this, &Viewer::on_key);  // in place of the style's own keys
        interactor_->AddObserver(vtkCommand::TimerEvent, this, &Viewer::on_timer);
    }
    stage_.look_at_all();
    show(std::min(options.first, series_.size() - 1));
}

Viewer::~Viewer() = default;

void Viewer::interact() {
    interactor_->Initialize();
    interactor_->CreateRepeatingTimer(milliseconds_a_frame);
    interactor_->Start();
}

void Viewer::press(const std::string& key) {
    const std::size_t last = series_.size() - 1;
    if (key == "space") playing_ = !playing_, draw();
    if (key == "Right") playing_ = false, show(std::min(number_ + 1, last));
    if (key == "Left") playing_ = false, show(number_ - std::min<std::size_t>(number_, 1));
    if (key == "Home") show(0);
    if (key == "End") playing_ = false, show(last);
    if (key == "c") next_field();
    if (key == "w") what_ = what_ == Show::particles ? Show::grid : what_ == Show::grid ? Show::both : Show::particles, draw();
    if (key == "a") stage_.forget_range(), draw();
    if (key == "r") stage_.look_at_all(), draw();
    if (key == "g") grab();
    if (key == "q" || key == "Escape") interactor_->TerminateApp();
}

void Viewer::show(std::size_t number) {
    shown_ = series_.read(number);
    number_ = number;
    draw();
}

void Viewer::draw() {
    stage_.show(shown_, field_, what_);
    stage_.tell(fmt::format(
        "t = {:.4g} s   frame {} of {}{}{}", shown_.time, number_ + 1, series_.size(), playing_ ? "   playing" : "",
        options_.offscreen ? "" : "\nspace play   arrows step   c colour by   w particles/grid   a fit scale   r reset   g grab   q quit"));
    window_->Render();
}

void Viewer::on_key() { press(interactor_->GetKeySym() ? interactor_->GetKeySym() : ""); }

void Viewer::on_timer() {
    if (playing_) show(number_ + 1 < series_.size() ? number_ + 1 : 0);
}

void Viewer::next_field() {
    field_ = view::next_field(field_names(shown_), field_);
    stage_.forget_range();
    draw();
}

void Viewer::grab() {
    grabbed_ = options_.grabs / fmt::format("{}_{:06}.png", field_.empty() ? "frame" : field_, number_);
    write(*grabbed_);
    std::printf("%s\n", grabbed_->c_str());
    std::fflush(stdout);
}

}  // namespace weir::view
