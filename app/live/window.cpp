#include "app/live/window.hpp"

#include "core/error.hpp"

#include <vtkCommand.h>
#include <vtkRenderWindow.h>
#include <vtkRenderWindowInteractor.h>
#include <vtkRenderer.h>

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include <sys/resource.h>

namespace weir::live {

namespace {

constexpr double text_every = 0.25;  // [s]: text is expensive to draw
/// Where the water has not moved a brush or a text may wait so long: what is drawn for them is time that steps do not get.
constexpr double patience = 1.0 / 40;  // [s]

/// A brush that heats is so much warmer than the warmest fluid, or colder than the coldest.
constexpr real warmer = 40;  // [K]

const char* const help_text =
    "left drag    apply the brush\n"
    "1 2 3 4 6    push, pull, pour, drain, hold a body\n"
    "5            heat; once more: cool\n"
    "wheel        size of the brush\n"
    "right drag   camera;   Ctrl + wheel, + and -   zoom\n"
    "space        pause;   .   one step;   r   restart\n"
    "left, right  choose a value of the scene;   up, down   change it\n"
    "c            colour by the next field;   v   fit the view\n"
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
    const auto& box = scenery_.domain().box;
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
    if (!options.field.empty()) runner_->post([&](SessionCommands& w) { w.field = options.field; });
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
    if (fresh || (stale_ && seconds(clock::now() - drawn_) > patience)) draw();
    return fresh;
}

void Window::draw() {
    const auto start = clock::now();
    stale_ = false;
    tell();
    window_->Render();
    drawn_ = clock::now();
    drawing_ms_ = 1e3 * seconds(drawn_ - start);
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
    if (since < text_every) return;
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
    else if (s.factor > 0)  // known after half a second
        text += s.factor > 0.95 ? fmt::format("{:.2f} of real time", s.factor)
                                : fmt::format("{:.2g} of real time: {:.1f} times slower", s.factor, 1 / std::max(s.factor, 1e-6));
    text += fmt::format("   step {}", s.steps);
    if (!s.points.empty()) text += fmt::format("   {} particles", s.points.size() / 3);
    if (s.report.iterations > 0) text += fmt::format("   {} iterations", s.report.iterations);
    if (!std::isnan(s.report.density_error)) text += fmt::format("   density error {:.2g} %", 100 * s.report.density_error);
    if (!std::isnan(s.report.max_divergence)) text += fmt::format("   divergence {:.1e} 1/s", s.report.max_divergence);
    text += "\n" + brush_text(s);
    if (!knobs_.empty()) text += fmt::format("   {} = {:.4g}", knobs_.chosen().name(), knobs_.chosen().value());
    scenery_.tell(text + "   F1: keys", help_ ? help_text : "");
}

std::string Window::brush_text(const Snapshot& s) const {
    if (!s.has_brush) return "this solver has no interactive forcing";
    const auto tool = static_cast<std::size_t>(tool_);
    if (!s.brush_can[tool]) {
        const char* why = tool_ == BrushKind::heat   ? "the fluid of this scene carries no heat"
                          : tool_ == BrushKind::grab ? "no body at the brush to hold"
                                                     : "this model of a height field has no currents to push";
        return fmt::format("brush: no {}: {}", brush_kinds[tool], why);
    }
    if (tool_ == BrushKind::heat) return fmt::format("brush: {} to {:.4g} K, {:.3g} m", cools_ ? "cool" : "heat", temperature_, radius_);
    return fmt::format("brush: {}, {:.3g} m", brush_kinds[tool], radius_);
}

void Window::choose_tool(BrushKind tool) {
    cools_ = tool == BrushKind::heat && tool_ == BrushKind::heat && !cools_;
    tool_ = tool;
    temperature_ = cools_ ? std::max(1.0, shown_->temperatures[0] - warmer) : shown_->temperatures[1] + warmer;
    update_brush();
}

void Window::press(const std::string& key) {
    if (key == "space") runner_->post([&](SessionCommands& w) { w.paused = paused_ = !paused_; });
    if (key == "period") runner_->post([&](SessionCommands& w) { w.paused = paused_ = true, ++w.single_steps; });
    if (key == "r") runner_->post([](SessionCommands& w) { w.reset = true; }), knobs_ = Knobs(session_.scene());
    if (key == "s") runner_->post([](SessionCommands& w) { w.checkpoint = true; });
    if (key == "p") picture();
    if (key == "c") next_field();
    if (key == "v") scenery_.look_at_all();
    if (key == "plus" || key == "equal") zoom(1.1);
    if (key == "minus") zoom(1 / 1.1);
    if (key == "F1") help_ = !help_;
    if (key == "Left") knobs_.choose(-1);
    if (key == "Right") knobs_.choose(1);
    if (key == "Up" || key == "Down")
        if (auto change = knobs_.turn(key == "Up" ? 1 : -1)) runner_->post([&](SessionCommands& w) { w.changes.push_back(*change); });
    for (std::size_t tool = 1; tool < brush_kinds.size(); ++tool)
        if (key == std::to_string(tool)) choose_tool(static_cast<BrushKind>(tool));
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

void Window::next_field() {
    if (shown_->fields.empty()) return;
    runner_->post([&](SessionCommands& w) { w.field = view::next_field(shown_->fields, shown_->field); });
}

void Window::picture() {
    pictured_ = session_.folder() / fmt::format("picture_{:03}.png", pictures_++);
    std::filesystem::create_directories(session_.folder());
    write(*pictured_);
}

void Window::write(const std::filesystem::path& png) { view::write_png(window_, png); }

}  // namespace weir::live
