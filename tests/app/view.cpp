// weir view on a display without a screen: what stands where in the picture, what each key does, what is said where it cannot draw.
#include "app/process.hpp"
#include "app/run_folder.hpp"
#include "app/view/viewer.hpp"
#include "core/error.hpp"
#include "output/read_frame.hpp"
#include "support/temporary_folder.hpp"
#include "support/test.hpp"

#include <vtkCommand.h>
#include <vtkImageData.h>
#include <vtkPNGReader.h>
#include <vtkRenderWindowInteractor.h>
#include <vtkRenderer.h>

#include <algorithm>
#include <cmath>

namespace {

namespace fs = std::filesystem;
using namespace weir;
using test::Process;
using test::TemporaryFolder;

/// A run of a scene of tests/app/scenes, made once.
const fs::path& run_of(const std::string& name) {
    static TemporaryFolder folder;
    static std::map<std::string, fs::path> runs;
    auto& out = runs[name];
    if (!out.empty()) return out;
    out = folder.path() / name;
    Process process({"run", std::string(WEIR_SOURCE_DIR) + "/tests/app/scenes/" + name + ".toml", "--out", out, "--threads", "1"},
                    folder.path() / "log");
    if (process.wait() != 0) throw std::runtime_error(process.said());
    return out;
}

view::Viewer viewer_of(const std::string& name, view::Options options = {}) {
    options.width = 400, options.height = 300;
    options.grabs = run_of(name);
    return {view::Series(run_of(name)), app::scene_of_run(run_of(name)), options};
}

/// A picture as it is in its file.
struct Picture {
    vtkNew<vtkPNGReader> reader;
    explicit Picture(const fs::path& png) {
        reader->SetFileName(png.c_str());
        reader->Update();
    }
    int width() const { return reader->GetOutput()->GetDimensions()[0]; }
    int height() const { return reader->GetOutput()->GetDimensions()[1]; }
    double value(int x, int y, int channel) const { return reader->GetOutput()->GetScalarComponentAsDouble(x, y, 0, channel) / 255; }
};

/// Share of the pixels around a place of the domain that are not the paper's colour.
double covered(view::Viewer& viewer, const Vec<3>& place) {
    TemporaryFolder folder;
    viewer.write(folder.path() / "a.png");
    const Picture picture(folder.path() / "a.png");
    vtkRenderer* renderer = viewer.stage().renderer();
    renderer->SetWorldPoint(place[0], place[1], place[2], 1);
    renderer->WorldToDisplay();
    const double* at = renderer->GetDisplayPoint();
    const double* paper = renderer->GetBackground();
    int drawn = 0, all = 0;
    for (int y = -6; y <= 6; ++y)
        for (int x = -6; x <= 6; ++x, ++all) {
            double off = 0;
            for (int c = 0; c < 3; ++c)
                off = std::max(off, std::abs(picture.value(static_cast<int>(at[0]) + x, static_cast<int>(at[1]) + y, c) - paper[c]));
            drawn += off > 0.02;  // 5 of 255: more than rounding
        }
    return static_cast<double>(drawn) / all;
}

/// As the window system tells of a key.
void strike(view::Viewer& viewer, const char* key) {
    viewer.interactor()->SetKeySym(key);
    viewer.interactor()->InvokeEvent(vtkCommand::CharEvent);
}

TEST("water stands where the scene puts it, and has left there for the floor when it has fallen") {
    view::Options still;
    still.offscreen = true;
    view::Viewer viewer = viewer_of("water", still);  // a column of 0.3 m x 0.5 m in a box of 1 m x 0.75 m
    EXPECT_GT(covered(viewer, {{0.15, 0.25, 0}}), 0.5);
    EXPECT_GT(covered(viewer, {{0.15, 0.45, 0}}), 0.5);
    EXPECT_EQ(covered(viewer, {{0.7, 0.4, 0}}), 0);
    EXPECT_EQ(covered(viewer, {{0.6, 0.03, 0}}), 0);
    viewer.show(8);  // t = 0.4 s: free fall would be 0.78 m, the front has run sqrt(2 g 0.5) t = 1.2 m at most
    EXPECT_EQ(covered(viewer, {{0.15, 0.45, 0}}), 0);
    EXPECT_GT(covered(viewer, {{0.6, 0.03, 0}}), 0.5);
}

TEST("a cloud of smoke and a ball stand where the scene puts them in 3D") {
    view::Options still;
    still.offscreen = true, still.first = 2;
    view::Viewer viewer = viewer_of("plume", still);
    EXPECT_GT(covered(viewer, {{0.2, 0.2, 0.3}}), 0.9);
    EXPECT_GT(covered(viewer, {{0.42, 0.6, 0.3}}), 0.9);
    EXPECT_LT(covered(viewer, {{0.1, 0.7, 0.4}}), 0.2);  // an edge of the box may pass behind
}

TEST("columns stand as ground with water on it up to its surface, and a box floats in them as high as it is") {
    view::Options still;
    still.offscreen = true;
    view::Viewer viewer = viewer_of("raft", still);  // ground at -1 m, water to 0, a box from -0.4 to 0.4 m, an island up to 0.8 m
    EXPECT_GT(covered(viewer, {{2.2, -0.2, 0}}), 0.9);
    EXPECT_GT(covered(viewer, {{2.2, -1.2, 0}}), 0.9);
    EXPECT_EQ(covered(viewer, {{2.2, 0.3, 0}}), 0);
    EXPECT_GT(covered(viewer, {{1.0, 0.3, 0}}), 0.9);
    EXPECT_EQ(covered(viewer, {{1.0, 0.7, 0}}), 0);
    EXPECT_GT(covered(viewer, {{3.4, 0.4, 0}}), 0.9);
    view::Viewer deep = viewer_of("raft_3d", still);  // a box from -0.2 to 0.6 m
    EXPECT_GT(covered(deep, {{2.0, 0.4, 0.3}}), 0.9);
    EXPECT_GT(covered(deep, {{0.8, 0.0, 0.5}}), 0.9);
    EXPECT_EQ(covered(deep, {{0.8, 0.9, 0.0}}), 0);
}

TEST("the scale spans the values of the frame's field, and only grows until another field is chosen") {
    view::Viewer viewer = viewer_of("water");
    EXPECT_EQ(viewer.field(), "speed");
    real fastest = 0;
    for (std::size_t number = 0; number < 4; ++number) {
        viewer.show(number);
        const auto frame = output::read_frame(run_of("water"), number, 2);
        const auto& v = frame.particles.at("markers").at("velocity");
        for (std::size_t i = 0; i < v[0].size(); ++i) fastest = std::max(fastest, std::hypot(v[0][i], v[1][i]));
    }
    EXPECT_NEAR(viewer.stage().range()[1], fastest, 1e-6 * fastest);  // shown in single precision
    viewer.show(0);
    EXPECT_NEAR(viewer.stage().range()[1], fastest, 1e-6 * fastest);
    strike(viewer, "a");
    EXPECT_LT(viewer.stage().range()[1], 0.5 * fastest);
}

TEST("keys: arrows, Home and End step; space plays and pauses; c colours; g grabs; others do nothing") {
    view::Viewer viewer = viewer_of("water");
    strike(viewer, "Left");
    EXPECT_EQ(viewer.frame(), 0u);
    strike(viewer, "Right");
    strike(viewer, "Right");
    EXPECT_EQ(viewer.frame(), 2u);
    strike(viewer, "space");
    EXPECT_TRUE(viewer.playing());
    viewer.interactor()->InvokeEvent(vtkCommand::TimerEvent);
    EXPECT_EQ(viewer.frame(), 3u);
    strike(viewer, "End");
    EXPECT_EQ(viewer.frame(), 8u);
    EXPECT_FALSE(viewer.playing());
    strike(viewer, "space");
    viewer.interactor()->InvokeEvent(vtkCommand::TimerEvent);
    EXPECT_EQ(viewer.frame(), 0u) << "a series begins again";
    strike(viewer, "space");
    viewer.interactor()->InvokeEvent(vtkCommand::TimerEvent);
    EXPECT_EQ(viewer.frame(), 0u) << "paused";
    strike(viewer, "c");
    EXPECT_NE(viewer.field(), "speed");
    strike(viewer, "g");
    ASSERT_TRUE(viewer.grabbed());
    EXPECT_EQ(Picture(*viewer.grabbed()).width(), 400);
    const auto field = viewer.field();
    strike(viewer, "x");
    EXPECT_EQ(viewer.field(), field);
    EXPECT_EQ(viewer.frame(), 0u);
}

TEST("the window plays by its own clock and closes on q") {
    view::Viewer viewer = viewer_of("water");
    viewer.press("space");
    struct Closer {
        view::Viewer& viewer;
        void look() {
            if (viewer.frame() == 3) strike(viewer, "q");
        }
    } closer{viewer};
    viewer.interactor()->AddObserver(vtkCommand::TimerEvent, &closer, &Closer::look);
    viewer.interact();
    EXPECT_EQ(viewer.frame(), 3u);
}

TEST("--png draws the frame of a time in the size asked for, through the executable") {
    TemporaryFolder folder;
    const auto png = folder.path() / "picture.png";
    Process process({"view", run_of("water"), "--png", png, "--time", "0.2", "--width", "320", "--height", "200"}, folder.path() / "log");
    ASSERT_EQ(process.wait(), 0) << process.said();
    EXPECT_EQ(Picture(png).width(), 320);
    EXPECT_EQ(Picture(png).height(), 200);
}

TEST("what it cannot show is refused with what there is, and exit code 2") {
    try {
        view::Options options;
        options.field = "smoke";
        viewer_of("water", options);
        FAIL();
    } catch (const BadInput& refused) {
        EXPECT_NE(std::string(refused.what()).find("no field \"smoke\"; known: speed"), std::string::npos) << refused.what();
    }
    TemporaryFolder folder;
    Process nothing({"view", folder.path(), "--png", folder.path() / "a.png"}, folder.path() / "log");
    EXPECT_EQ(nothing.wait(), 2);
    EXPECT_NE(nothing.said().find("contains no series of VTK frames"), std::string::npos) << nothing.said();
    const std::string display = std::getenv("DISPLAY");
    unsetenv("DISPLAY");
    Process blind({"view", run_of("water"), "--png", folder.path() / "a.png"}, folder.path() / "log");
    const int code = blind.wait();
    setenv("DISPLAY", display.c_str(), 1);
    EXPECT_EQ(code, 2);
    EXPECT_NE(blind.said().find("no display to draw on: DISPLAY is not set"), std::string::npos) << blind.said();
    EXPECT_FALSE(fs::exists(folder.path() / "a.png"));
}

TEST("a damaged frame is named, with exit code 2, and nothing is drawn") {
    TemporaryFolder folder;
    fs::copy(run_of("water"), folder.path() / "run", fs::copy_options::recursive);
    const auto entries = output::frame_times(folder.path() / "run").size();
    for (const char* set : {"grid", "markers"}) {
        char name[64];
        std::snprintf(name, sizeof name, "%s_%06zu.%s", set, entries - 1, set == std::string("grid") ? "vti" : "vtp");
        const fs::path frame = folder.path() / "run/frames" / name;
        const std::string whole = test::text_of(frame);
        for (const std::string& damaged :
             {std::string(), whole.substr(0, whole.size() / 2), std::string(whole).replace(whole.size() - 60, 8, "damaged!")}) {
            std::ofstream(frame, std::ios::binary) << damaged;
            Process process({"view", folder.path() / "run", "--png", folder.path() / "a.png"}, folder.path() / "log");
            EXPECT_EQ(process.wait(), 2) << name;
            EXPECT_NE(process.said().find(name), std::string::npos) << process.said();
        }
        std::ofstream(frame, std::ios::binary) << whole;
    }
    EXPECT_FALSE(fs::exists(folder.path() / "a.png"));
}

}  // namespace
