// The window of a session: it draws the newest snapshot as often as it can, and turns mouse and keys into commands of the runner. It never
// waits for a step.
#pragma once
#include "app/live/knobs.hpp"
#include "app/live/quick_window.hpp"
#include "app/live/runner.hpp"
#include "app/live/scenery.hpp"

#include <vtkNew.h>

#include <chrono>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>

class vtkRenderWindow;
class vtkRenderWindowInteractor;

namespace weir::live {

inline constexpr int milliseconds_between_looks = 8;

struct WindowOptions {
    int width = 1100, height = 800;
    bool paused = false;
    bool real_time = true;  // else as fast as it goes
    std::string field;      // empty: what the scene is about
    double warm_up = 0;     // costs count from here on [s]
};

/// What frames have cost since the start, or the end of the warm-up.
struct FrameCosts {
    int frames = 0;
    double seconds = 0;      // of the clock
    double cpu_seconds = 0;  // of all threads of this process
    double simulated = 0;    // [s]
    double drawing_ms = 0;   // all frames together
    double step_ms = 0, transfer_ms = 0;
    std::int64_t steps = 0;
};

class Window {
public:
    Window(Session& session, const WindowOptions& options);
    ~Window();

    /// Until the window is closed or `seconds` are over (0: for ever).
    void interact(double seconds = 0);
    /// The runner stands still afterwards, and the session is this thread's.
    void stop();
    /// Draws what is new; whether anything was.
    bool refresh();
    /// What a key does, by VTK's name of it.
    void press(const std::string& key);
    void write(const std::filesystem::path& png);

    const Snapshot& shown() const { return *shown_; }
    BrushKind tool() const { return tool_; }
    real radius() const { return radius_; }
    const FrameCosts& costs() const { return costs_; }
    const std::optional<std::filesystem::path>& pictured() const { return pictured_; }
    Scenery& scenery() { return scenery_; }
    vtkRenderWindowInteractor* interactor() { return interactor_; }
    /// Pixel of a place of the domain.
    std::array<int, 2> pixel(const Vec<3>& place);

private:
    using clock = std::chrono::steady_clock;
    void on_left_press();
    void on_left_release();
    void on_right_press();
    void on_right_release();
    void on_move();
    void on_wheel_forward();
    void on_wheel_backward();
    void on_key();
    void on_timer();
    void turn_camera(int dx, int dy);
    void zoom(double by);
    void resize_brush(real by);
    void next_field();
    void picture();
    Vec<3> place_under_mouse();
    Vec<3> seen_at(const std::array<int, 2>& pixel, double depth);
    void follow_mouse();
    void update_brush();
    void choose_tool(BrushKind tool);
    std::string brush_text(const Snapshot& s) const;
    void draw();
    void tell();

    Session& session_;
    WindowOptions options_;
    Scenery scenery_;
    Knobs knobs_;
    std::unique_ptr<Snapshot> shown_ = std::make_unique<Snapshot>();
    vtkSmartPointer<vtkRenderWindow> window_ = quick_window();
    vtkNew<vtkRenderWindowInteractor> interactor_;
    BrushKind tool_ = BrushKind::push;
    bool acts_ = false, turns_camera_ = false, help_ = false, paused_ = false, stale_ = true;
    real radius_ = 0.1, temperature_ = 0;
    bool cools_ = false;
    Vec<3> at_{}, velocity_{};
    std::array<int, 2> mouse_{};
    clock::time_point moved_, told_, drawn_, began_, ends_;
    bool has_end_ = false, warming_ = false;
    FrameCosts costs_, at_start_;
    double frames_a_second_ = 0, drawing_ms_ = 0;
    int frames_counted_ = 0;
    int pictures_ = 0;
    std::optional<std::filesystem::path> pictured_;
    std::unique_ptr<Runner> runner_;
};

}  // namespace weir::live
