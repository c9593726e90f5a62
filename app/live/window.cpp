#include "app/live/window.hpp"

#include "core/error.hpp"
#include "output/atomic_file.hpp"

#include <vtkCamera.h>
#include <vtkCommand.h>
#include <vtkPNGWriter.h>
#include <vtkRenderWindow.h>
#include <vtkRenderWindowInteractor.h>
#include <vtkRenderer.h>
#include <vtkUnsignedCharArray.h>
#include <vtkWindowToImageFilter.h>

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include <sys/resource.h>

namespace weir::live {

namespace {

constexpr int milliseconds_between_looks = 8;
constexpr double told_every = 0.25;  // [s]: text is dear to draw
/// A mouse that has not moved for so long stands still.
constexpr double still_after = 0.06;  // [s]
/// Pulled fluid crosses the brush so often a second.
constexpr real pulls = 4;  // [1/s]

const char* const help_text =
    "left drag    the hand acts in its brush\n"
    "1 2 3 4      push, pull, pour, drain\n"
    "wheel        size of the brush\n"
    "right drag   camera;   Ctrl + wheel, + and -   nearer and farther\n"
    "space        pause;   .   one step;   r   from the start again\n"
    "left, right  choose a number of the scene;   up, down   change it\n"
    "c            colour by the next field;   v   look at all\n"
    "s            save a checkpoint;   p   a picture\n"
    "F1           these keys;   q   close";

double seconds(std::chrono::steady_clock::duration d) { return std::chrono::duration<double>(d).count(); }

/// Of all threads of this process, drawing's included.
double cpu_seconds() {
    rusage usage{};
    getrusage(RUSAGE_SELF, &usage);
    const auto seconds = [](const timeval& t) { return static_cast<double>(t.tv_sec) + 1e-6 * static_cast<double>(t.tv_usec); };
    return seconds(usage.ru_utime) + seconds(usage.ru_stime);
}

}  // namespace

Window::Window(Session& session, const WindowOptions& options)
    : session_(session), options_(options), scenery_(session.scene()), knobs_(session.scene()), paused_(options.paused) {
    const auto& box = scenery_.domain();
    real shortest = infinity;
    for (std::size_t a = 0; a < 3; ++a)
        if (box[2 * a + 1] > box[2 * a]) shortest = std::min(shortest, box[2 * a + 1] - box[2 * a]);
    radius_ = std::max(0.1 * shortest, 2 * scenery_.cell());
    window_->SetWindowName(("weir live " + session.scene().file()).c_str());
    window_->SetSize(options.width, options.height);
    window_->SetMultiSamples(0);  // four times the pixels to shade
    window_->AddRenderer(scenery_.renderer());
    interactor_->SetRenderWindow(window_);
    interactor_->SetInteractorStyle(nullptr);
    interactor_->AddObserver(vtkCommand::LeftButtonPressEvent, this, &Window::on_left_press);
    interactor_->AddObserver(vtkCommand::LeftButtonReleaseEvent, this, &Window::on_left_release);
    interactor_->AddObserver(vtkCommand::RightButtonPressEvent, this, &Window::on_right_press);
    interactor_->AddObserver(vtkCommand::RightButtonReleaseEvent, this, &Window::on_right_release);
    interactor_->AddObserver(vtkCommand::MouseMoveEvent, this, &Window::on_move);
    interactor_->AddObserver(vtkCommand::MouseWheelForwardEvent, this, &Window::on_wheel_forward);
    interactor_->AddObserver(vtkCommand::MouseWheelBackwardEvent, this, &Window::on_wheel_backward);
    interactor_->AddObserver(vtkCommand::KeyPressEvent, this, &Window::on_key);
    interactor_->AddObserver(vtkCommand::TimerEvent, this, &Window::on_timer);
    scenery_.look_at_all();
    began_ = moved_ = clock::now();
    runner_ = std::make_unique<Runner>(session, options.real_time, options.paused);
    if (!options.field.empty()) runner_->wish([&](Wishes& w) { w.field = options.field; });
    refresh();
}

Window::~Window() { stop(); }

void Window::stop() { runner_->stop(); }

void Window::interact(double for_seconds) {
    interactor_->Initialize();
    began_ = clock::now();
    at_start_.cpu_seconds = cpu_seconds();
    has_end_ = for_seconds > 0, warming_ = options_.warm_up > 0;
    ends_ = began_ + std::chrono::duration_cast<clock::duration>(std::chrono::duration<double>(for_seconds));
    interactor_->CreateRepeatingTimer(milliseconds_between_looks);
    interactor_->Start();
}

bool Window::refresh() {
    const bool fresh = runner_->take(shown_);
    if (fresh) scenery_.show(*shown_);
    if (fresh) costs_.step_ms += shown_->step_ms, costs_.transfer_ms += shown_->transfer_ms;
    if (fresh || stale_) draw();
    return fresh;
}

void Window::draw() {
    const auto start = clock::now();
    stale_ = false;
    tell();
    window_->Render();
    drawing_ms_ = 1e3 * seconds(clock::now() - start);
    ++frames_counted_;
    ++costs_.frames;
    costs_.drawing_ms += drawing_ms_;
    costs_.seconds = seconds(clock::now() - began_);
    costs_.cpu_seconds = cpu_seconds() - at_start_.cpu_seconds;
    costs_.steps = shown_->steps - at_start_.steps;
    costs_.simulated = shown_->time - at_start_.simulated;
    if (!warming_ || costs_.seconds < options_.warm_up) return;
    warming_ = false;
    at_start_ = {.cpu_seconds = cpu_seconds(), .simulated = shown_->time, .steps = shown_->steps};
    began_ = clock::now();
    costs_ = {};
}

void Window::tell() {
    const double since = seconds(clock::now() - told_);
    if (since < told_every) return;
    frames_a_second_ = frames_counted_ / std::max(since, 1e-3);
    frames_counted_ = 0;
    told_ = clock::now();
    const Snapshot& s = *shown_;
    std::string passes;
    for (std::size_t i = 0; i < std::min<std::size_t>(s.passes.size(), 4); ++i)
        passes += fmt::format("{}{} {:.2g}", i ? ", " : "", s.passes[i].first, s.passes[i].second);
    std::string text = s.message.substr(0, 160);
    text += fmt::format("{}{:.0f} frames/s   step {:.2f} ms{}   transfer {:.2f} ms   drawing {:.1f} ms", text.empty() ? "" : "\n",
                        frames_a_second_, s.step_ms, passes.empty() ? "" : " (" + passes + ")", s.transfer_ms, drawing_ms_);
    text += fmt::format("\nt = {:.3f} s   ", s.time);
    if (s.paused)
        text += "paused";
    else
        text += s.factor > 0.95 ? fmt::format("{:.2f} of real time", s.factor)
                                : fmt::format("{:.2g} of real time: {:.1f} times slower", s.factor, 1 / std::max(s.factor, 1e-6));
    text += fmt::format("   step {}", s.steps);
    if (!s.points.empty()) text += fmt::format("   {} particles", s.points.size() / 3);
    if (s.report.iterations > 0) text += fmt::format("   {} iterations", s.report.iterations);
    if (!std::isnan(s.report.density_error)) text += fmt::format("   density error {:.2g} %", 100 * s.report.density_error);
    if (!std::isnan(s.report.max_divergence)) text += fmt::format("   divergence {:.1e} 1/s", s.report.max_divergence);
    text += session_.has_hand() ? fmt::format("\nhand: {}, {:.3g} m", hand_kinds[static_cast<std::size_t>(tool_)], radius_)
                                : "\nthis solver has no hand";
    if (!knobs_.empty()) text += fmt::format("   {} = {:.4g}", knobs_.chosen().name(), knobs_.chosen().value());
    scenery_.tell(text + "   F1: keys", help_ ? help_text : "");
}

void Window::press(const std::string& key) {
    if (key == "space") runner_->wish([&](Wishes& w) { w.paused = paused_ = !paused_; });
    if (key == "period") runner_->wish([&](Wishes& w) { w.paused = paused_ = true, ++w.single_steps; });
    if (key == "r") runner_->wish([](Wishes& w) { w.reset = true; }), knobs_ = Knobs(session_.scene());
    if (key == "s") runner_->wish([](Wishes& w) { w.checkpoint = true; });
    if (key == "p") picture();
    if (key == "c") next_field();
    if (key == "v") scenery_.look_at_all();
    if (key == "plus" || key == "equal") zoom(1.1);
    if (key == "minus") zoom(1 / 1.1);
    if (key == "F1") help_ = !help_;
    if (key == "Left") knobs_.choose(-1);
    if (key == "Right") knobs_.choose(1);
    if (key == "Up" || key == "Down")
        if (auto change = knobs_.turn(key == "Up" ? 1 : -1)) runner_->wish([&](Wishes& w) { w.changes.push_back(*change); });
    for (int tool = 1; tool <= 4; ++tool)
        if (key == std::to_string(tool)) tool_ = static_cast<HandKind>(tool), tell_hand();
    told_ = {};
    stale_ = true;
    if (key == "q" || key == "Escape") interactor_->TerminateApp();
}

void Window::on_key() { press(interactor_->GetKeySym() ? interactor_->GetKeySym() : ""); }

void Window::on_timer() {
    if (acts_) follow_mouse();
    refresh();
    if (has_end_ && clock::now() >= ends_) interactor_->TerminateApp();
}

void Window::on_left_press() {
    acts_ = true;
    at_ = place_under_mouse();
    velocity_ = {};
    moved_ = clock::now();
    tell_hand();
}

void Window::on_left_release() {
    acts_ = false;
    tell_hand();
}

void Window::on_right_press() { turns_camera_ = true, interactor_->GetEventPosition(mouse_.data()); }
void Window::on_right_release() { turns_camera_ = false; }

void Window::on_move() {
    if (turns_camera_) {
        std::array<int, 2> now{};
        interactor_->GetEventPosition(now.data());
        turn_camera(now[0] - mouse_[0], now[1] - mouse_[1]);
        mouse_ = now;
    }
    follow_mouse();
}

void Window::on_wheel_forward() { interactor_->GetControlKey() ? zoom(1.1) : resize_brush(1.15); }
void Window::on_wheel_backward() { interactor_->GetControlKey() ? zoom(1 / 1.1) : resize_brush(1 / 1.15); }

/// The camera turns about the middle of the domain; over a flat scene it glides.
void Window::turn_camera(int dx, int dy) {
    vtkCamera* camera = scenery_.renderer()->GetActiveCamera();
    const int* size = window_->GetSize();
    if (scenery_.dim() == 3) {
        camera->Azimuth(-180.0 * dx / size[0]);
        camera->Elevation(std::clamp(-90.0 * dy / size[1], -5.0, 5.0));
        camera->OrthogonalizeViewUp();
    } else {
        const real metres = 2 * camera->GetParallelScale() / size[1];
        double focus[3], from[3];
        camera->GetFocalPoint(focus), camera->GetPosition(from);
        camera->SetFocalPoint(focus[0] - metres * dx, focus[1] - metres * dy, focus[2]);
        camera->SetPosition(from[0] - metres * dx, from[1] - metres * dy, from[2]);
    }
    stale_ = true;
}

void Window::zoom(double by) {
    vtkCamera* camera = scenery_.renderer()->GetActiveCamera();
    if (scenery_.dim() == 3)
        camera->Dolly(by);
    else
        camera->SetParallelScale(camera->GetParallelScale() / by);
    stale_ = true;
}

void Window::resize_brush(real by) {
    radius_ = std::max(radius_ * by, scenery_.cell());
    follow_mouse();
}

/// On the plane through the camera's focus that faces it.
Vec<3> Window::place_under_mouse() {
    vtkRenderer* renderer = scenery_.renderer();
    double focus[3];
    renderer->GetActiveCamera()->GetFocalPoint(focus);
    renderer->SetWorldPoint(focus[0], focus[1], focus[2], 1);
    renderer->WorldToDisplay();
    const double depth = renderer->GetDisplayPoint()[2];
    int at[2];
    interactor_->GetEventPosition(at);
    renderer->SetDisplayPoint(at[0], at[1], depth);
    renderer->DisplayToWorld();
    const double* world = renderer->GetWorldPoint();
    return {{world[0] / world[3], world[1] / world[3], scenery_.dim() == 2 ? 0 : world[2] / world[3]}};
}

std::array<int, 2> Window::pixel(const Vec<3>& place) {
    vtkRenderer* renderer = scenery_.renderer();
    renderer->SetWorldPoint(place[0], place[1], place[2], 1);
    renderer->WorldToDisplay();
    const double* at = renderer->GetDisplayPoint();
    return {static_cast<int>(std::lround(at[0])), static_cast<int>(std::lround(at[1]))};
}

/// The hand is as fast as the mouse: over the clock's time, whatever the simulation keeps up with.
void Window::follow_mouse() {
    const Vec<3> now = place_under_mouse();
    const double since = seconds(clock::now() - moved_);
    if (norm(now - at_) > 0) {
        velocity_ = (now - at_) / std::max(since, 1e-3 * milliseconds_between_looks);
        at_ = now;
        moved_ = clock::now();
    } else if (since > still_after) {
        velocity_ = {};
    }
    tell_hand();
}

void Window::tell_hand() {
    if (!session_.has_hand()) return;
    HandKey key;
    if (acts_) key = {0, tool_, at_, radius_, velocity_, tool_ == HandKind::pull ? pulls * radius_ : 0};
    scenery_.show_brush(at_, radius_, acts_);
    stale_ = true;
    runner_->wish([&](Wishes& w) { w.hand = key; });
}

void Window::next_field() {
    const auto& names = shown_->fields;
    if (names.empty()) return;
    const auto at = std::find(names.begin(), names.end(), shown_->field);
    const std::string next = at == names.end() || at + 1 == names.end() ? names.front() : *(at + 1);
    runner_->wish([&](Wishes& w) { w.field = next; });
}

void Window::picture() {
    pictured_ = session_.folder() / fmt::format("picture_{:03}.png", pictures_++);
    std::filesystem::create_directories(session_.folder());
    write(*pictured_);
}

void Window::write(const std::filesystem::path& png) {
    vtkNew<vtkWindowToImageFilter> pixels;
    pixels->SetInput(window_);
    pixels->ReadFrontBufferOff();
    vtkNew<vtkPNGWriter> writer;
    writer->SetInputConnection(pixels->GetOutputPort());
    writer->WriteToMemoryOn();
    writer->Write();
    vtkUnsignedCharArray* bytes = writer->GetResult();
    output::write_file(png, {reinterpret_cast<const char*>(bytes->GetPointer(0)), static_cast<std::size_t>(bytes->GetNumberOfValues())});
}

}  // namespace weir::live
