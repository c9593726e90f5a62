// weir live on a display without a screen: what mouse and keys do to the run, that the session which is kept repeats it bit for bit without
// a window, and what is said where there is no display.
#include "app/live/window.hpp"
#include "app/process.hpp"
#include "core/error.hpp"
#include "output/folder_lock.hpp"
#include "sim/registry.hpp"
#include "support/temporary_folder.hpp"
#include "support/test.hpp"

#include <vtkCommand.h>
#include <vtkImageData.h>
#include <vtkPNGReader.h>
#include <vtkRenderWindow.h>
#include <vtkRenderWindowInteractor.h>
#include <vtkRenderer.h>
#include <vtkUnsignedCharArray.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <fstream>
#include <functional>
#include <iterator>
#include <thread>

#include <fmt/core.h>

#include <X11/Xlib.h>
#include <X11/Xutil.h>
#include <X11/keysym.h>

namespace {

namespace fs = std::filesystem;
using namespace weir;
using test::Process;
using test::TemporaryFolder;

const std::string falls = "effects.gravity.g = [0, -9.81]\nfluid.density = 1000\n";
const std::string pool =
    "dim = 2\ngrid = { cells = [24, 16], size = [1.5, 1] }\ntime = { end = 1.0, max_dt = 0.01 }\noutput.every = 0.05\n" + falls +
    "liquid = [ { shape = \"box\", min = [0, 0], max = [1.5, 0.5] } ]\n";
const std::string smoke =
    "solver = \"mac\"\ndim = 2\ngrid = { cells = [24, 16], size = [1.5, 1] }\ntime = { end = 1.0, max_dt = 0.02 }\n"
    "emitters = [ { shape = \"box\", min = [0.6, 0.1], max = [0.9, 0.3], velocity = [0, 0.5], smoke = 1 } ]\n" +
    falls;

fs::path written(const fs::path& file, const std::string& text) {
    std::ofstream(file) << text;
    return file;
}
std::string bytes_of(const fs::path& file) {
    std::ifstream in(file, std::ios::binary);
    return {std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>()};
}
std::string state_of(const Simulation& simulation) {
    TemporaryFolder folder;
    Checkpoint state;
    simulation.solver().save(state);
    state.write(folder.path() / "a");
    return bytes_of(folder.path() / "a");
}
real integral(const Simulation& simulation, const std::string& name) {
    for (const auto& i : simulation.solver().integrals())
        if (i.name == name) return i.value;
    throw std::logic_error("no integral " + name);
}

const std::string pond =
    "solver = \"heightfield\"\ndim = 3\ngrid = { cells = [32, 1, 24], size = [1.5, 1, 1] }\ntime = { end = 1.0, max_dt = 0.01 }\n"
    "terrain = { kind = \"formula\", height = \"0.4 - 0.6*exp(-8*((x - 0.8)^2 + (z - 0.5)^2))\" }\ninitial.surface = \"0.25\"\n"
    "effects.gravity.g = [0, -9.81, 0]\nfluid.density = 1000\n";
const std::string columns =
    "solver = \"heightfield\"\ndim = 2\ngrid = { cells = [48, 1], size = [1.5, 1] }\ntime = { end = 1.0, max_dt = 0.01 }\n"
    "scheme.model = \"columns\"\ninitial.surface = \"0.5\"\nfloats = [ { size = [0.3, 0.2], at = [1.0, 0.42] } ]\n" +
    falls;
const std::string tall =
    "solver = \"tallcell\"\ndim = 2\ngrid = { cells = [48, 32], size = [1.5, 1] }\ntime = { end = 1.0, max_dt = 0.01 }\n"
    "scheme.layers = 8\nliquid = [ { shape = \"box\", min = [0, 0], max = [1.5, 0.5] } ]\n" +
    falls;
const std::string bodies = "bodies = [ { shape = \"box\", min = [0.9, 0.45], max = [1.1, 0.6], density = 400.0 } ]\n";
const std::string warm = "substance = \"water\"\ninitial.temperature = { name = \"constant\", value = 300.0 }\n";

/// Pictures of what is shown, for someone who wants to look: in the folder that WEIR_KEEP_PICTURES names.
void keep_picture(live::Window& window, const std::string& name) {
    const char* folder = std::getenv("WEIR_KEEP_PICTURES");  // none in a test run
    if (folder) window.write(fs::path(folder) / (name + ".png"));
}

/// Someone at the keyboard and the mouse: events of the window system, sent to the window from outside of it.
struct Fingers {
    Display* display = XOpenDisplay(nullptr);
    ::Window window;
    int height, patience;  // waits so many times as long
    Fingers(::Window w, int h, int p = 1) : window(w), height(h), patience(p) {}
    ~Fingers() { XCloseDisplay(display); }
    void wait(int ms) const { std::this_thread::sleep_for(std::chrono::milliseconds(patience * ms)); }
    void send(XEvent& event, long mask) {
        event.xany.display = display, event.xany.window = window;
        XSendEvent(display, window, True, mask, &event);
        XFlush(display);
        wait(15);
    }
    void key(KeySym sym) {
        XEvent event{};
        event.type = KeyPress;
        event.xkey.keycode = XKeysymToKeycode(display, sym);
        event.xkey.same_screen = True;
        send(event, KeyPressMask);
    }
    void button(int type, const std::array<int, 2>& at, unsigned which = Button1) {
        XEvent event{};
        event.type = type;
        event.xbutton.button = which, event.xbutton.x = at[0], event.xbutton.y = height - 1 - at[1], event.xbutton.same_screen = True;
        send(event, type == ButtonPress ? ButtonPressMask : ButtonReleaseMask);
    }
    /// The pointer itself goes there: a window asks where it is between the events, too.
    void move(const std::array<int, 2>& to) {
        XWarpPointer(display, None, window, 0, 0, 0, 0, to[0], height - 1 - to[1]);
        XFlush(display);
        wait(15);
    }
    void drag(const std::array<int, 2>& from, const std::array<int, 2>& to) {
        move(from);
        button(ButtonPress, from);
        for (int i = 1; i <= 10; ++i) move({from[0] + i * (to[0] - from[0]) / 10, from[1] + i * (to[1] - from[1]) / 10});
        button(ButtonRelease, to);
    }
};

/// A window on a session in a folder of its own.
struct Play {
    TemporaryFolder folder;
    live::Session session;
    live::Window window;

    explicit Play(const std::string& scene, live::WindowOptions options = {})
        : session(live::endless(written(folder.path() / "scene.toml", scene), {}), folder.path() / "out"),
          window(session, sized(std::move(options))) {}
    Play(const fs::path& scene, std::vector<scene::Override> set)
        : session(live::endless(scene, std::move(set)), folder.path() / "out"), window(session, sized({})) {}
    static live::WindowOptions sized(live::WindowOptions options) {
        options.width = 480, options.height = 360;
        return options;
    }
    /// As the window system tells of it.
    void key(const char* name) {
        window.interactor()->SetKeySym(name);
        window.interactor()->InvokeEvent(vtkCommand::KeyPressEvent);
    }
    void mouse(unsigned long event, const Vec<3>& place) {
        const auto at = window.pixel(place);
        window.interactor()->SetEventInformation(at[0], at[1], 0, 0);
        window.interactor()->InvokeEvent(event);
    }
    /// Looks every few milliseconds, as the window's timer does, until it is so; at most 20 s.
    void until(const std::function<bool(const live::Snapshot&)>& so) {
        for (int i = 0; i < 4000; ++i) {
            window.interactor()->InvokeEvent(vtkCommand::TimerEvent);
            if (so(window.shown())) return;
            std::this_thread::sleep_for(std::chrono::milliseconds(5));
        }
        FAIL() << "it did not come to that: t = " << window.shown().time << " s, " << window.shown().message;
    }
    void run_for(real simulated) {
        const real end = window.shown().time + simulated;
        until([&](const auto& s) { return s.time >= end; });
    }
    void drag(const Vec<3>& from, const Vec<3>& to) {
        mouse(vtkCommand::LeftButtonPressEvent, from);
        for (int i = 1; i <= 10; ++i) {
            mouse(vtkCommand::MouseMoveEvent, from + 0.1 * i * (to - from));
            run_for(0.01);
        }
        mouse(vtkCommand::LeftButtonReleaseEvent, to);
    }
    fs::path finish() {
        window.stop();
        return session.finish();
    }
    /// Repeats the session through the executable, from its file, and compares the last state.
    void expect_replay(const fs::path& file) {
        Simulation replay(file);
        while (!replay.finished()) replay.step();
        EXPECT_EQ(replay.time(), session.simulation().time());
        EXPECT_EQ(replay.steps(), session.simulation().steps());
        EXPECT_EQ(replay.frame(), session.simulation().frame());
        EXPECT_TRUE(state_of(replay) == state_of(session.simulation())) << bytes_of(file);
    }
};

TEST(
    "a session of a pushing, pouring and draining brush, of gravity turned and of pauses repeats bit for bit, for every solver with a "
    "hand") {
    for (const std::string& scene : {"solver = \"pbf\"\n" + pool, "solver = \"sph\"\n" + pool, "solver = \"mac_water\"\n" + pool, smoke}) {
        Play play(scene);
        play.run_for(0.05);
        play.drag({{0.3, 0.3, 0}}, {{0.9, 0.4, 0}});
        play.key("space");
        play.until([](const auto& s) { return s.paused; });
        play.key("Down");
        play.key("Down");
        play.key("space");
        play.run_for(0.05);
        play.key("3");
        play.drag({{0.3, 0.8, 0}}, {{0.4, 0.8, 0}});
        play.key("4");
        play.drag({{1.2, 0.2, 0}}, {{1.2, 0.3, 0}});
        play.key("2");
        play.drag({{0.7, 0.2, 0}}, {{0.8, 0.3, 0}});
        play.run_for(0.05);
        const auto file = play.finish();
        const auto& simulation = play.session.simulation();
        EXPECT_EQ(simulation.changes().size(), 3u) << scene;  // two of gravity, and the end
        EXPECT_NEAR(simulation.scene().root().numbers("effects.gravity.g")[1], -9.81 * 1.21, 0.02) << scene;
        EXPECT_NE(integral(simulation, "hand_impulse_x"), 0) << scene;
        play.expect_replay(file);
    }
}

TEST("heights of water and tall cells are pushed, poured and drained, and their sessions repeat bit for bit") {
    const std::pair<std::string, std::string> scenes[] = {{"pond", pond}, {"columns", columns}, {"tall", tall}};
    for (const auto& [name, scene] : scenes) {
        Play play(scene);
        const real z = play.session.scene().dim() == 3 ? 0.5 : 0;
        play.run_for(0.05);
        play.drag({{0.6, 0.3, z}}, {{0.9, 0.3, z}});
        EXPECT_EQ(play.window.shown().brush_can[1], name != "columns");
        play.key("3");
        play.drag({{0.5, 0.7, z}}, {{0.6, 0.7, z}});
        keep_picture(play.window, name);
        play.key("4");
        play.drag({{0.8, 0.3, z}}, {{0.9, 0.3, z}});
        play.key("5");
        play.drag({{0.8, 0.3, z}}, {{0.9, 0.3, z}});
        EXPECT_FALSE(play.window.shown().brush_can[5]);
        play.run_for(0.05);
        const auto file = play.finish();
        const auto& simulation = play.session.simulation();
        EXPECT_NE(integral(simulation, "hand_mass"), 0) << name;
        EXPECT_EQ(integral(simulation, "hand_impulse_x") != 0, name != "columns") << name;
        play.expect_replay(file);
    }
}

TEST("a brush warms and cools where there is heat, and takes hold of a body; sessions of both repeat bit for bit") {
    for (const std::string solver : {"mac_water", "pbf", "sph"}) {
        Play play("solver = \"" + solver + "\"\n" + warm + pool + bodies);
        play.run_for(0.05);
        play.key("5");
        play.drag({{0.3, 0.3, 0}}, {{0.5, 0.3, 0}});
        play.key("c");
        play.key("c");
        play.until([](const auto& s) { return s.temperatures[1] > 310; });
        keep_picture(play.window, solver + "_heated");
        play.key("6");
        play.drag({{1.0, 0.6, 0}}, {{0.8, 0.8, 0}});
        keep_picture(play.window, solver + "_held");
        const auto file = play.finish();
        const auto& simulation = play.session.simulation();
        EXPECT_GT(integral(simulation, "hand_heat"), 1e4) << solver;
        const auto& keys = simulation.solver().brush()->keys;
        const auto held = std::count_if(keys.begin(), keys.end(), [](const BrushKeyframe& k) { return k.kind == BrushKind::grab; });
        EXPECT_GT(held, 0) << solver;
        play.expect_replay(file);
    }
}

TEST(
    "by the window's own clock a brush pushes a breaking dam, waits, begins again, turns gravity and pours: events of the window system, "
    "and "
    "the session repeats bit for bit") {
    std::vector<scene::Override> small;  // a test has no time for 32,768 particles
    const bool full = std::getenv("WEIR_KEEP_PICTURES") != nullptr;
    if (!full) small = {{"grid.cells", "[24, 16, 9]"}, {"grid.size", "[3, 2, 1.125]"}, {"time.dt", "0.005"}};
    Play play(fs::path(WEIR_SOURCE_DIR) / "cases" / "dam_break_particles", small);
    live::Knobs knobs(play.session.scene());
    int to_gravity = 0;
    while (knobs.chosen().name() != "effects.gravity.g[1]") knobs.choose(1), ++to_gravity;
    const auto& box = play.window.scenery().domain().box;
    const auto pixel = [&](double x, double y) {
        return play.window.pixel({{box[0] + x * (box[1] - box[0]), box[2] + y * (box[3] - box[2]), 0.5 * (box[4] + box[5])}});
    };
    const auto a = pixel(0.1, 0.15), b = pixel(0.35, 0.2), high = pixel(0.6, 0.6), beside = pixel(0.65, 0.6);
    auto* shown = play.window.interactor()->GetRenderWindow();
    std::thread someone([&, id = reinterpret_cast<::Window>(shown->GetGenericWindowId())] {
        Fingers fingers(id, 360, full ? 4 : 1);
        fingers.wait(300);
        if (full)
            for (int i = 0; i < 5; ++i) fingers.button(ButtonPress, a, Button4);  // the wheel: twice as wide a brush
        fingers.drag(a, b);
        fingers.key(XK_space), fingers.wait(100), fingers.key(XK_p), fingers.key(XK_space);
        fingers.key(XK_r);
        fingers.drag(a, b);
        fingers.key(XK_p);
        for (int i = 0; i < to_gravity; ++i) fingers.key(XK_Right);
        fingers.key(XK_Down), fingers.key(XK_Down);
        fingers.key(XK_3);
        fingers.drag(high, beside);
        fingers.key(XK_F1), fingers.wait(100), fingers.key(XK_p);
        fingers.wait(200);
        fingers.key(XK_q);
    });
    play.window.interact();
    someone.join();
    for (int i = 0; i < 3; ++i) {
        const auto picture = play.session.folder() / fmt::format("picture_{:03}.png", i);
        ASSERT_TRUE(fs::exists(picture)) << picture;
        if (const char* folder = std::getenv("WEIR_KEEP_PICTURES"))
            fs::copy_file(picture, fs::path(folder) / fmt::format("dam_{}.png", i), fs::copy_options::overwrite_existing);
    }
    const auto file = play.finish();
    const auto& simulation = play.session.simulation();
    EXPECT_NE(integral(simulation, "hand_impulse_x"), 0);
    EXPECT_GT(integral(simulation, "hand_mass"), 0);
    EXPECT_EQ(simulation.changes().size(), 3u);  // two of gravity, and the end
    play.expect_replay(file);
}

TEST("the executable runs the session that was kept, to the same bytes; a checkpoint of it continues it") {
    Play play("solver = \"pbf\"\n" + pool);
    play.drag({{0.3, 0.3, 0}}, {{0.9, 0.4, 0}});
    play.key("Up");
    play.run_for(0.05);
    play.key("s");
    play.until([](const auto& s) { return s.message.find("is written") != std::string::npos; });
    const auto file = play.finish();
    const auto out = play.folder.path() / "replay";
    Process run({"run", file, "--out", out, "--threads", "1", "--checkpoint-every", "1000000"}, play.folder.path() / "log");
    ASSERT_EQ(run.wait(), 0) << run.said();
    const auto checkpoint = Checkpoint::read(out / "checkpoint.weir");
    Simulation replay(scene_of(checkpoint));
    replay.restore(checkpoint);
    replay.run_until(play.session.simulation().time());  // the checkpoint stands before the steps that the end has shortened
    EXPECT_TRUE(state_of(replay) == state_of(play.session.simulation()));
    const auto saved = Checkpoint::read(play.session.folder() / "checkpoint.weir");
    Simulation continued(scene_of(saved));
    continued.restore(saved);
    while (!continued.finished()) continued.step();
    EXPECT_GT(continued.time(), 0.1);
}

TEST("a drag moves the water its way, and the brush takes hold only where it is pressed") {
    Play play("solver = \"pbf\"\n" + pool);
    play.mouse(vtkCommand::MouseMoveEvent, {{0.5, 0.3, 0}});
    play.run_for(0.05);
    play.drag({{0.4, 0.25, 0}}, {{1.0, 0.25, 0}});
    play.finish();
    EXPECT_GT(integral(play.session.simulation(), "hand_impulse_x"), 1);
    ASSERT_FALSE(play.session.simulation().solver().brush()->keys.empty());
    EXPECT_GT(play.session.simulation().solver().brush()->keys.front().time, 0.04);
    EXPECT_EQ(play.session.simulation().solver().brush()->keys.back().kind, BrushKind::off);
}

TEST("a touch that is shorter than a step acts for one") {
    live::WindowOptions options;
    options.paused = true;
    Play play("solver = \"pbf\"\n" + pool, options);
    play.key("3");
    play.mouse(vtkCommand::LeftButtonPressEvent, {{0.5, 0.8, 0}});
    play.mouse(vtkCommand::LeftButtonReleaseEvent, {{0.5, 0.8, 0}});
    play.key("period");
    play.until([](const auto& s) { return s.steps == 1; });
    play.key("period");
    play.until([](const auto& s) { return s.steps == 2; });
    play.window.stop();
    const auto& keys = play.session.simulation().solver().brush()->keys;
    ASSERT_EQ(keys.size(), 2u);
    EXPECT_EQ(keys[0].kind, BrushKind::pour);
    EXPECT_EQ(keys[1].kind, BrushKind::off);
    EXPECT_GT(integral(play.session.simulation(), "hand_mass"), 0);
}

TEST("keys: space pauses, a full stop makes one step, r begins again, the wheel sizes the brush, c colours, p takes a picture, F1 tells") {
    live::WindowOptions options;
    options.paused = true;
    Play play("solver = \"mac_water\"\n" + pool, options);
    play.until([](const auto& s) { return s.paused; });
    EXPECT_EQ(play.window.shown().steps, 0);
    play.key("period");
    play.until([](const auto& s) { return s.steps == 1; });
    play.key("period");
    play.until([](const auto& s) { return s.steps == 2; });
    std::this_thread::sleep_for(std::chrono::milliseconds(50));
    play.window.refresh();
    EXPECT_EQ(play.window.shown().steps, 2) << "it is paused";
    const real before = play.window.radius();
    play.mouse(vtkCommand::MouseWheelForwardEvent, {{0.5, 0.5, 0}});
    EXPECT_NEAR(play.window.radius(), 1.15 * before, 1e-12);
    play.mouse(vtkCommand::MouseWheelBackwardEvent, {{0.5, 0.5, 0}});
    EXPECT_NEAR(play.window.radius(), before, 1e-12);
    EXPECT_EQ(play.window.shown().field, "speed");
    play.key("c");
    play.until([](const auto& s) { return s.field == "pressure"; });
    EXPECT_FALSE(play.window.shown().of_cells.empty());
    play.key("F1");
    play.key("p");
    ASSERT_TRUE(play.window.pictured());
    vtkNew<vtkPNGReader> reader;
    reader->SetFileName(play.window.pictured()->c_str());
    reader->Update();
    EXPECT_EQ(reader->GetOutput()->GetDimensions()[0], 480);
    play.key("r");
    play.until([](const auto& s) { return s.steps == 0; });
    play.key("2");
    EXPECT_EQ(play.window.tool(), BrushKind::pull);
    play.key("x");
}

TEST("the right button moves the camera and never the fluid") {
    Play play("solver = \"pbf\"\n" + pool);
    const auto at = play.window.pixel({{0.5, 0.5, 0}});
    play.mouse(vtkCommand::RightButtonPressEvent, {{0.5, 0.5, 0}});
    play.window.interactor()->SetEventInformation(at[0] + 40, at[1] + 20, 0, 0);
    play.window.interactor()->InvokeEvent(vtkCommand::MouseMoveEvent);
    play.window.interactor()->InvokeEvent(vtkCommand::RightButtonReleaseEvent);
    const auto now = play.window.pixel({{0.5, 0.5, 0}});
    EXPECT_NEAR(now[0] - at[0], 40, 1);
    EXPECT_NEAR(now[1] - at[1], 20, 1);
    play.finish();
    EXPECT_TRUE(play.session.simulation().solver().brush()->keys.empty());
}

TEST("a number is turned within what the schema allows, and no further") {
    Play play("solver = \"pbf\"\nscheme = { iterations = 2 }\n" + pool);
    live::Knobs knobs(play.session.scene());
    while (knobs.chosen().key != "scheme.iterations") knobs.choose(1);
    EXPECT_EQ(knobs.turn(-1)->value, "1");
    EXPECT_FALSE(knobs.turn(-1));
    while (knobs.chosen().key != "scheme.relaxation") knobs.choose(1);
    for (int i = 0; i < 30; ++i) knobs.turn(1);
    EXPECT_EQ(knobs.chosen().value(), 2);
    for (int i = 0; i < 100; ++i) knobs.turn(-1);
    EXPECT_GT(knobs.chosen().value(), 0);
}

TEST("in 3D the brush acts in the plane of the camera's focus, and the session repeats") {
    Play play(
        "solver = \"pbf\"\ndim = 3\ngrid = { cells = [12, 8, 8], size = [1.5, 1, 1] }\ntime = { end = 1.0, max_dt = 0.01 }\n"
        "effects.gravity.g = [0, -9.81, 0]\nfluid.density = 1000\n"
        "liquid = [ { shape = \"box\", min = [0, 0, 0], max = [1.5, 0.5, 1] } ]\n");
    play.drag({{0.5, 0.4, 0.5}}, {{1.0, 0.5, 0.5}});
    const auto file = play.finish();
    EXPECT_GT(integral(play.session.simulation(), "hand_impulse_x"), 1);
    play.expect_replay(file);
}

TEST("what is seen in the window is what was drawn") {
    Play play("solver = \"pbf\"\n" + pool);
    play.run_for(0.05);
    play.window.stop();
    vtkRenderWindow* window = play.window.interactor()->GetRenderWindow();
    window->Render();
    const int *size = window->GetSize(), width = size[0], height = size[1];
    vtkNew<vtkUnsignedCharArray> drawn;
    window->GetPixelData(0, 0, width - 1, height - 1, 0, drawn);
    XImage* seen = XGetImage(static_cast<Display*>(window->GetGenericDisplayId()), reinterpret_cast<::Window>(window->GetGenericWindowId()),
                             0, 0, static_cast<unsigned>(width), static_cast<unsigned>(height), AllPlanes, ZPixmap);
    ASSERT_NE(seen, nullptr);
    const auto byte = [](unsigned long pixel, unsigned long mask) { return static_cast<int>((pixel & mask) / (mask & ~(mask - 1))); };
    int different = 0, blue = 0;
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x) {
            const unsigned long pixel = XGetPixel(seen, x, height - 1 - y);
            const unsigned char* rgb = drawn->GetPointer(3 * (static_cast<vtkIdType>(y) * width + x));
            different +=
                byte(pixel, seen->red_mask) != rgb[0] || byte(pixel, seen->green_mask) != rgb[1] || byte(pixel, seen->blue_mask) != rgb[2];
            blue += rgb[2] > rgb[0] + 30;
        }
    XDestroyImage(seen);
    EXPECT_EQ(different, 0);
    EXPECT_GT(blue, width * height / 20);  // and that is not a sheet of paper: water is over a tenth of the window
}

TEST("solvers without a brush have sessions too") {
    TemporaryFolder folder;
    live::Session session(live::endless(fs::path(WEIR_SOURCE_DIR) / "cases" / "stokes_wave", {}), folder.path() / "kept");
    EXPECT_FALSE(session.has_brush());
    for (int s = 0; s < 5; ++s) session.step();
    Simulation replay(session.finish());
    while (!replay.finished()) replay.step();
    EXPECT_TRUE(state_of(replay) == state_of(session.simulation()));
}

TEST("files beside a scene are found from where its session is kept") {
    TemporaryFolder folder;
    fs::create_directories(folder.path() / "scene");
    fs::copy(std::string(WEIR_SOURCE_DIR) + "/tests/input/terrain/hill.asc", folder.path() / "scene" / "hill.asc");
    const auto scene = written(folder.path() / "scene" / "scene.toml",
                               "solver = \"heightfield\"\ndim = 2\ngrid = { cells = [16, 1], size = [1, 1] }\ntime = { end = 1.0 }\n"
                               "terrain = { kind = \"asc\", file = \"hill.asc\", corner = [0, 0], nodata = 0 }\n"
                               "initial.surface = \"0.5 + 0.1*x\"\neffects.gravity.g = [0, -9.81]\n");
    live::Session session(live::endless(scene, {}), folder.path() / "out" / "kept");
    for (int s = 0; s < 5; ++s) session.step();
    session.steer({"effects.gravity.g", "[0, -5]"});
    for (int s = 0; s < 5; ++s) session.step();
    Simulation replay(session.finish());
    while (!replay.finished()) replay.step();
    EXPECT_EQ(replay.steps(), session.simulation().steps());
    EXPECT_TRUE(state_of(replay) == state_of(session.simulation()));
}

TEST("the window plays by its own clock and closes on q") {
    Play play("solver = \"pbf\"\n" + pool);
    struct Closer {
        Play& play;
        void look() {
            if (play.window.shown().time > 0.1) play.key("q");
        }
    } closer{play};
    play.window.interactor()->AddObserver(vtkCommand::TimerEvent, &closer, &Closer::look);
    play.window.interact();
    EXPECT_GT(play.window.shown().time, 0.1);
    EXPECT_GT(play.window.costs().frames, 2);
    play.expect_replay(play.finish());
}

TEST("without a display, and without a scene, it says so and exits with 2") {
    TemporaryFolder folder;
    const std::string display = std::getenv("DISPLAY");
    Process nothing({"live"}, folder.path() / "log");
    EXPECT_EQ(nothing.wait(), 2);
    EXPECT_NE(nothing.said().find("requires a scene"), std::string::npos) << nothing.said();
    unsetenv("DISPLAY");
    Process blind({"live", written(folder.path() / "scene.toml", smoke)}, folder.path() / "log");
    const int code = blind.wait();
    setenv("DISPLAY", display.c_str(), 1);
    EXPECT_EQ(code, 2);
    EXPECT_NE(blind.said().find("no display to draw on: DISPLAY is not set"), std::string::npos) << blind.said();
}

TEST("a session does not share its folder: where another program writes, it ends with 2 before a window opens") {
    TemporaryFolder folder;
    const auto out = folder.path() / "out";
    fs::create_directory(out);
    const output::FolderLock lock(out);
    Process second({"live", written(folder.path() / "scene.toml", smoke), "--out", out}, folder.path() / "log");
    for (int i = 0; i < 300 && second.running(); ++i) usleep(50000);  // a session ends when its window closes
    ASSERT_FALSE(second.running()) << second.said();
    EXPECT_EQ(second.wait(), 2);
    EXPECT_NE(second.said().find("another run writes into this folder"), std::string::npos) << second.said();
    EXPECT_FALSE(fs::exists(out / "session.toml"));
}

TEST("--bench measures a scene for so long and tells what a frame spends; the report's scenes stand beside the cases") {
    TemporaryFolder folder;
    Process bench({"live", written(folder.path() / "scene.toml", smoke), "--bench", "1s", "--width", "320", "--height", "200"},
                  folder.path() / "log");
    ASSERT_EQ(bench.wait(), 0) << bench.said();
    for (const char* part : {"frames/s", "step [ms]", "copy [ms]", "draw [ms]", "real time", "scene.toml"})
        EXPECT_NE(bench.said().find(part), std::string::npos) << bench.said();
    Process wrong({"live", "--bench", "soon"}, folder.path() / "log");
    EXPECT_EQ(wrong.wait(), 2);
    EXPECT_NE(wrong.said().find("--bench soon: expected a time with its unit, such as 10s"), std::string::npos) << wrong.said();
}

}  // namespace
