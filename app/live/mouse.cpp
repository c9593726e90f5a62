// The mouse in the window of a session: the left button acts with the brush, the right one and the wheel move the camera and size the
// brush.
#include "app/live/window.hpp"

#include <vtkCamera.h>
#include <vtkRenderWindow.h>
#include <vtkRenderWindowInteractor.h>
#include <vtkRenderer.h>

#include <algorithm>
#include <cmath>

namespace weir::live {

namespace {

/// A mouse that has not moved for so long stands still.
constexpr double still_after = 0.06;  // [s]
/// Pulled fluid crosses the brush so often a second.
constexpr real pulls = 4;  // [1/s]
/// Columns rise and fall by so many brushes a second where the brush pours and drains.
constexpr real rises = 1;  // [1/s]

/// Of the water's surface, by volume.
real mean_level(const view::Columns& columns) {
    real sum = 0, depth = 0;
    for (std::size_t c = 0; c < columns.depth.size(); ++c)
        sum += columns.depth[c] * (columns.bed[c] + columns.depth[c]), depth += columns.depth[c];
    return depth > 0 ? sum / depth : 0;
}

double seconds(std::chrono::steady_clock::duration d) { return std::chrono::duration<double>(d).count(); }

}  // namespace

void Window::on_left_press() {
    acts_ = true;
    at_ = place_under_mouse();
    velocity_ = {};
    moved_ = clock::now();
    update_brush();
}

void Window::on_left_release() {
    acts_ = false;
    update_brush();
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

/// The camera turns about the middle of the domain; over a flat scene it translates.
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

/// The place that is seen at a pixel, at this depth of the view, in [0, 1].
Vec<3> Window::seen_at(const std::array<int, 2>& at, double depth) {
    vtkRenderer* renderer = scenery_.renderer();
    renderer->SetDisplayPoint(at[0], at[1], depth);
    renderer->DisplayToWorld();
    const double* world = renderer->GetWorldPoint();
    return {{world[0] / world[3], world[1] / world[3], scenery_.dim() == 2 ? 0 : world[2] / world[3]}};
}

/// On the plane through the camera's focus that faces it; over columns in 3D, on the level of their water.
Vec<3> Window::place_under_mouse() {
    std::array<int, 2> at{};
    interactor_->GetEventPosition(at.data());
    vtkRenderer* renderer = scenery_.renderer();
    if (scenery_.dim() == 3 && shown_->columns.nx > 0) {
        const Vec<3> near = seen_at(at, 0), ray = seen_at(at, 1) - near;
        const real along = (mean_level(shown_->columns) - near[1]) / ray[1];
        if (along > 0 && along < 1) return near + along * ray;
    }
    double focus[3];
    renderer->GetActiveCamera()->GetFocalPoint(focus);
    renderer->SetWorldPoint(focus[0], focus[1], focus[2], 1);
    renderer->WorldToDisplay();
    return seen_at(at, renderer->GetDisplayPoint()[2]);
}

std::array<int, 2> Window::pixel(const Vec<3>& place) {
    vtkRenderer* renderer = scenery_.renderer();
    renderer->SetWorldPoint(place[0], place[1], place[2], 1);
    renderer->WorldToDisplay();
    const double* at = renderer->GetDisplayPoint();
    return {static_cast<int>(std::lround(at[0])), static_cast<int>(std::lround(at[1]))};
}

/// The brush is as fast as the mouse: over the clock's time, whatever the simulation keeps up with.
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
    update_brush();
}

void Window::update_brush() {
    if (!shown_->has_brush) return;
    BrushKeyframe key;
    if (acts_) key = {0, tool_, at_, radius_, velocity_, tool_ == BrushKind::pull ? pulls * radius_ : radius_ * rises};
    if (tool_ == BrushKind::heat) key.temperature = temperature_;
    if (tool_ == BrushKind::push || tool_ == BrushKind::grab) key.speed = 0;
    scenery_.show_brush(at_, radius_, acts_);
    stale_ = true;
    runner_->post([&](SessionCommands& w) {
        w.brush = key;
        if (acts_) w.touch = key;
    });
}

}  // namespace weir::live
