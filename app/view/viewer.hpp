// The viewer: a window on the frames of a run, which plays, steps, colours by another field and grabs pictures at the press of a key.
#pragma once
#include "app/view/series.hpp"
#include "app/view/stage.hpp"

#include <vtkNew.h>
#include <vtkSmartPointer.h>

#include <filesystem>
#include <optional>
#include <string>

class vtkInteractorStyle;
class vtkRenderWindow;
class vtkRenderWindowInteractor;

namespace weir::view {

struct Options {
    std::string field;      // empty: speed, or the first there is
    std::size_t first = 0;  // frame to begin with
    int width = 1100, height = 800;
    bool offscreen = false;       // no window: pictures only
    std::filesystem::path grabs;  // folder of grabbed pictures
};

class Viewer {
public:
    /// Shows the first frame. Throws BadInput for a field that the frame does not have, naming those that it has.
    Viewer(Series series, scene::Scene scene, const Options& options);
    ~Viewer();

    /// Waits for keys until the window is closed: space plays and pauses; Right and Left, Home and End step; c colours by the next field;
    /// w shows particles, grid or both; a fits the scale to the frame; r looks at all; g grabs a picture; q closes.
    void interact();
    /// What a key does, by VTK's name of it. Unknown keys do nothing.
    void press(const std::string& key);
    /// Shows frame `number`.
    void show(std::size_t number);
    void write(const std::filesystem::path& png) { write_png(window_, png); }

    std::size_t frame() const { return number_; }
    bool playing() const { return playing_; }
    const std::string& field() const { return field_; }
    /// The picture grabbed last.
    const std::optional<std::filesystem::path>& grabbed() const { return grabbed_; }
    vtkRenderWindowInteractor* interactor() { return interactor_; }
    Stage& stage() { return stage_; }

private:
    void draw();
    void on_key();
    void on_timer();
    void next_field();
    void grab();

    Series series_;
    Stage stage_;
    Options options_;
    vtkNew<vtkRenderWindow> window_;
    vtkNew<vtkRenderWindowInteractor> interactor_;
    vtkSmartPointer<vtkInteractorStyle> style_;
    Frame shown_;
    std::size_t number_ = 0;
    std::string field_;
    Show what_ = Show::particles;
    bool playing_ = false;
    std::optional<std::filesystem::path> grabbed_;
};

}  // namespace weir::view
